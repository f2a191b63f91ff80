//! How a checkpoint is taken, and how an analysis goes on from one.

use std::sync::Arc;
use std::time::Instant;

use super::checkpoint::{Checkpoint, Position, Working};
use super::position::{Increments, Steps};
use super::simulation::Simulation;
use crate::contact::interface::{History, memory, remember};
use crate::error::{Error, RunError};
use crate::integrate::explicit::{Explicit, ExplicitState};
use crate::integrate::implicit::Implicit;
use crate::integrate::integration::Integration;
use crate::integrate::quasi_static::QuasiStatic;
use crate::model::Setup;
use crate::model::contact::Contact;
use crate::model::definition::Model;
use crate::model::frame::Frame;
use crate::newton::condensed::Library;
use crate::time::scheme::Method;

impl Simulation {
    /// All state from which the analysis goes on; `None` before the first step.
    /// Increments that wait for their interiors or for their report are part of it: what is reported of them after it was taken, who goes on from it reports again.
    pub fn checkpoint(&self) -> Option<Checkpoint> {
        let ready = self.steps.begun && self.steps.next > 0 && self.taken_back.is_none();
        let ready = ready && self.trying.is_none();
        ready.then(|| self.checkpoint_with(self.working()))
    }

    /// The same with another working state than that of now.
    pub(super) fn checkpoint_with(&self, working: Working) -> Checkpoint {
        Checkpoint {
            frame: self.frame.clone(),
            position: Position {
                next: self.steps.next,
                running: (self.steps.running.as_ref()).map(Increments::standing),
                over: self.steps.over,
            },
            pending: self.pending.clone(),
            recovered: self.recovered.clone(),
            summary: self.summary.clone(),
            watches: self.judges.watches.clone(),
            loops: self.judges.loops.clone(),
            working,
        }
    }

    /// The state that attempts change.
    pub(super) fn working(&self) -> Working {
        let interfaces = self.contact.interfaces.iter().zip(&self.solver.conditions);
        Working {
            interfaces: interfaces
                .map(|(i, conditions)| memory(i, conditions))
                .collect(),
            couplings: self.contact.couplings.state(),
            explicit: self.integration.explicit().map(Explicit::state),
            solver: self.solver.state(),
        }
    }

    /// An analysis that goes on from a checkpoint, with the bits of one that never stopped. `setup` is what the problem builds to; `library` as in
    /// [`Simulation::with_library`].
    ///
    /// # Errors
    /// [`Error::Run`] if the checkpoint is one of another model, or bodies cannot be factored again.
    pub fn resume(
        setup: Setup,
        library: Arc<Library>,
        checkpoint: Checkpoint,
    ) -> Result<Self, Error> {
        let mut simulation = Simulation::with_library(setup, library)?;
        let Checkpoint { frame, working, .. } = &checkpoint;
        fits(&simulation, frame, working)?;
        for step in &simulation.model.steps[..=frame.step] {
            // Their energies are in the ledger.
            simulation
                .contact
                .change_laws(&frame.contacts, step, |_| {});
        }
        simulation.go_back_to(checkpoint)?;
        simulation.started = Instant::now();
        simulation.saved = (simulation.summary.attempts.increments, simulation.started);
        Ok(simulation)
    }

    /// Goes on from a checkpoint of this analysis, in the laws that hold there.
    pub(super) fn go_back_to(&mut self, checkpoint: Checkpoint) -> Result<(), Error> {
        let simulation = self;
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
        let Simulation {
            model,
            contact,
            solver,
            ..
        } = simulation;
        // Of increments that wait the frame knows nothing yet.
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
        let all = contact.interfaces.iter_mut().zip(histories);
        solver.conditions = all
            .map(|(interface, (history, memory))| remember(interface, history, memory, &u))
            .collect();
        contact.couplings.go_on_from(working.couplings);
        let t = frame.state.t;
        (solver.go_on_from(working.solver, model, &frame, contact)).map_err(|e| e.at(t))?;
        solver.condenser.go_ahead(ahead);
        simulation.integration = integration(&simulation.model, frame.step, working.explicit);
        simulation.steps = Steps {
            begun: true,
            over: position.over,
            next: position.next,
            running: (position.running)
                .map(|standing| Increments::at(&simulation.model.steps[frame.step], standing)),
        };
        simulation.frame = frame;
        simulation.pending = pending;
        simulation.recovered = recovered;
        simulation.summary = summary;
        simulation.judges.watches = watches;
        simulation.judges.loops = loops;
        Ok(())
    }
}

/// The integrator of a step that has begun.
fn integration(model: &Model, step: usize, explicit: Option<ExplicitState>) -> Integration {
    match (model.steps[step].dynamic, explicit) {
        (Some(dynamic), explicit) => match (dynamic.method, explicit) {
            (Method::Implicit(alphas), _) => Integration::Implicit(Implicit { dynamic, alphas }),
            (method, Some(state)) => {
                Integration::Explicit(Box::new(Explicit::again(model, method, state)))
            }
            (method, None) => Integration::Explicit(Box::new(Explicit::new(model, method))),
        },
        (None, _) => Integration::QuasiStatic(QuasiStatic),
    }
}

/// Whether a checkpoint is one of this model, by all lengths that there are.
fn fits(simulation: &Simulation, frame: &Frame, working: &Working) -> Result<(), Error> {
    let n = simulation.model.dofs.count();
    let interfaces = simulation.contact.interfaces.len();
    let fits = frame.state.u.len() == n
        && frame.forces.len() == n
        && frame.step < simulation.model.steps.len()
        && frame.contacts.interfaces.len() == interfaces
        && working.interfaces.len() == interfaces
        && fits_contact(&simulation.contact, &frame.contacts.interfaces);
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
