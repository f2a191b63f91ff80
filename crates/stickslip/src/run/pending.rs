//! Accepted increments on their way into the results.

use std::collections::VecDeque;
use std::sync::Arc;
use std::time::Instant;

use super::queue::{Pending, TakenBack};
use crate::assess::{quality, travel};
use crate::solve::condensed::at_rest;

use super::parts::{Run, view};
use super::record::record;
use crate::error::Error;
use crate::fatigue::Maximum;
use crate::results::observer::{Event, Observer};
use crate::results::{fatigue, history, loops};
use crate::solve::choice::TOGETHER;
use crate::system::{Cause, StepFailure};
use crate::time::Trial;

/// Goes on from an accepted increment: at once, or with others in one sweep.
pub(super) fn commit(
    run: &mut Run,
    mut pending: Pending,
    last: bool,
    observers: &mut [&mut dyn Observer],
) -> Result<(), Error> {
    let Run {
        model,
        contact,
        frame,
        solver,
        ..
    } = run;
    let Pending {
        accepted, trial, ..
    } = &pending;
    let Some(condensed) = solver.condenser.at_rest() else {
        // In motion that has been done when it was weighed.
        if model.steps[frame.step].dynamic.is_none() {
            let stage = accepted.stage(&frame.state, *trial);
            frame.contacts = Arc::new(contact.commit(&frame.contacts, &solver.conditions, &stage));
            (frame.course).go_on(trial.to - trial.from, frame.state.u.clone());
        }
        return report(run, pending, observers);
    };
    let stage = accepted.stage(&condensed.state, *trial);
    let after = contact.commit(solver.contacts(frame), &solver.conditions, &stage);
    let after = Arc::new(after);
    pending.found = at_rest::move_ahead(solver, &mut pending.accepted, pending.trial);
    pending.seen = solver.seen.take();
    solver.condenser.go_ahead(Some(Arc::clone(&after)));
    pending.after = Some(after);
    run.pending.push(pending);
    if last || run.pending.len() >= TOGETHER {
        recover_pending(run);
    }
    Ok(())
}

/// Finds the interiors of all pending increments and reports them.
pub(super) fn flush(run: &mut Run, observers: &mut [&mut dyn Observer]) -> Result<(), Error> {
    recover_pending(run);
    while report_next(run, observers)? {}
    Ok(())
}

/// Finds the interiors of all pending increments.
pub(super) fn recover_pending(run: &mut Run) {
    if run.pending.is_empty() {
        return;
    }
    let mut queue: VecDeque<Pending> = run.pending.drain(..).collect();
    let unknown = queue.iter_mut();
    let unknown = unknown.filter_map(|p| Some((p.found.as_ref()?, &mut p.accepted)));
    at_rest::recover(&mut run.solver, unknown);
    run.recovered = Some(queue);
}

/// Reports the next of the increments whose interiors are known; `false` if there is none.
pub(super) fn report_next(
    run: &mut Run,
    observers: &mut [&mut dyn Observer],
) -> Result<bool, Error> {
    let Some(mut queue) = run.recovered.take() else {
        return Ok(false);
    };
    let mut outcome = Ok(());
    if let Some(mut one) = queue.pop_front() {
        if let Err(failure) = complete(run, &mut one) {
            run.solver.condenser.go_ahead(None);
            if failure.cause == Cause::Engine {
                run.pending.clear();
                return Err(failure.at(run.frame.state.t).into());
            }
            return Err(roll_back(run, &one, failure));
        }
        if let Some(after) = one.after.take() {
            run.frame.contacts = after;
        }
        outcome = report(run, one, observers);
    }
    if queue.is_empty() || outcome.is_err() {
        run.solver.condenser.go_ahead(None);
    } else {
        run.recovered = Some(queue);
    }
    outcome.map(|()| true)
}

/// Completes an increment whose interior has been found.
fn complete(run: &mut Run, one: &mut Pending) -> Result<(), StepFailure> {
    let (Some(found), Some(after)) = (&one.found, &one.after) else {
        return Ok(());
    };
    let (model, frame, contact) = (&run.model, &mut run.frame, &mut run.contact);
    at_rest::complete(
        &mut run.solver,
        model,
        frame,
        contact,
        after,
        found,
        &mut one.accepted,
    )
}

/// Enters an increment into the ledger and tells the observers.
fn report(
    run: &mut Run,
    pending: Pending,
    observers: &mut [&mut dyn Observer],
) -> Result<(), Error> {
    run.tell_iterations(&pending.seen, observers);
    let (frame, summary) = (&mut run.frame, &mut run.summary);
    let effort = record(&run.model, &run.contact, frame, summary, pending.accepted);
    let started = Instant::now();
    if pending.row {
        let row = history::row(
            &view!(run),
            &run.judges.around,
            pending.trial,
            effort,
            pending.increment,
            pending.attempt,
        );
        let named = row.names.iter().cloned().zip(row.values.iter().copied());
        run.summary.last = named.collect();
        judge(run);
        match &mut run.block {
            Some(block) => {
                block.rows.push(row);
                block.fields |= pending.fields;
            }
            None => run.tell(observers, || Event::Increment(&row))?,
        }
    }
    let view = view!(run);
    let judges = &mut run.judges;
    let cycle = loops::follow(&view, &judges.shares, &mut judges.loops, pending.trial);
    let worst = follow_fatigue(run, pending.trial);
    if let Some(mut row) = cycle {
        fatigue::add_columns(&mut row, &worst, run.model.dofs.dim);
        run.summary.fatigue = worst;
        match &mut run.block {
            Some(block) => block.cycles.push(row),
            None => run.tell(observers, || Event::Cycle(&row))?,
        }
    }
    if pending.fields && run.block.is_none() {
        run.write_fields(observers)?;
    }
    run.summary.cost.phases.write += started.elapsed().as_secs_f64();
    Ok(())
}

/// Takes note of an increment for the criteria of fatigue. Where a cycle ends with it, what they say of that.
fn follow_fatigue(run: &mut Run, trial: Trial) -> Vec<Maximum> {
    let Some(watched) = &run.judges.watched else {
        return Vec::new();
    };
    let Some(increment) = fatigue::increment(&view!(run), watched, trial) else {
        return Vec::new();
    };
    run.frame.fatigue.enter(increment);
    let Some(found) = fatigue::judge(&view!(run), watched, trial) else {
        return Vec::new();
    };
    let worst = fatigue::maxima(&view!(run), &found, trial);
    run.frame.fatigue.close(found);
    worst
}

/// Judges the last accepted increment.
fn judge(run: &mut Run) {
    let limits = &run.model.reports.quality;
    let view = view!(run);
    let summary = &mut run.summary;
    quality::watch(&view, &mut run.judges.watches);
    quality::judge_quality(&view, limits, &mut summary.quality);
    travel::judge_travel(
        &view,
        limits,
        &mut summary.quality,
        &mut summary.largest_rotation,
        &mut summary.findings,
    );
    summary.quality.settle();
    run.judges.unjoined.judge(&view, &mut summary.findings);
}

/// Takes note of an increment whose interior does not hold: interfaces know what they knew before. The error ends the turn.
fn roll_back(run: &mut Run, one: &Pending, failure: StepFailure) -> Error {
    run.pending.clear();
    run.taken_back = Some(TakenBack {
        trial: one.trial,
        increment: one.increment,
        failure: failure.clone(),
    });
    failure.at(one.trial.to).into()
}
