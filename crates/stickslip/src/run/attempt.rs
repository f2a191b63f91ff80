//! One attempt at an increment.

use super::failures::note_fallbacks;
use super::floating::prepare_floating;
use super::parts::Run;
use super::position::Increments;
use super::state_change;
use crate::error::Error;
use crate::model::scene::Scene;
use crate::results::observer::Observer;
use crate::solve::accepted::Accepted;
use crate::solve::work::Work;
use crate::system::{Cause, StepFailure};
use crate::time::Trial;

/// The next increment to attempt, no longer than the integrator allows; `None` at the end of the step.
pub(super) fn propose(run: &Run, running: &mut Increments) -> Option<Trial> {
    let integrator = &run.integrator;
    match integrator.bound(&run.model, &run.frame, &run.contact) {
        Some(bound) if running.attempt == 1 && !running.tight => running.stepper.bound(bound),
        Some(bound) if running.attempt == 1 => running.stepper.bound_again(bound),
        // The bound now is that of where an attempt went wrong: a law may be stiffer there than it will ever be.
        _ => {}
    }
    if let Some(bound) = state_change::bound(run).filter(|_| running.attempt == 1) {
        running.stepper.bound_again(bound);
    }
    running.stepper.next()
}

/// Makes ready what holds in an increment.
pub(super) fn prepare(
    run: &mut Run,
    trial: Trial,
    attempt: usize,
    observers: &mut [&mut dyn Observer],
) -> Result<(), Error> {
    count_cycles(run, trial);
    if run.step().dynamic.is_none() {
        prepare_floating(run, trial, observers)?;
    }
    run.solver.seen.tell(&Work::Increment {
        step: &run.step().name,
        from: trial.from,
        to: trial.to,
        attempt,
    });
    Ok(())
}

/// Takes note for how many cycles beside its own an increment stands.
fn count_cycles(run: &mut Run, trial: Trial) {
    let step = run.step();
    let since = trial.from - step.start;
    let block = step.cycles.map(|c| c.block(since, run.frame.block));
    let skipped = block.map_or(0.0, |b| b.stands_for as f64 - 1.0);
    for conditions in &mut run.solver.conditions {
        conditions.skipped = skipped;
    }
}

/// Makes one attempt, and tells what happened in it.
pub(super) fn attempt(
    run: &mut Run,
    trial: Trial,
    observers: &mut [&mut dyn Observer],
) -> Result<Result<Accepted, StepFailure>, Error> {
    run.solver.seen.clear();
    let (contact, solver) = (&mut run.contact, &mut run.solver);
    let integrator = &mut run.integrator;
    let outcome = integrator.attempt(&run.model, &run.frame, contact, solver, trial);
    // Of increments that wait for their interiors it is told with them.
    if run.solver.condenser.at_rest().is_none() {
        let seen = run.solver.seen.take();
        run.tell_iterations(&seen, observers);
    }
    if matches!(&outcome, Err(e) if e.cause == Cause::Interrupted) {
        // It is tried again from its beginning, as if nothing had been tried.
        run.solver.newton.fallbacks.clear();
        return Ok(outcome);
    }
    let outcome = outcome.and_then(|found| state_change::check(run, trial).map(|()| found));
    let notes = run.solver.factors.notes();
    run.solver.log.notes.extend(notes);
    note_fallbacks(run, &trial);
    run.tell_notes(observers)?;
    let scene = Scene {
        model: &run.model,
        contact: &run.contact,
        frame: &run.frame,
    };
    let outcome = run.solver.floating.judge(scene, outcome, trial);
    if run.solver.floating.went_astray() {
        run.reset_predictor();
    }
    Ok(outcome)
}
