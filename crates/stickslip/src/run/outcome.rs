//! What follows from an attempt: an increment that is accepted, or another attempt, or the end.

use super::cycles::{end_block, try_fewer_cycles};
use super::failures::{examine, give_up, refuse_unbalanced, reject};
use super::fallback::{may_solve_sparsely, solve_sparsely};
use super::floating::anchors_again;
use super::parts::Run;
use super::pending::{commit, flush, recover_pending};
use super::position::Increments;
use super::queue::{Failed, Pending};
use crate::error::Error;
use crate::results::observer::{Event, Observer};
use crate::solve::accepted::Accepted;
use crate::solve::condensed::condensing;
use crate::system::Cause;
use crate::time::Trial;

/// Goes on from an increment that was accepted.
pub(super) fn accept(
    run: &mut Run,
    running: &mut Increments,
    trial: Trial,
    accepted: Accepted,
    observers: &mut [&mut dyn Observer],
) -> Result<(), Error> {
    running.accepted += 1;
    let increment = running.accepted;
    let iterations = if accepted.hard {
        usize::MAX
    } else {
        accepted.effort.iterations
    };
    running.stepper.accept(trial, iterations);
    let plan = &run.model.reports.output;
    let last = running.stepper.next().is_none();
    let due = last || plan.times.contains(&trial.to) || increment.is_multiple_of(plan.every);
    let row = due || increment.is_multiple_of(plan.history_every);
    let pending = Pending {
        trial,
        accepted,
        increment,
        attempt: running.attempt,
        fields: due,
        row,
        seen: Vec::new(),
        after: None,
        found: None,
    };
    if pending.row {
        let advance = pending.advance();
        run.tell(observers, || Event::Accepted(&advance))?;
    }
    commit(run, pending, last, observers)?;
    // What a second field presses with in the next increment follows from this one.
    if !run.frame.fields.is_empty() {
        flush(run, observers)?;
    }
    if run.step().corners.contains(&trial.to) {
        run.reset_predictor();
    }
    running.attempt = 1;
    end_block(run, running, trial.to, observers)
}

/// Decides what is tried after an attempt that failed.
pub(super) fn answer(
    run: &mut Run,
    running: &mut Increments,
    failed: Failed,
    observers: &mut [&mut dyn Observer],
) -> Result<(), Error> {
    let Failed { trial, failure, .. } = &failed;
    match failure.cause {
        Cause::Engine => {
            // Interiors of those before it cannot be found any more.
            run.pending.clear();
            return Err(last_failure(run, running.attempt, failed));
        }
        // With half the increment it takes the same memory.
        Cause::Memory => {
            flush(run, observers)?;
            return Err(last_failure(run, running.attempt, failed));
        }
        Cause::Reach => {
            flush(run, observers)?;
            condensing::widen(&mut run.solver, &run.model, &run.frame, &run.contact);
            run.tell_notes(observers)?;
        }
        Cause::Interior => {
            flush(run, observers)?;
            solve_sparsely(run, failure, observers)?;
        }
        _ if anchors_again(run, *trial, failure, observers)? => {}
        _ => {
            // The increments before it are reported first, each by a call of its own.
            recover_pending(run);
            running.failed = Some(failed);
        }
    }
    Ok(())
}

/// The error of an attempt that no other can follow.
fn last_failure(run: &mut Run, attempt: usize, failed: Failed) -> Error {
    let Failed {
        trial,
        counters,
        failure,
    } = failed;
    examine(run, &trial, attempt, counters, &failure);
    give_up(run, failure, &trial).into()
}

/// Makes an increment that failed smaller.
pub(super) fn cut_back(
    run: &mut Run,
    running: &mut Increments,
    failed: Failed,
    observers: &mut [&mut dyn Observer],
) -> Result<(), Error> {
    let Failed {
        trial,
        counters,
        failure,
    } = failed;
    let seen = run.solver.seen.take();
    run.tell_iterations(&seen, observers);
    examine(run, &trial, running.attempt, counters, &failure);
    running.attempt += 1;
    reject(run, &trial, &failure);
    let may_be = !matches!(failure.cause, Cause::NotFinite | Cause::CollapsedCell);
    if may_be
        && run.step().dynamic.is_none()
        && let Some(error) = refuse_unbalanced(run, trial)
    {
        return Err(error);
    }
    if !running.stepper.reject(trial) {
        if may_solve_sparsely(run, &failure) {
            let initial = running.stepper.initial();
            running.stepper.again(trial.from, initial);
            running.attempt = 1;
            return solve_sparsely(run, &failure, observers);
        }
        if try_fewer_cycles(run, running)? {
            return Ok(());
        }
        return Err(give_up(run, failure, &trial).into());
    }
    run.tell(observers, || Event::Cutback(&trial, &failure))
}
