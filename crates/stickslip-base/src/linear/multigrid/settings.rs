/// What [`Multigrid`](super::Multigrid) needs to know of the mesh behind a matrix.
#[derive(Debug, Clone, Copy)]
pub struct MeshHints<'a> {
    /// Coordinates `(n, 3)` \[m\], `z = 0` in 2D.
    pub coordinates: &'a [[f64; 3]],
    /// The body of each point; no coarse unknown is shared by two of them.
    pub bodies: &'a [u32],
    /// Points with gap variables, and unit normals of the facets they meet.
    pub gaps: &'a [(usize, [f64; 3])],
}

/// How a [`Multigrid`](super::Multigrid) is made and smooths.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MultigridSettings {
    /// Points coupled less than this, relative to their diagonals, are not put together \[1\].
    pub strength: f64,
    /// Damping of the step that smooths the prolongation, relative to the spectral radius \[1\].
    pub prolongation_damping: f64,
    /// Terms of the Chebyshev polynomial, before and after the coarse correction.
    pub smoother_steps: usize,
    /// Upper over lower end of the part of the spectrum that the smoother damps \[1\].
    pub smoother_ratio: f64,
    /// Dofs below which a level is solved directly.
    pub coarsest_dofs: usize,
}

impl Default for MultigridSettings {
    fn default() -> Self {
        MultigridSettings {
            strength: 0.0,
            prolongation_damping: 1.5,
            smoother_steps: 2,
            smoother_ratio: 8.0,
            coarsest_dofs: 600,
        }
    }
}
