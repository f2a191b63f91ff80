//! The shapes of modes that a run has written, and how they move through their phases.

use std::sync::Arc;

use stickslip::Error;
use stickslip::io::{csv, pvd};
use stickslip::modal::grows;
use stickslip::number::figure;

use crate::phase::Phase;
use crate::results::{Frame, Results, fault};

/// The shape of a mode, or the answer to harmonic loads.
#[derive(Debug, Clone, PartialEq)]
pub struct Shape {
    /// The step, from 1.
    pub step: usize,
    /// The mode, from 1.
    pub mode: usize,
    /// What it is, for people.
    pub label: String,
    /// Growth rate `[1/time]`.
    pub growth: f64,
    /// Whether it grows by more than rounding.
    pub unstable: bool,
    /// Its file in the folder of results.
    pub file: String,
}

/// All shapes, step by step.
///
/// # Errors
/// [`Error::Io`] if a list or table is damaged.
pub fn all(results: &Results) -> Result<Vec<Shape>, Error> {
    let mut shapes = Vec::new();
    for step in 1..=results.steps() {
        let list = results.directory.join(format!("modes-{step}.pvd"));
        if !list.is_file() {
            continue;
        }
        let table = results.directory.join(format!("modes-{step}.csv"));
        let table = table.is_file().then(|| csv::read(&table)).transpose()?;
        let column = |name: &str, k: usize| {
            let values = table.as_ref().and_then(|t| t.column(name));
            values.and_then(|v| v.get(k).copied())
        };
        for (k, (at, file)) in pvd::read(&list)?.into_iter().enumerate() {
            let growth = column("growth", k).unwrap_or(0.0);
            let unstable = column("damping-ratio", k).is_some_and(grows);
            let mode = k + 1;
            let label = match column("frequency", k) {
                Some(f) if growth == 0.0 => {
                    format!("step {step}, mode {mode}: frequency {}", figure(f))
                }
                Some(f) => format!(
                    "step {step}, mode {mode}: frequency {}, growth {}{}",
                    figure(f),
                    figure(growth),
                    if unstable { ", unstable" } else { "" }
                ),
                // Answers to harmonic loads are listed by their frequency.
                None => format!("step {step}, answer at {}", figure(at)),
            };
            shapes.push(Shape {
                step,
                mode,
                label,
                growth,
                unstable,
                file,
            });
        }
    }
    Ok(shapes)
}

/// The same results with a shape at so many phases of a cycle in place of the times at which fields were written. `name` is the number of a mode in the last step that has
/// shapes, or `STEP:MODE`, the step by its name or number.
///
/// # Errors
/// [`Error::Io`] if there is no such shape.
pub fn at_phases(results: &Results, name: &str, phases: usize) -> Result<Results, Error> {
    let shapes = all(results)?;
    let wrong = |message: String| fault(&results.directory, message);
    let Some(last) = shapes.last().map(|s| s.step) else {
        return Err(wrong(
            "no shapes of modes were written: a step with `modes`, `complex-modes` or `harmonic` does that".into(),
        ));
    };
    let (step, mode) = match name.split_once(':') {
        Some((step, mode)) => (results.step(step.trim()), mode.trim()),
        None => (Some(last), name.trim()),
    };
    let mode: Option<usize> = mode.parse().ok();
    let found = |s: &&Shape| Some(s.step) == step && Some(s.mode) == mode;
    let Some(shape) = shapes.iter().find(found) else {
        let of = |step: usize| shapes.iter().filter(|s| s.step == step).count();
        let steps: std::collections::BTreeSet<usize> = shapes.iter().map(|s| s.step).collect();
        let known: Vec<String> = (steps.into_iter())
            .map(|step| format!("step {step} has modes 1 to {}", of(step)))
            .collect();
        return Err(wrong(format!(
            "there is no mode `{name}`; {}: `3`, or `2:3` for mode 3 of step 2",
            known.join(", ")
        )));
    };
    let time = results.frames.last().map_or(0.0, |f| f.time);
    let label: Arc<str> = shape.label.as_str().into();
    let frames = (0..phases).map(|k| Frame {
        time,
        file: results.directory.join(&shape.file),
        phase: Some(Phase {
            label: Arc::clone(&label),
            angle: std::f64::consts::TAU * k as f64 / phases as f64,
        }),
    });
    Ok(Results {
        frames: frames.collect(),
        surfaces: Vec::new(),
        ..results.clone()
    })
}
