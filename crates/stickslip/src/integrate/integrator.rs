//! How increments are made: one attempt at one increment.

use std::any::Any;

use crate::model::contact::Contact;
use crate::model::definition::Model;
use crate::model::frame::Frame;
use crate::solve::accepted::Accepted;
use crate::solve::solver::Solver;
use crate::system::StepFailure;
use crate::time::Trial;

/// Makes increments of one kind.
pub(crate) trait Integrator: Any + Send + Sync {
    /// Tries one increment from the last accepted one. Nothing but caches, and what interfaces know of an attempt, is changed.
    fn attempt(
        &mut self,
        model: &Model,
        frame: &Frame,
        contact: &mut Contact,
        solver: &mut Solver,
        trial: Trial,
    ) -> Result<Accepted, StepFailure>;

    /// The last attempt is accepted.
    fn accept(&mut self) {}

    /// The longest increment that is stable now, with its safety; `None` where any is, or where increments are given.
    fn bound(&self, _model: &Model, _frame: &Frame, _contact: &Contact) -> Option<f64> {
        None
    }
}
