//! What contact forces write into: a residual by dof and dense tangent blocks.

/// A dense tangent block of one contact point, with a symmetric positive semi-definite stand-in for the preconditioner.
#[derive(Debug, Clone, PartialEq)]
pub struct ContactBlock {
    /// Global dofs.
    pub dofs: Vec<usize>,
    /// Tangent, row by row, shape `(n, n)`; unsymmetric where points slip.
    pub tangent: Vec<f64>,
    /// Symmetric positive semi-definite approximation of the tangent, same shape.
    pub surrogate: Vec<f64>,
    /// Gradients of the gap and of the two components of slip, row by row, shape `(3, n)`.
    pub rows: Vec<f64>,
    /// How the force along each row changes, shape `(3, n)`: without the curvature of the gap the tangent is `rowsᵀ change`.
    pub change: Vec<f64>,
}

impl ContactBlock {
    /// Adds the tangent times `v`, both over the dofs of the block.
    pub fn apply(&self, v: &[f64], out: &mut [f64]) {
        for (row, out) in self.tangent.chunks_exact(v.len().max(1)).zip(out) {
            *out += row.iter().zip(v).map(|(k, v)| k * v).sum::<f64>();
        }
    }
}

/// The tangent of a contact point in parts, as [`Assembler`] takes them; see [`ContactBlock`].
#[derive(Debug, Clone, Copy)]
pub struct Tangent<'a> {
    /// Tangent, or `K_uu` of a point with multipliers.
    pub whole: &'a [f64],
    /// Symmetric stand-in.
    pub surrogate: &'a [f64],
    /// Gradients of gap and slip.
    pub rows: &'a [f64],
    /// Change of the forces along them, multipliers eliminated.
    pub change: &'a [f64],
}

/// The multiplier rows of a point in a perturbed Lagrangian, to be eliminated: `n` displacement dofs, `m` multipliers.
///
/// ```text
/// [ K_uu  K_ul ] [du]     [ r_u ]
/// [ K_lu  K_ll ] [dl] = - [ r_l ]
/// ```
#[derive(Debug, Clone, Copy)]
pub struct Saddle<'a> {
    /// `(n, m)`, row by row.
    pub k_ul: &'a [f64],
    /// `(m, n)`, row by row.
    pub k_lu: &'a [f64],
    /// Inverse of `K_ll`, `(m, m)`, row by row.
    pub k_ll_inverse: &'a [f64],
    /// Residual of the multiplier rows, length `m`.
    pub r_l: &'a [f64],
}

/// Collects the residual and the tangent blocks of contact forces.
#[derive(Debug, Default)]
pub struct Assembler {
    /// Residual (internal minus external), by dof. For blocks with multipliers it holds the residual of the
    /// displacement rows themselves, which is what convergence is judged by.
    pub residual: Vec<f64>,
    /// What condensing the multipliers adds to the right-hand side of the Newton system, `-K_ul K_ll⁻¹ r_l`.
    pub condensed: Vec<f64>,
    /// Largest multiplier-row residual, as a force, for the convergence test.
    pub multiplier_residual: f64,
    /// Square of the force that rounding of coordinates may leave, summed over the points.
    pub rounding: f64,
    /// Dofs of every point that may come to act, acting or not: what a symbolic factorisation should provide for.
    pub couplings: Vec<Vec<usize>>,
    /// Tangent blocks; left empty when only a residual is wanted.
    pub blocks: Vec<ContactBlock>,
    /// Whether tangents are wanted.
    pub wants_tangent: bool,
}

impl Assembler {
    /// An empty assembler for `dofs` unknowns.
    pub fn new(dofs: usize) -> Self {
        Assembler {
            residual: vec![0.0; dofs],
            condensed: vec![0.0; dofs],
            ..Default::default()
        }
    }

    /// Empties it for a new evaluation.
    pub fn reset(&mut self, wants_tangent: bool) {
        self.residual.fill(0.0);
        self.condensed.fill(0.0);
        self.multiplier_residual = 0.0;
        self.rounding = 0.0;
        self.blocks.clear();
        self.couplings.clear();
        self.wants_tangent = wants_tangent;
    }

    /// Adds the residual of one point.
    pub fn add_residual(&mut self, dofs: &[usize], residual: &[f64]) {
        for (&dof, &r) in dofs.iter().zip(residual) {
            self.residual[dof] += r;
        }
    }

    /// Adds the tangent of one point, if tangents are wanted.
    pub fn add_tangent(&mut self, dofs: &[usize], tangent: Tangent) {
        if self.wants_tangent {
            self.blocks.push(ContactBlock {
                dofs: dofs.to_vec(),
                tangent: tangent.whole.to_vec(),
                surrogate: tangent.surrogate.to_vec(),
                rows: tangent.rows.to_vec(),
                change: tangent.change.to_vec(),
            });
        }
    }

    /// Adds the condensed form of a point with multipliers: of `K_uu` in `tangent` remains the Schur complement.
    pub fn add_saddle(&mut self, dofs: &[usize], tangent: Tangent, saddle: Saddle) {
        let mut whole = tangent.whole.to_vec();
        let n = dofs.len();
        let m = saddle.r_l.len();
        // a = K_ul K_ll⁻¹
        let mut a = [0.0; 3];
        for i in 0..n {
            for (q, aq) in a.iter_mut().enumerate().take(m) {
                *aq = (0..m)
                    .map(|p| saddle.k_ul[i * m + p] * saddle.k_ll_inverse[p * m + q])
                    .sum();
            }
            for (j, t) in whole[i * n..(i + 1) * n].iter_mut().enumerate() {
                *t -= (0..m).map(|q| a[q] * saddle.k_lu[q * n + j]).sum::<f64>();
            }
            self.condensed[dofs[i]] -= (0..m).map(|q| a[q] * saddle.r_l[q]).sum::<f64>();
        }
        let whole = &whole;
        self.add_tangent(dofs, Tangent { whole, ..tangent });
    }
}
