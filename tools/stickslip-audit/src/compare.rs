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
    /// Whether the step of a row has inertia, and whether it is explicit.
    pub moving: Vec<[bool; 2]>,
    /// Which attempt at its increment each is.
    pub attempts: Vec<f64>,
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
    let moving = |s: &f64| {
        let step = case.steps.get(*s as usize - 1);
        step.map_or([false; 2], |s| [s.dynamic(), s.explicit()])
    };
    trace.moving = steps.iter().map(moving).collect();
    trace.attempts = history.column("ATT").unwrap_or(&[]).to_vec();
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

/// What two runs may differ by.
#[derive(Debug, Clone, Copy)]
pub struct Tolerance {
    /// Where both have taken the same increments, or none was taken back.
    pub same: f64,
    /// Where one has taken others, as its iteration had failed.
    pub others: f64,
    /// Whether rows in motion count.
    pub moving: bool,
}

/// What two runs of the same motion differ by as long as they differ by rounding: the tolerance of the solver.
const ROUNDING: f64 = 1e-8;

/// How far rows of explicit steps can be compared: every impact multiplies what two runs differ by, were it rounding, by a few times. Runs that begin alike and part
/// little by little have nothing to say to each other from there on.
#[derive(Debug, Default)]
struct Impacts {
    begun: Option<f64>,
    parted: bool,
}

impl Impacts {
    /// Takes note of what a row differs by.
    fn note(&mut self, off: f64, may: f64) {
        let begun = *self.begun.get_or_insert(off);
        self.parted |= begun <= ROUNDING && off > ROUNDING && off <= may;
    }
}

/// Whether two runs have come to these rows by the same increments, or by others though none was taken back.
fn alike([a, b]: [&Trace; 2], [i, k]: [usize; 2]) -> bool {
    let times = a.times[..=i].iter().zip(&b.times[..=k]);
    let again = |trace: &Trace, row: usize| trace.attempts.iter().take(row + 1).any(|n| *n > 1.0);
    i == k && times.into_iter().all(|(s, t)| near(*s, *t)) || !again(a, i) && !again(b, k)
}

fn near(s: f64, t: f64) -> bool {
    (s - t).abs() <= 1e-7 * t.abs().max(1e-300)
}

/// The largest difference of two traces beside what they may differ by, and what and of what: forces of the largest force of all, energies of the largest energy,
/// frequencies of the highest of the file. At rows of one time alone.
pub fn difference(a: &Trace, b: &Trace, tolerance: Tolerance) -> (f64, String) {
    let mut worst = (0.0, String::from("nothing"));
    let mut note = |off: f64, may: f64, what: String| {
        let value = off / may;
        if value > worst.0 || value.is_nan() {
            worst = (value, format!("{off:.1e}: {what}"));
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
    let mut impacts = Impacts::default();
    for (i, t) in a.times.iter().enumerate() {
        let Some(k) = b.times.iter().position(|s| near(*s, *t)) else {
            continue;
        };
        let [moving, explicit] = a.moving[i];
        if moving && !tolerance.moving || explicit && impacts.parted {
            continue;
        }
        let may = match alike([a, b], [i, k]) {
            true => tolerance.same,
            false => tolerance.others,
        };
        let off = (a.energy[i] - b.energy[k]).abs() / energies;
        let energy = (
            off,
            format!(
                "ALLSE {:.4e} for {:.4e} at {t:.4}",
                b.energy[k], a.energy[i]
            ),
        );
        let force = |(name, values): (&String, &Vec<f64>)| {
            let others = b.forces.get(name)?;
            let off = (values[i] - others[k]).abs() / scale;
            let what = format!("{name} {:.4e} for {:.4e} at {t:.4}", others[k], values[i]);
            Some((off, what))
        };
        for (off, what) in a.forces.iter().filter_map(force).chain([energy]) {
            if explicit {
                impacts.note(off, may);
            }
            note(off, may, what);
        }
    }
    // Of a point at the limit of friction rounding says whether it sticks, and so what moves with it.
    let alike = a.statuses == b.statuses;
    // And of surfaces that were released what tolerances leave says whether they touch.
    let ends = [a, b].map(|trace| most(&mut trace.forces.values().filter_map(|f| f.last())));
    let released = ends[0].max(ends[1]) < ROUNDING * scale;
    for (file, values) in a.frequencies.iter().filter(|_| alike && !released) {
        let Some(others) = b.frequencies.get(file) else {
            continue;
        };
        // Below a thousandth of what a wave takes for the length of a body a frequency is that of a motion that nothing resists.
        let highest = most(&mut values.iter().chain(others)).max(1e-3);
        if values.len() != others.len() {
            let what = format!("{file}: {} modes for {}", others.len(), values.len());
            note(1.0, tolerance.same, what);
        }
        for (x, y) in values.iter().zip(others) {
            let off = (x - y).abs() / highest;
            note(off, tolerance.same, format!("{file}: {y:.5e} for {x:.5e}"));
        }
    }
    worst
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A run with a force a row.
    fn run(force: &[f64], moving: [bool; 2]) -> Trace {
        let rows = force.len();
        Trace {
            times: (1..=rows).map(|k| k as f64).collect(),
            moving: vec![moving; rows],
            attempts: vec![1.0; rows],
            forces: BTreeMap::from([("joint.CFN".to_string(), force.to_vec())]),
            energy: vec![1.0; rows],
            ..Trace::default()
        }
    }

    const TOLERANCE: Tolerance = Tolerance {
        same: 1e-3,
        others: 0.25,
        moving: true,
    };

    #[test]
    fn rounding_that_impacts_multiply_is_no_difference_and_a_jump_is_one() {
        let worst = |off: &[f64], explicit: bool| {
            let moving = [true, explicit];
            let other: Vec<f64> = off.iter().map(|o| 1.0 - o).collect();
            let one = run(&vec![1.0; off.len()], moving);
            difference(&one, &run(&other, moving), TOLERANCE).0
        };
        let grows = [1e-12, 1e-9, 1e-6, 1e-4, 1e-2, 0.5];
        assert!(worst(&grows, true) <= 1.0);
        assert!(worst(&grows, false) > 100.0);
        // What is there at once is another motion, and so is what comes at once.
        assert!(worst(&[1e-5, 1e-4, 1e-2], true) > 5.0);
        assert!(worst(&[1e-12, 1e-12, 1e-2], true) > 5.0);
    }

    #[test]
    fn another_way_of_increments_may_end_elsewhere() {
        let one = run(&[0.5, 1.0], [false; 2]);
        let mut other = run(&[0.25, 0.5, 0.9], [false; 2]);
        other.times = vec![0.5, 1.0, 2.0];
        let off = |other: &Trace| difference(&one, other, TOLERANCE).0;
        assert!((off(&other) - 100.0).abs() < 1e-9);
        other.attempts[0] = 2.0;
        assert!((off(&other) - 0.4).abs() < 1e-9);
    }
}
