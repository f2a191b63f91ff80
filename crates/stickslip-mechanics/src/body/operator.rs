//! The stiffness of a cell as a sum over products of derivatives.
//!
//! With a constant tensor `C` in the cell, the block of nodes `a` and `b` is
//!
//! ```text
//! K_ab[i][j] = Σ_kl C[v(i,k)][v(j,l)] G_ab[k][l],      G_ab[k][l] = ∫ ∂_k N_a ∂_l N_b dV
//! ```
//!
//! where `v(i,k)` is the strain component that `∂_k u_i` contributes to (with axial symmetry `∂_2` stands for `1/r`).
//! So the quadrature loop is over `G` only, and the material comes in once a cell.
//!
//! Mean dilatation ([`hughes_1980`](stickslip_base::references::hughes_1980)) fits the same form. Writing `m` for the unit
//! tensor as a 6-vector, `P[i][k] = m[v(i,k)]`, `s = C m`, `S[i][k] = s[v(i,k)]` and `Ḡ_ab = V d̄_a d̄_bᵀ` with the
//! means `d̄` of the derivatives over the cell, expanding `B̄ᵀ C B̄` with `B̄ = B + m (b̄ - b)ᵀ / 3` gives
//!
//! ```text
//! K_ab = C : G_ab + D : (Ḡ_ab - G_ab),   D[ik][jl] = (S_ik P_jl + P_ik S_jl) / 3 - (m·s / 9) P_ik P_jl
//! ```
//!
//! With the mean of all strains it is `C : Ḡ_ab`.

use super::Space;
use super::scheme::Scheme;
use crate::material::Stiffness;

/// One term `value · G[k][l]` of the block entry `(i, j)`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Term {
    /// Displacement component of the row.
    pub i: usize,
    /// Displacement component of the column; `j >= i`, the rest follows from symmetry.
    pub j: usize,
    /// Index `3 k + l` of the product of derivatives.
    pub kl: usize,
    /// Factor `[Pa]`.
    pub value: f64,
}

/// The nonzero terms of a material in a space.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Operator {
    /// Factors of `G`.
    pub local: Vec<Term>,
    /// Factors of `Ḡ`; empty if no means are taken.
    pub mean: Vec<Term>,
}

impl Operator {
    /// For the stiffness `c` as it acts in `space`.
    pub fn new(c: &Stiffness, space: Space, scheme: Scheme) -> Self {
        let s: [f64; 6] = std::array::from_fn(|v| c[v][0] + c[v][1] + c[v][2]);
        let ms = s[0] + s[1] + s[2];
        let one = |v: usize| if v < 3 { 1.0 } else { 0.0 };
        let scale = c.iter().flatten().fold(0.0_f64, |m, x| m.max(x.abs()));
        let mut operator = Operator {
            local: Vec::new(),
            mean: Vec::new(),
        };
        let dim = space.dim();
        for i in 0..dim {
            for j in i..dim {
                for kl in 0..9 {
                    let (k, l) = (kl / 3, kl % 3);
                    let (Some(p), Some(q)) = (space.component(i, k), space.component(j, l)) else {
                        continue;
                    };
                    let mut local = c[p][q];
                    if scheme == Scheme::Uniform {
                        push(&mut operator.mean, i, j, kl, local, scale);
                        continue;
                    }
                    if scheme == Scheme::MeanDilatation {
                        let mean =
                            (s[p] * one(q) + one(p) * s[q]) / 3.0 - ms / 9.0 * one(p) * one(q);
                        local -= mean;
                        push(&mut operator.mean, i, j, kl, mean, scale);
                    }
                    push(&mut operator.local, i, j, kl, local, scale);
                }
            }
        }
        operator
    }
}

/// Leaves out what is zero but for rounding: an isotropic material has 15 terms, not 54.
fn push(terms: &mut Vec<Term>, i: usize, j: usize, kl: usize, value: f64, scale: f64) {
    if value.abs() > 1e-16 * scale {
        terms.push(Term { i, j, kl, value });
    }
}
