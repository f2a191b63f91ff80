//! Increments in motion are weighed before they are accepted: where the balance of energies opens too far over one, it is made smaller.

use std::sync::Arc;

use super::parts::Run;
use super::position::Increments;
use super::record::ledger_after;
use crate::assess::quality::still_energy;
use crate::contact::look;
use crate::integrate::explicit::explicit;
use crate::model::frame::ContactMemory;
use crate::model::limits::GateMode;
use crate::number::figure;
use crate::solve::accepted::Accepted;
use crate::system::{Cause, StepFailure};
use crate::time::Trial;
use crate::tolerance::NEGLIGIBLE;

/// Halvings in a row that did not help, after which they make no progress; fewer may be because of where in an increment a point opens or closes.
const USELESS: i32 = 4;

/// Commits an increment in motion, or takes it back as one to be made smaller.
pub(super) fn check_energy_balance(
    run: &mut Run,
    running: &mut Increments,
    trial: Trial,
    mut accepted: Accepted,
) -> Result<Accepted, StepFailure> {
    if run.step().dynamic.is_none() {
        return Ok(accepted);
    }
    let stage = accepted.stage(&run.frame.state, trial);
    let after = (run.contact).commit(&run.frame.contacts, &run.solver.conditions, &stage);
    if is_weighed(run) {
        let [opened, may] = opened(run, trial, &accepted, &after);
        let length = trial.to - trial.from;
        let resolved = opened <= may || resolves(run, trial, &after);
        let smallest = 0.5 * length < run.step().increments.smallest;
        let was_vain = running.no_progress;
        if is_to_halve(running, length, [opened, may], resolved, smallest) {
            let message = format!(
                "the energy balance error of the increment is {opened}, more than its share of the limit",
                opened = figure(opened)
            );
            return Err(StepFailure::new(Cause::TooFar, message));
        }
        // Where the limit is passed already, or smaller increments make no progress, they are as long as they would be without it; and up to a length that was
        // found too long it is not known that one is.
        let long = 2.0 * length >= running.too_long * (1.0 - NEGLIGIBLE);
        // Twice the increment makes the error eight times as large: that of all schemes here is of the third order.
        accepted.hard |= long && may > 0.0 && !running.no_progress && opened > may / 8.0;
        if running.no_progress && !was_vain {
            running.stepper.bound(length * f64::powi(2.0, USELESS));
        }
    }
    running.tight = accepted.hard;
    run.frame.contacts = Arc::new(after);
    run.integrator.accept();
    Ok(accepted)
}

/// Whether the length of increments is the program's to choose, and the balance of energies is judged.
fn is_weighed(run: &Run) -> bool {
    run.model.reports.quality.gate != GateMode::Off && !run.step().fixed
}

/// Whether an increment resolves how masses swing on the springs of contact, as they are pressed now.
fn resolves(run: &Run, trial: Trial, after: &ContactMemory) -> bool {
    let links = &run.model.links;
    let inverse = inverse_masses(run);
    let interfaces = run.contact.interfaces.iter().zip(&after.interfaces);
    let squared: f64 = interfaces
        .map(|(i, history)| look::pressed_frequency(i, history, &inverse, links))
        .sum();
    // Increments up to the time that the fastest mass on a spring of contact takes for a radian resolve it.
    squared.sqrt() * (trial.to - trial.from) <= 1.0
}

/// What a push on a point of the mesh moves `[1/kg]`, zero where that has no inertia of its own.
fn inverse_masses(run: &Run) -> Vec<f64> {
    let inverse = |m: f64| if m > 0.0 { 1.0 / m } else { 0.0 };
    match (explicit(run.integrator.as_ref()), &run.solver.inertia) {
        (Some(explicit), _) => {
            let points = 0..run.model.mesh.points.len();
            points
                .map(|p| explicit.inverse[run.model.dofs.of(p, 0)])
                .collect()
        }
        (None, Some(inertia)) => inertia
            .at_points(&run.model)
            .into_iter()
            .map(inverse)
            .collect(),
        (None, None) => vec![0.0; run.model.mesh.points.len()],
    }
}

/// By how much the balance of energies opens over a committed increment, and by how much it may `[J]`.
fn opened(run: &Run, trial: Trial, accepted: &Accepted, after: &ContactMemory) -> [f64; 2] {
    let (model, frame) = (&run.model, &run.frame);
    let first = run.summary.attempts.increments == 0;
    let ledger = ledger_after(model, frame, &run.contact, after, accepted, first);
    let mut quality = run.summary.balance.energy_quality;
    quality.note(&ledger);
    let limit = model
        .reports
        .quality
        .energy
        .unwrap_or(model.solution.energy_limit);
    let [before, after] = [frame.ledger.open(), ledger.open()];
    let part = (trial.to - trial.from) / time_in_motion(run, trial.from);
    let [opened, may] = [
        after - before,
        allowance(limit * quality.scale, before, part),
    ];
    if opened <= may {
        return [opened, may];
    }
    // What the gate takes for no energy at all is none here.
    let forces = [&accepted.forces, &accepted.contact, &accepted.external];
    let largest = forces.into_iter().flatten();
    let largest = largest.fold(0.0, |m: f64, f| m.max(f.abs()));
    let scale = quality.scale.max(still_energy(model, largest));
    [opened, allowance(limit * scale, before, part)]
}

/// The time for which bodies will be in motion from here on.
fn time_in_motion(run: &Run, from: f64) -> f64 {
    let ahead = run.model.steps[run.frame.step..].iter();
    let moving = ahead.filter(|s| s.dynamic.is_some());
    moving.map(|s| s.end - s.start.max(from)).sum()
}

/// By how much a balance that is open by so much may open over a `part` of the time that is left.
fn allowance(limit: f64, open: f64, part: f64) -> f64 {
    // Half of the limit of the gate may be used up at once, as impacts do; the rest is there for the time that is left. One increment may
    // use up half of what that leaves: however many there are, it is kept.
    let at_once = 0.5 * (0.5 * limit - open);
    at_once.max(part * (limit - open))
}

/// Whether the balance opens too far over an increment of this length, and a smaller one would help. Where the limit is passed already none does; and where
/// halving makes the error no smaller than by half, time after time, many small increments come to no less than one: they make no progress until one opens the
/// balance by no more than it may. What opens or closes on the way may spoil single ones, and increments that do not resolve how masses swing on the
/// springs of contact are all alike.
fn is_to_halve(
    running: &mut Increments,
    length: f64,
    [opened, may]: [f64; 2],
    resolved: bool,
    smallest: bool,
) -> bool {
    if may <= 0.0 || opened <= may {
        running.no_progress = false;
        return false;
    }
    let halved = (2.0 * length - running.too_long).abs() <= NEGLIGIBLE * running.too_long;
    let useless = match running.opened {
        // The error has to fall with this power of the increment for halving to help: errors of the first power add up to the same, however
        // short increments are.
        Some((before, useless)) if halved && opened > before * f64::powf(0.5, 1.5) => useless + 1,
        _ => 0,
    };
    running.opened = resolved.then_some((opened, useless));
    running.too_long = length;
    running.no_progress |= resolved && useless >= USELESS;
    !running.no_progress && !smallest
}

#[cfg(test)]
mod tests {
    use super::{Increments, allowance, is_to_halve};
    use crate::time::Stepper;

    /// Increments that each use up what they may come near the limit at the end of the time, not long before.
    #[test]
    fn what_the_limit_leaves_lasts_for_the_time_that_is_left() {
        let (count, limit) = (1000, 1.0);
        let mut open = 0.0;
        let mut least = f64::INFINITY;
        for k in 0..count {
            let may = allowance(limit, open, 1.0 / f64::from(count - k));
            least = least.min(may);
            open += may;
        }
        assert!(open <= limit && open > 0.9 * limit, "{open}");
        assert!(least > 0.4 * limit / f64::from(count), "{least}");
        // An impact may take more, and where the limit is passed nothing is left.
        assert!(allowance(limit, 0.0, 1e-6) > 0.2);
        assert!(allowance(limit, 1.1, 0.5) < 0.0);
    }

    /// How often an increment is halved that opens the balance by this power of its length, a thousand times as much as it may at first, and whether it made no progress.
    fn halved(power: i32) -> (i32, bool) {
        let sizes = crate::time::Increments {
            initial: 1.0,
            smallest: 0.0,
            largest: 1.0,
        };
        let mut running = Increments {
            stepper: Stepper::new(0.0, vec![1.0], sizes),
            accepted: 0,
            attempt: 1,
            opened: None,
            no_progress: false,
            too_long: f64::INFINITY,
            tight: false,
            jumps: Default::default(),
            failed: None,
        };
        for halvings in 0..100 {
            let length = f64::powi(0.5, halvings);
            // What it may is a part of what the limit leaves for the time that is left.
            let balance = [1e3 * length.powi(power), length];
            if !is_to_halve(&mut running, length, balance, true, false) {
                return (halvings, running.no_progress);
            }
        }
        (100, running.no_progress)
    }

    #[test]
    fn halving_ends_where_many_small_increments_come_to_no_less_than_one() {
        let (halvings, no_progress) = halved(1);
        assert!(no_progress && halvings < 8, "{halvings}");
        for power in [2, 3] {
            let (halvings, no_progress) = halved(power);
            assert!(!no_progress && halvings < 12, "{power}: {halvings}");
        }
    }
}
