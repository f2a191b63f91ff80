//! Two runs that must agree: what of their histories is the same in any unit, mirrored or not.

use std::collections::BTreeMap;
use std::path::Path;

use crate::case::{Case, Space};
use crate::csv;

/// What a history says, in units of the problem, at the ends of its increments.
#[derive(Debug, Default)]
pub struct Trace {
    /// Times.
    pub times: Vec<f64>,
    /// Whether the step of a row has inertia.
    pub moving: Vec<bool>,
    /// Sizes of forces over time: of interfaces and supports.
    pub forces: BTreeMap<String, Vec<f64>>,
    /// Strain energy.
    pub energy: Vec<f64>,
    /// Points that are open, stick and slip at the end.
    pub statuses: [f64; 3],
    /// Frequencies of modes, by file.
    pub frequencies: BTreeMap<String, Vec<f64>>,
}

/// Reads a trace. Units are those of length, modulus and time.
pub fn trace(folder: &Path, [length, modulus, time]: [f64; 3]) -> Result<Trace, String> {
    let case = Case::read(&folder.join("problem.toml"))?;
    let history = csv::read(&folder.join("history.csv"))?;
    let area = match case.space {
        Space::Strain(_) | Space::Stress(_) => length,
        Space::Ring | Space::Solid => length * length,
    };
    let rows = history.rows();
    let mut trace = Trace {
        times: history
            .column("TIME")
            .unwrap_or(&[])
            .iter()
            .map(|t| t / time)
            .collect(),
        ..Trace::default()
    };
    let steps = history.column("STEP").unwrap_or(&[]);
    let moving = |s: &f64| case.steps.get(*s as usize - 1).is_some_and(|s| s.dynamic());
    trace.moving = steps.iter().map(moving).collect();
    let mut components = BTreeMap::new();
    for (head, values) in &history.columns {
        let stem = head.trim_end_matches(|c: char| c.is_ascii_digit());
        let kind = stem.rsplit('.').next().unwrap_or_default();
        if !stem.contains('.') || stem == head || !["CFN", "CFS", "RF"].contains(&kind) {
            continue;
        }
        // A body that is cut in two has two parts of its plane of symmetry.
        let axis = &head[stem.len()..];
        let stem = stem.replace("axis-under", "axis-lower");
        let sums = components
            .entry((stem, axis))
            .or_insert_with(|| vec![0.0; rows]);
        for (sum, value) in sums.iter_mut().zip(values) {
            *sum += value / (modulus * area);
        }
    }
    for ((stem, _), values) in components {
        let squares = trace.forces.entry(stem).or_insert_with(|| vec![0.0; rows]);
        for (square, value) in squares.iter_mut().zip(values) {
            *square += value * value;
        }
    }
    let roots = trace.forces.values_mut().flatten();
    roots.for_each(|square| *square = square.sqrt());
    trace.statuses = ["OPEN", "STICK", "SLIP"]
        .map(|name| history.column(name).and_then(|c| c.last().copied()))
        .map(|last| last.unwrap_or(0.0));
    let energy = history.column("ALLSE").unwrap_or(&[]).iter();
    trace.energy = energy.map(|e| e / (modulus * area * length)).collect();
    let files = std::fs::read_dir(folder).map_err(|e| e.to_string())?;
    for file in files.flatten() {
        let name = file.file_name().to_string_lossy().into_owned();
        if name.starts_with("modes-") && name.ends_with(".csv") {
            let table = csv::read(&file.path())?;
            if let Some(column) = table.column("frequency") {
                let values = column.iter().map(|f| f * time).collect();
                trace.frequencies.insert(name, values);
            }
        }
    }
    Ok(trace)
}

/// The largest difference of two traces, and of what: forces of the largest force of all, energies of the largest energy, frequencies of the highest of the file. At rows of
/// one time alone; those in motion count only if asked for.
pub fn difference(a: &Trace, b: &Trace, moving: bool) -> (f64, String) {
    let mut worst = (0.0, String::from("nothing"));
    let mut note = |value: f64, what: String| {
        if value > worst.0 || value.is_nan() {
            worst = (value, what);
        }
    };
    let most = |values: &mut dyn Iterator<Item = &f64>| {
        values.fold(f64::MIN_POSITIVE, |m, v| m.max(v.abs()))
    };
    let scale = most(
        &mut a
            .forces
            .values()
            .flatten()
            .chain(b.forces.values().flatten()),
    );
    let energies = most(&mut a.energy.iter().chain(&b.energy));
    let near = |s: f64, t: f64| (s - t).abs() <= 1e-7 * t.abs().max(1e-300);
    for (i, t) in a.times.iter().enumerate() {
        let Some(k) = b.times.iter().position(|s| near(*s, *t)) else {
            continue;
        };
        if a.moving[i] && !moving {
            continue;
        }
        for (name, values) in &a.forces {
            if let Some(others) = b.forces.get(name) {
                let off = (values[i] - others[k]).abs() / scale;
                note(
                    off,
                    format!("{name} {:.4e} for {:.4e} at {t:.4}", others[k], values[i]),
                );
            }
        }
        let off = (a.energy[i] - b.energy[k]).abs() / energies;
        note(
            off,
            format!(
                "ALLSE {:.4e} for {:.4e} at {t:.4}",
                b.energy[k], a.energy[i]
            ),
        );
    }
    // Of a point at the limit of friction rounding says whether it sticks, and so what moves with it.
    let alike = a.statuses == b.statuses;
    for (file, values) in a.frequencies.iter().filter(|_| alike) {
        let Some(others) = b.frequencies.get(file) else {
            continue;
        };
        // Below a thousandth of what a wave takes for the length of a body a frequency is that of a motion that nothing resists.
        let highest = most(&mut values.iter().chain(others)).max(1e-3);
        if values.len() != others.len() {
            note(
                1.0,
                format!("{file}: {} modes for {}", others.len(), values.len()),
            );
        }
        for (x, y) in values.iter().zip(others) {
            note(
                (x - y).abs() / highest,
                format!("{file}: {y:.5e} for {x:.5e}"),
            );
        }
    }
    worst
}
