//! How increments are made: one attempt at one increment.

use super::accepted::Accepted;
use super::contact::Contact;
use super::explicit::Explicit;
use super::frame::Frame;
use super::implicit::Implicit;
use super::model::Model;
use super::quasi_static::QuasiStatic;
use super::solver::Solver;
use crate::system::StepFailure;
use crate::time::Trial;

/// Makes increments of one kind.
pub(super) trait Integrator {
    /// Tries one increment from the last accepted one. Nothing but caches, and what interfaces know of an attempt, is changed.
    fn attempt(
        &mut self,
        model: &Model,
        frame: &Frame,
        contact: &mut Contact,
        solver: &mut Solver,
        trial: Trial,
    ) -> Result<Accepted, StepFailure>;

    /// The longest increment that is stable now, with its safety; `None` where any is, or where increments are given.
    fn bound(&self, _model: &Model, _frame: &Frame, _contact: &Contact) -> Option<f64> {
        None
    }
}

/// The integrator of the step at hand.
pub(super) enum Integration {
    QuasiStatic(QuasiStatic),
    Implicit(Implicit),
    Explicit(Box<Explicit>),
}

impl Integration {
    /// It, whichever it is.
    pub fn as_dyn(&self) -> &dyn Integrator {
        match self {
            Integration::QuasiStatic(one) => one,
            Integration::Implicit(one) => one,
            Integration::Explicit(one) => one.as_ref(),
        }
    }

    /// It, to make increments.
    pub fn as_dyn_mut(&mut self) -> &mut dyn Integrator {
        match self {
            Integration::QuasiStatic(one) => one,
            Integration::Implicit(one) => one,
            Integration::Explicit(one) => one.as_mut(),
        }
    }

    /// What explicit increments need, if they are made.
    pub fn explicit(&self) -> Option<&Explicit> {
        match self {
            Integration::Explicit(one) => Some(one),
            _ => None,
        }
    }
}
