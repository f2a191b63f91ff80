//! What the stiffness by which multipliers are eliminated is made of.

use crate::system::{ContactBlock, Links};

/// Stiffness by which multipliers are eliminated, relative to all that holds the points of a row. Every iteration leaves about its inverse of
/// what an equation is off; what rounding of displacements leaves of forces grows with it.
pub(super) const FIRM: f64 = 1e2;

/// One displacement of a row: what it is multiplied by, squared, and the stiffness of the bulk there.
#[derive(Debug, Clone, Copy)]
pub(super) struct Held {
    pub dof: usize,
    pub squared: f64,
    pub bulk: f64,
}

/// What multipliers are eliminated by at the iterate at hand.
#[derive(Debug, Clone, Default)]
pub(super) struct Elimination {
    /// Stiffness by row `[N/m]`.
    pub stiffness: Vec<f64>,
    /// Free displacements by row.
    pub held: Vec<Vec<Held>>,
    /// What moves points of rigid bodies.
    pub links: Option<Links>,
    /// What contact adds, by dof `[N/m]`.
    pub contact: Vec<f64>,
}

/// `Σ factor² / stiffness` over the displacements that have one.
pub(super) fn compliance(held: &[Held], stiffness: impl Fn(&Held) -> f64) -> f64 {
    let with = held.iter().map(|h| (h.squared, stiffness(h)));
    with.filter(|(_, k)| *k > 0.0).map(|(a, k)| a / k).sum()
}

/// Adds the diagonal of a tangent, parts of either sign alike, by dof.
pub(super) fn add_diagonal(block: &ContactBlock, out: &mut Vec<f64>) {
    let n = block.dofs.len();
    for (k, &dof) in block.dofs.iter().enumerate() {
        if out.len() <= dof {
            out.resize(dof + 1, 0.0);
        }
        out[dof] += (0..3)
            .map(|q| (block.rows[q * n + k] * block.change[q * n + k]).abs())
            .sum::<f64>();
    }
}
