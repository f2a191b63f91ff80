//! How a checkpoint is taken, and how an analysis goes on from one.

use std::time::Instant;

use super::checkpoint::{AttemptState, Checkpoint, Position};
use super::parts::Run;
use super::position::{Increments, Steps};
use crate::body::couplings::state as couplings_state;
use crate::contact::interface::{History, memory, remember};
use crate::error::{Error, RunError};
use crate::integrate::explicit::{Explicit, ExplicitState, explicit};
use crate::integrate::implicit::Implicit;
use crate::integrate::integrator::Integrator;
use crate::integrate::quasi_static::QuasiStatic;
use crate::model::contact::Contact;
use crate::model::definition::Model;
use crate::model::frame::Frame;
use crate::solve::state as solver_state;
use crate::time::scheme::Method;

/// All state from which the analysis goes on, with that which attempts change.
pub(super) fn checkpoint_with(run: &Run, working: AttemptState) -> Checkpoint {
    Checkpoint {
        frame: run.frame.clone(),
        position: Position {
            next: run.steps.next,
            running: (run.steps.running.as_ref()).map(Increments::standing),
            over: run.steps.over,
        },
        pending: run.pending.clone(),
        recovered: run.recovered.clone(),
        summary: run.summary.clone(),
        watches: run.judges.watches.clone(),
        loops: run.judges.loops.clone(),
        working,
    }
}

/// The state that attempts change.
pub(super) fn attempt_state(run: &Run) -> AttemptState {
    let interfaces = run.contact.interfaces.iter().zip(&run.solver.conditions);
    AttemptState {
        interfaces: interfaces
            .map(|(i, conditions)| memory(i, conditions))
            .collect(),
        couplings: couplings_state::state(&run.contact.couplings),
        explicit: explicit(run.integrator.as_ref()).map(Explicit::state),
        solver: solver_state::state(&run.solver),
    }
}

/// Goes on from a checkpoint of another run of this model.
///
/// # Errors
/// [`Error::Run`] if the checkpoint is one of another model, or bodies cannot be factored again.
pub(super) fn resume(run: &mut Run, checkpoint: Checkpoint) -> Result<(), Error> {
    let Checkpoint { frame, working, .. } = &checkpoint;
    fits(run, frame, working)?;
    for step in &run.model.steps[..=frame.step] {
        // Their energies are in the ledger.
        (run.contact).change_laws(&frame.contacts, step, |_| {});
    }
    go_back_to(run, checkpoint)?;
    run.started = Instant::now();
    Ok(())
}

/// Goes on from a checkpoint of this analysis, in the laws that hold there.
pub(super) fn go_back_to(run: &mut Run, checkpoint: Checkpoint) -> Result<(), Error> {
    let Checkpoint {
        frame,
        position,
        pending,
        recovered,
        summary,
        watches,
        loops,
        working,
    } = checkpoint;
    // Increments that wait are not in the frame yet.
    let waiting = pending.last().is_some_and(|p| p.found.is_some());
    let condensed = working.solver.condensed_displacements();
    let u = match condensed {
        Some(u) if waiting => u.to_vec(),
        _ => frame.state.u.clone(),
    };
    let ahead = recovered.as_ref().and_then(|r| r.back());
    let ahead = pending.last().or(ahead).and_then(|p| p.after.clone());
    let contacts = ahead.as_ref().unwrap_or(&frame.contacts);
    let histories = contacts.interfaces.iter().zip(working.interfaces);
    let all = run.contact.interfaces.iter_mut().zip(histories);
    run.solver.conditions = all
        .map(|(interface, (history, memory))| remember(interface, history, memory, &u))
        .collect();
    couplings_state::go_on_from(&mut run.contact.couplings, working.couplings);
    let t = frame.state.t;
    let (model, contact) = (&run.model, &mut run.contact);
    let again = solver_state::go_on_from(&mut run.solver, working.solver, model, &frame, contact);
    again.map_err(|e| e.at(t))?;
    run.solver.condenser.go_ahead(ahead);
    run.integrator = integrator(&run.model, frame.step, working.explicit);
    run.steps = Steps {
        begun: true,
        over: position.over,
        next: position.next,
        running: (position.running)
            .map(|standing| Increments::at(&run.model.steps[frame.step], standing)),
    };
    run.frame = frame;
    run.pending = pending;
    run.recovered = recovered;
    run.summary = summary;
    run.judges.watches = watches;
    run.judges.loops = loops;
    Ok(())
}

/// The integrator of a step that has begun.
fn integrator(model: &Model, step: usize, explicit: Option<ExplicitState>) -> Box<dyn Integrator> {
    let Some(dynamic) = model.steps[step].dynamic else {
        return Box::new(QuasiStatic);
    };
    match (dynamic.method, explicit) {
        (Method::Implicit(alphas), _) => Box::new(Implicit::new(dynamic, alphas)),
        (method, Some(state)) => Box::new(Explicit::again(model, method, state)),
        (method, None) => Box::new(Explicit::new(model, method)),
    }
}

/// Whether a checkpoint is one of this model, by all lengths that there are.
fn fits(run: &Run, frame: &Frame, working: &AttemptState) -> Result<(), Error> {
    let n = run.model.dofs.count();
    let interfaces = run.contact.interfaces.len();
    let fits = frame.state.u.len() == n
        && frame.forces.len() == n
        && frame.step < run.model.steps.len()
        && frame.contacts.interfaces.len() == interfaces
        && working.interfaces.len() == interfaces
        && fits_contact(&run.contact, &frame.contacts.interfaces);
    match fits {
        true => Ok(()),
        false => Err(Error::Run(RunError {
            message: "the checkpoint was taken of another model".into(),
            time: frame.state.t,
            culprits: Vec::new(),
            help: Some("resume with the problem and the meshes of the run that was stopped".into()),
        })),
    }
}

fn fits_contact(contact: &Contact, histories: &[History]) -> bool {
    let mut pairs = contact.interfaces.iter().zip(histories);
    pairs.all(|(interface, history)| history.fits(interface.points.len()))
}
