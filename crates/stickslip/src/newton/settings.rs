use super::strategy::Strategy;
use crate::system::Tally;

/// Dimensionless settings of the iteration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Largest out-of-balance force relative to the forces in play.
    pub tolerance: f64,
    /// Most iterations for one equilibrium.
    pub max_iterations: usize,
    /// Most halvings of a Newton step.
    pub line_search: usize,
    /// Most iterations of the Krylov solver with one factor before a fresh factor is made.
    pub krylov_patience: usize,
    /// Relative residual to which a linear system is solved while points still change status; afterwards it is solved as
    /// accurately as `tolerance` asks for.
    pub linear_tolerance: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Settings {
            tolerance: 1e-8,
            max_iterations: 30,
            line_search: 5,
            krylov_patience: 12,
            linear_tolerance: 1e-4,
        }
    }
}

/// Counts over an analysis.
#[derive(Debug, Clone, Copy, Default, PartialEq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub struct Statistics {
    /// Newton iterations.
    pub iterations: usize,
    /// Multiplier updates.
    pub augmentations: usize,
    /// Increments reached by continuation from softer friction, after a plain iteration had failed.
    pub continuations: usize,
    /// Ways other than plain iteration that were tried.
    pub fallbacks: usize,
    /// Symbolic factorisations.
    pub analyses: usize,
    /// Numeric factorisations.
    pub factorisations: usize,
    /// Substructures factored.
    pub substructures_made: usize,
    /// Substructures taken from memory: of an earlier run, step or increment.
    pub substructures_shared: usize,
    /// Substructures read from files.
    pub substructures_read: usize,
    /// Krylov iterations.
    pub krylov: usize,
    /// Factorisations of matrices of gaps and slips.
    pub reduced: usize,
    /// Seconds in looking for substructures made before, reading them included.
    pub seconds_find: f64,
    /// Seconds in symbolic factorisation.
    pub seconds_order: f64,
    /// Seconds in numeric factorisation.
    pub seconds_factor: f64,
    /// Seconds in solves.
    pub seconds_solve: f64,
    /// Seconds in inverting what partial factorisations leave.
    pub seconds_condense: f64,
    /// Seconds in finding interiors.
    pub seconds_recover: f64,
    /// Seconds in search, pairing and assembly of interfaces.
    pub seconds_contact: f64,
    /// Nonzeros of the last factor.
    pub factor_nonzeros: usize,
    /// Additions and multiplications of all numeric factorisations and inverses.
    pub flops: f64,
    /// Bytes of the last factor and what was condensed with it.
    pub factor_bytes: u64,
    /// Seconds that ordering, one factorisation and one solution of the same bodies took or would take.
    pub linear_solve: f64,
    /// Multigrid hierarchies made.
    pub setups: usize,
    /// Hierarchies whose finest level was made anew.
    pub refreshes: usize,
    /// Levels of the last hierarchy; 0 without one.
    pub levels: usize,
    /// Scalars on all its levels over those on the finest.
    pub operator_complexity: f64,
    /// Its size `[bytes]`.
    pub hierarchy_bytes: usize,
}

/// One Newton iteration, for the log.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Progress {
    /// Iteration, from 0; restarts with every multiplier update.
    pub iteration: usize,
    /// Multiplier update, from 0.
    pub round: usize,
    /// Out-of-balance force relative to the forces in play, before the step; the larger one of displacements and multipliers.
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
