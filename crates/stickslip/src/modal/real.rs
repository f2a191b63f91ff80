//! Real modes: `K x = ω² M x` of bodies, couplings and closed contacts.

use std::f64::consts::TAU;

use super::linear::{Linear, fault};
use super::outcome::{ModalOutcome, Mode};
use super::participation::directions;
use super::shifted::Shifted;
use crate::error::RunError;
use crate::linear::{Pencil, RealModes, Wanted, lanczos};
use crate::math::vector::dot;
use crate::model::definition::Model;
use crate::model::frame::Frame;
use crate::model::modal::RealPlan;
use crate::tolerance::NEGLIGIBLE;

/// The modes that a step asks for.
pub(crate) fn modes(
    model: &Model,
    frame: &Frame,
    linear: &Linear,
    plan: &RealPlan,
) -> Result<ModalOutcome, RunError> {
    let shifted = Shifted::new(linear, frame, false)?;
    let [from, to] = plan.range;
    let count = match from > 0.0 {
        // Those below have to be found as well.
        true => plan.count.saturating_add(linear.free()),
        false => plan.count,
    };
    let count = count.min(linear.free());
    let found = match from > 0.0 && to.is_infinite() {
        true => above(&shifted, from, plan.count),
        false => lowest(&shifted, count, (TAU * to).powi(2)),
    };
    if found.values.is_empty() && linear.mass.diagonal().iter().all(|m| *m == 0.0) {
        let mut error = fault(frame, "nothing has a mass, so nothing vibrates");
        error.help = Some("give the materials a density".into());
        return Err(error);
    }
    let directions = directions(model, linear);
    let mut out = ModalOutcome {
        step: model.steps[frame.step].name.clone(),
        directions: directions.iter().map(|d| d.name.into()).collect(),
        masses: directions.iter().map(|d| d.total).collect(),
        points: linear.points,
        factorisations: shifted.factorisations,
        solves: found.solves,
        shapes: plan.shapes,
        notes: notes(linear, &found, &shifted),
        ..ModalOutcome::default()
    };
    let open = residuals(&shifted, &found);
    out.solves += open.len();
    for ((value, x), residual) in found.values.iter().zip(found.vectors).zip(open) {
        let frequency = frequency(*value, shifted.shift());
        if frequency < from || out.modes.len() == plan.count {
            continue;
        }
        let participation: Vec<f64> = directions.iter().map(|d| dot(&d.mass, &x)).collect();
        let mut shape = x;
        linear.bound.expand(&mut shape);
        model.links.impose(&mut shape);
        out.modes.push(Mode {
            frequency,
            // Something buckles: it grows without a vibration.
            // Squared frequencies below this part of the shift are those of motions without stiffness.
            growth: match *value < -NEGLIGIBLE * shifted.shift() {
                true => (-value).sqrt(),
                false => 0.0,
            },
            residual,
            effective_mass: participation.iter().map(|p| p * p).collect(),
            participation,
            shape: [shape, Vec::new()],
            ..Mode::default()
        });
    }
    Ok(out)
}

/// The lowest modes, up to `ω²`.
pub(crate) fn lowest(shifted: &Shifted, count: usize, below: f64) -> RealModes {
    let linear = shifted.linear;
    let mass = |x: &[f64], y: &mut [f64]| y.copy_from_slice(&linear.times(&linear.mass, x));
    let solve = |b: &mut [f64], columns: usize| shifted.factor.solve_columns(b, columns);
    let pencil = Pencil {
        size: linear.size(),
        free: linear.free(),
        mass: &mass,
        solve: &solve,
        shift: shifted.shift(),
    };
    let wanted = Wanted {
        count,
        below,
        // At this residual of the inverse problem a mode counts as found.
        tolerance: 1e-10,
    };
    lanczos(&pencil, wanted)
}

/// So many modes above a frequency: as many from below as that takes.
fn above(shifted: &Shifted, from: f64, count: usize) -> RealModes {
    let mut wanted = 2 * count;
    loop {
        let found = lowest(shifted, wanted, f64::INFINITY);
        let least = (TAU * from).powi(2);
        let met = found.values.iter().filter(|v| **v >= least).count();
        if met >= count || found.values.len() < wanted {
            return found;
        }
        wanted *= 2;
    }
}

/// Cycles per unit of time of `ω²`; zero of what has no stiffness.
pub(super) fn frequency(value: f64, shift: f64) -> f64 {
    match value > NEGLIGIBLE * shift {
        true => value.sqrt() / TAU,
        false => 0.0,
    }
}

/// What is left of `K x - ω² M x`, relative to what is in the mode.
fn residuals(shifted: &Shifted, found: &RealModes) -> Vec<f64> {
    let linear = shifted.linear;
    let modes = found.values.iter().zip(&found.vectors);
    let open = modes.map(|(value, x)| -> Vec<f64> {
        let m = linear.times(&linear.mass, x);
        let k = linear.times(&linear.stiffness, x).into_iter().zip(m);
        k.map(|(k, m)| k - value * m).collect()
    });
    let open: Vec<Vec<f64>> = open.collect();
    let solved = shifted.solved(&open);
    let one = std::slice::from_ref::<Vec<f64>>;
    let each = open.iter().zip(&solved).zip(&found.vectors);
    each.map(|((r, s), x)| shifted.relative(one(r), one(s), one(x)))
        .collect()
}

fn notes(linear: &Linear, found: &RealModes, shifted: &Shifted) -> Vec<String> {
    let mut notes = Vec::new();
    if !found.complete {
        notes.push("not all modes that were asked for have converged: those in the table have, others may be missing among them".into());
    }
    if shifted.sigma > 0.0 {
        notes.push("something can move without strain: its modes have the frequency 0".into());
    }
    let [_, steady, others] = linear.points;
    if steady + others > 0 {
        notes.push(format!(
            "{} points slide: they have no stiffness along the surface, and friction is ignored in real modes",
            steady + others
        ));
    }
    notes
}
