//! Steps in which nothing moves: modes about the state that is reached.

use super::simulation::Simulation;
use crate::contact::interface::Steady;
use crate::error::Error;
use crate::modal;
use crate::model::definition::Model;
use crate::results::observer::{Event, Observer};
use crate::solve::work::Work;

impl Simulation {
    /// Tells the interfaces whether sliding lasts in the step at hand; modes are about the sliding of the step before.
    pub(super) fn begin_sliding(&mut self, step: usize) {
        let plan = lasting(&self.model, step);
        for interface in &mut self.contact.interfaces {
            interface.directives.steady = match (plan, &self.model.steps[step].modal) {
                (Some(plan), _) => Some(plan.of(&interface.name)),
                // A belt runs all the time, whoever set it going.
                (None, Some(_)) => Some(Steady::default()),
                (None, None) => None,
            };
        }
    }

    /// Finds the modes that the step at hand asks for. Its time passes, and nothing moves.
    ///
    /// # Errors
    /// [`Error::Run`] if the linearised model cannot be solved with, and what observers return.
    pub(super) fn find_modes(&mut self, observers: &mut [&mut dyn Observer]) -> Result<(), Error> {
        let step = &self.model.steps[self.frame.step];
        let Some(plan) = step.modal.clone() else {
            return Ok(());
        };
        let end = step.end;
        self.solver.seen.tell(&Work::Modes);
        let Simulation {
            model,
            contact,
            frame,
            solver,
            ..
        } = self;
        let outcome = modal::compute(model, frame, contact, solver, &plan)?;
        let notes = outcome.notes.iter();
        let name = &outcome.step;
        (self.solver.log.notes).extend(notes.map(|note| format!("{name}: {note}")));
        self.frame.state.t = end;
        self.tell(observers, || Event::Modes(&outcome))?;
        self.summary.modes.push(outcome.figures());
        self.modes.push(outcome);
        self.tell_notes(observers)
    }
}

/// The sliding that lasts in a step; in one that looks for modes that of the last in which something moved.
fn lasting(model: &Model, step: usize) -> Option<&crate::model::SteadyPlan> {
    let mut before = model.steps[..=step].iter().rev();
    let moving = before.find(|s| s.modal.is_none());
    moving.and_then(|s| s.steady.as_ref())
}
