//! One increment as a system, and Newton's method on it.

use std::sync::Arc;

use super::work::Seen;
use crate::model::definition::Model;
use crate::model::frame::ContactMemory;
use crate::newton::{Bulk, Converged, Newton, Origin, System};
use crate::system::{BodyFrames, Constraints, Force, Rate, State, StepFailure};

/// The forces of the bulk in an increment.
pub(crate) enum Load {
    /// Elastic forces, and these from outside.
    External(Vec<f64>),
    /// Those of an increment in motion, known at the guess; its matrix is the one that was made ready last.
    Known(Origin),
}

/// An increment to be solved.
pub(crate) struct Task<'a> {
    /// The forces of the bulk.
    pub load: Load,
    /// Prescribed displacements at its end.
    pub constraints: Constraints,
    /// How velocities follow from displacements.
    pub rate: Option<Rate<'a>>,
    /// The frames in which bodies that turn freely are seen; `None` where these are those of the model.
    pub frames: Option<&'a Arc<BodyFrames>>,
    /// The state at its start.
    pub from: &'a State,
    /// What interfaces and couplings know there.
    pub contacts: &'a ContactMemory,
    /// Whether it is given up when the analysis is asked to stop: an increment can be tried again.
    pub stoppable: bool,
}

/// Newton's method on one system: where all increments are solved.
pub(crate) struct Iteration<'a> {
    pub newton: &'a mut Newton,
    pub seen: &'a mut Seen,
    pub model: &'a Model,
    pub forces: Vec<&'a mut dyn Force>,
    pub bulk: &'a mut dyn Bulk,
    pub rate: Option<Rate<'a>>,
    pub frames: Option<&'a Arc<BodyFrames>>,
    pub stoppable: bool,
}

impl<'a> Iteration<'a> {
    /// Solves it. `at` is the guess before and the solution after.
    pub fn solve(
        self,
        constraints: Constraints,
        from: &State,
        at: &mut State,
    ) -> Result<Converged, StepFailure> {
        let mut system = System {
            dofs: self.model.dofs,
            bulk: self.bulk,
            contact: self.forces,
            rate: self.rate,
            frames: self.frames,
            constraints,
            links: &self.model.links,
            stoppable: self.stoppable,
        };
        let seen = self.seen;
        (self.newton).solve(&mut system, from, at, &mut |p| seen.push(p))
    }
}
