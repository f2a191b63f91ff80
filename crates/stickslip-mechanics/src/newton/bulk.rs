use super::settings::Settings;
use super::statistics::Statistics;
use crate::system::{Assembler, StepFailure};

/// Everything that acts on the unknowns but the interfaces: bodies, springs, inertia, loads. Its forces are linear in the
/// displacements unless bodies turn cell by cell, and how they are found and how the system of a Newton iteration is solved is its own affair.
///
/// Vectors are over all dofs of the model; a bulk reads and writes only the entries at its [`dofs`](Bulk::dofs).
pub trait Bulk {
    /// The dofs whose forces are evaluated, ascending.
    fn dofs(&self) -> &[usize];

    /// Dofs that are no unknowns, by dof.
    fn fixed(&self) -> &[bool];

    /// Starts an attempt at the guess.
    fn begin(&mut self);

    /// Writes internal minus external forces at displacements `u`, and returns the size of the largest forces that balance in
    /// them. `u` is the guess, moved by the steps [`advance`](Bulk::advance) was told of.
    fn forces(&mut self, u: &[f64], out: &mut [f64]) -> f64;

    /// How stiffly a dof resists, for the rounding of forces `[N/m]`.
    fn diagonal(&self, dof: usize) -> f64;

    /// Whether the solution needs symmetric approximations for the tangents of the interfaces.
    fn wants_surrogates(&self) -> bool {
        true
    }

    /// How many solutions with one matrix cost no more than another attempt of Newton's method, or than so many operations.
    fn affordable(&self, settings: &Settings, operations: f64) -> usize;

    /// Whether a solution with this tangent costs much more where gaps and slips curve.
    fn prefers_straight(&self, _contact: &Assembler) -> bool {
        false
    }

    /// Whether the solution needs to know which points meet which facets.
    fn wants_pairs(&self) -> bool {
        false
    }

    /// Whether the bulk can tell how the dofs that the interfaces act on move.
    fn covers(&self, _contact: &Assembler) -> Result<(), StepFailure> {
        Ok(())
    }

    /// Solves `(bulk + contact) du = b` for the unknowns to a relative residual of `tolerance`; `du` is zero at fixed dofs. Returns
    /// the Krylov iterations.
    fn solve(
        &mut self,
        contact: &Assembler,
        b: &[f64],
        tolerance: f64,
        du: &mut [f64],
        settings: &Settings,
        statistics: &mut Statistics,
    ) -> Result<usize, StepFailure>;

    /// The displacements are now those before the last solution plus `step` times it.
    fn advance(&mut self, step: f64);
}
