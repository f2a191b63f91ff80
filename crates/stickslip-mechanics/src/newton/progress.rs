use super::strategy::Strategy;
use crate::system::Tally;

/// One Newton iteration, for the log.
#[derive(Debug, Clone, Copy, PartialEq, crate::keep::Keep)]
pub struct Progress {
    /// Iteration, from 0; restarts with every multiplier update.
    pub iteration: usize,
    /// Multiplier update, from 0.
    pub round: usize,
    /// Out-of-balance force relative to the scale of forces, before the step; the larger one of displacements and multipliers.
    pub residual: f64,
    /// Step length taken.
    pub step: f64,
    /// Krylov iterations.
    pub krylov: usize,
    /// Points by status.
    pub tally: Tally,
    /// The way it belongs to.
    pub strategy: Strategy,
}

/// An equilibrium.
#[derive(Debug, Clone, PartialEq)]
pub struct Converged {
    /// Newton iterations, over all multiplier updates and all that was tried.
    pub iterations: usize,
    /// Multiplier updates.
    pub rounds: usize,
    /// Out-of-balance force relative to the scale of forces.
    pub residual: f64,
    /// Internal minus external forces at the dofs of the bulk: reactions at the fixed ones.
    pub forces: Vec<f64>,
    /// The part of the interfaces, at all dofs.
    pub contact: Vec<f64>,
    /// Points by status.
    pub tally: Tally,
    /// The solver of friction problems that it took, as in [`Fallback`](super::Fallback); `None` of plain iteration.
    pub solver: Option<String>,
}
