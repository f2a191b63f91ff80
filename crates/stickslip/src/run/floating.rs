//! Bodies that only contact can hold: moved until they touch, and anchored, between attempts.

use std::sync::Arc;

use super::parts::Run;
use super::pending::flush;
use crate::error::Error;
use crate::results::observer::Observer;
use crate::solve::accepted::Accepted;
use crate::solve::{follow, released};
use crate::system::StepFailure;
use crate::time::Trial;

/// Moves floating bodies that touch nothing until they do, and notes where they are.
pub(super) fn prepare_floating(
    run: &mut Run,
    trial: Trial,
    observers: &mut [&mut dyn Observer],
) -> Result<(), Error> {
    let solver = &mut run.solver;
    if follow::has_gaps_to_close(solver, &run.model, &run.frame, &run.contact, trial) {
        flush(run, observers)?;
        follow::close_gaps(
            &mut run.solver,
            &run.model,
            &mut run.frame,
            &mut run.contact,
            trial,
        );
        run.tell_notes(observers)?;
    }
    if released::is_to_keep_bodies(&run.solver, run.view().scene, trial) {
        flush(run, observers)?;
        follow::keep_bodies(
            &mut run.solver,
            &run.model,
            &run.frame,
            &mut run.contact,
            trial,
        );
        run.tell_notes(observers)?;
    }
    let waiting = !run.pending.is_empty();
    follow::set_out(
        &mut run.solver,
        &run.frame,
        &mut run.contact,
        trial,
        waiting,
    );
    Ok(())
}

/// Whether an increment is computed again from where floating bodies have come.
pub(super) fn restarts(
    run: &mut Run,
    trial: Trial,
    accepted: &Accepted,
    observers: &mut [&mut dyn Observer],
) -> Result<bool, Error> {
    let followed = &mut run.summary.loose.followed;
    let anchored = run.solver.floating.is_anchored();
    let contacts = Arc::clone(run.solver.contacts(&run.frame));
    let floating = &mut run.solver.floating;
    if !floating.wants_restart(&run.model, &run.contact, &contacts, followed) {
        if anchored {
            released::note_released(&mut run.solver, &run.model, &run.frame, accepted);
            run.tell_notes(observers)?;
        }
        return Ok(false);
    }
    flush(run, observers)?;
    follow::restart_from_rigid_motion(
        &mut run.solver,
        &run.model,
        &mut run.frame,
        &mut run.contact,
        trial,
    );
    run.tell_notes(observers)?;
    Ok(true)
}

/// Whether an increment that failed is computed again with floating bodies anchored, or anchored more stiffly.
pub(super) fn anchors_again(
    run: &mut Run,
    trial: Trial,
    failure: &StepFailure,
    observers: &mut [&mut dyn Observer],
) -> Result<bool, Error> {
    let stiffer = run.solver.floating.wants_stiffer_anchors(failure);
    if stiffer {
        run.reset_predictor();
    } else if !run.solver.floating.may_follow(run.step(), failure) {
        return Ok(false);
    }
    flush(run, observers)?;
    let (model, frame, contact) = (&run.model, &mut run.frame, &mut run.contact);
    match stiffer {
        true => follow::anchor(&mut run.solver, model, frame, contact, trial),
        false => follow::follow(&mut run.solver, model, frame, contact, trial),
    }
    run.tell_notes(observers)?;
    Ok(true)
}
