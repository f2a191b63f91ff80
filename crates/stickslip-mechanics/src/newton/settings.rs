/// Dimensionless settings of the iteration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Largest out-of-balance force relative to the scale of forces.
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
