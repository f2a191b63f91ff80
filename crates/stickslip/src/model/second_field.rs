//! Fields beside the displacements: temperatures that are found, concentrations, potentials. Each has unknowns and a matrix of its own, and is advanced after each
//! increment from what contact and bodies have done in it (staggered); the forces that follow from it act on the bodies in the next.

use std::fmt::Debug;

use crate::contact::interface::ContactView;
use crate::system::{Dofs, State};

/// A field with unknowns of its own. Its values are part of the [`Frame`](super::Frame), and so of checkpoints.
pub trait SecondField: Debug + Send + Sync {
    /// Name of the field in results.
    fn name(&self) -> &str;

    /// Numbering of the unknowns; where there are as many points as the mesh has, results show them there.
    fn dofs(&self) -> Dofs;

    /// Values at the start of the analysis, one by dof.
    fn initial(&self) -> Vec<f64>;

    /// Values at the end of an increment. What is not finite ends the analysis.
    fn advance(&self, increment: &FieldIncrement) -> Vec<f64>;

    /// Adds so many times the forces `[N]` with which values press on the bodies to `out`, by dof of the displacements. Like thermal strains they have no resultant.
    fn add_forces(&self, values: &[f64], times: f64, out: &mut [f64]);
}

/// An accepted increment as a second field sees it.
pub struct FieldIncrement<'a> {
    /// The interfaces at its end.
    pub contacts: Vec<ContactView<'a>>,
    /// Displacements and velocities at its end.
    pub state: &'a State,
    /// Values of the field at its start, one by dof.
    pub before: &'a [f64],
    /// Its length `[s]`.
    pub dt: f64,
}
