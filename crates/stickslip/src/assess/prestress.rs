//! What the stress that vibrations begin from would do to their frequencies, which are found without it.

use super::figures::PRESTRESS;
use super::gate::Gate;
use super::view::View;
use crate::body::{prestress, recover};
use crate::model::limits::{GateMode, Limits};
use crate::number::digits;

/// A mode as it was found.
pub(crate) struct Shape<'a> {
    /// Cycles per unit of time.
    pub frequency: f64,
    /// `φᵀ K φ` `[J]`; that of the bodies alone where it is not given.
    pub stiffness: Option<f64>,
    /// Displacements by dof: the real and, of a complex mode, the imaginary part.
    pub parts: Vec<&'a [f64]>,
}

/// Judges the change of frequencies that the stress of the last accepted state would make, by Rayleigh's quotient with the shapes that were found; what a user should know of it goes
/// to `notes`.
pub(crate) fn judge_prestress(
    view: &View,
    modes: &[Shape],
    limits: &Limits,
    gate: &mut Gate,
    notes: &mut Vec<String>,
) {
    if limits.gate == GateMode::Off || modes.is_empty() {
        return;
    }
    let strained = view.strained();
    let parts: Vec<&[f64]> = modes.iter().flat_map(|m| m.parts.iter().copied()).collect();
    let mut works = vec![0.0; parts.len()];
    for body in view.model.elastic() {
        let own = prestress::work_of_stress(&body.elastic, &*strained, &parts);
        works.iter_mut().zip(own).for_each(|(sum, w)| *sum += w);
    }
    if works.iter().all(|w| *w == 0.0) {
        return;
    }
    let mut works = works.into_iter();
    let mut worst: Option<(usize, f64)> = None;
    for (k, mode) in modes.iter().enumerate() {
        let work: f64 = works.by_ref().take(mode.parts.len()).sum();
        let stiffness = mode.stiffness.unwrap_or_else(|| stored(view, &mode.parts));
        // What moves without strain has no frequency that could change by a part.
        if mode.frequency <= 0.0 || stiffness <= 0.0 {
            continue;
        }
        // Where nothing is left the body buckles.
        let change = (1.0 + work / stiffness).max(0.0).sqrt() - 1.0;
        let t = view.frame.state.t;
        gate.note(
            &PRESTRESS,
            "model",
            [change.abs(), 1.0],
            limits.prestress,
            t,
        );
        if worst.is_none_or(|(_, w)| change.abs() > f64::abs(w)) {
            worst = Some((k, change));
        }
    }
    // A change of a frequency by a hundredth is worth a word.
    let Some((k, change)) = worst.filter(|(_, change)| change.abs() > 0.01) else {
        return;
    };
    let found = modes[k].frequency;
    notes.push(match change > -1.0 {
        true => format!(
            "mode {}: found at {found} without the stress that it begins from; with it about {}, {:+.1} %",
            k + 1,
            digits((1.0 + change) * found, 5),
            100.0 * change,
            found = digits(found, 5),
        ),
        false => format!(
            "mode {}: found at {found} without the stress that it begins from; with it the body would buckle",
            k + 1,
            found = digits(found, 5),
        ),
    });
}

/// Twice the energy that bodies store at some displacements, as `φᵀ K φ` `[J]`.
fn stored(view: &View, parts: &[&[f64]]) -> f64 {
    let of = |part: &&[f64]| -> f64 {
        let bodies = view.model.elastic();
        bodies
            .map(|b| 2.0 * recover::strain_energy(&b.elastic, *part))
            .sum()
    };
    parts.iter().map(of).sum()
}
