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
    /// How far points give way under a force, by dof `[m/N]`; nothing of those that are prescribed and of what has no stiffness.
    pub give: Vec<f64>,
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

/// Adds, by dof, the stiffness with which contact resists a displacement while the other points of the block give way as their bodies let them: that of contact
/// in series with theirs. A tie between two soft bodies holds a point no more than the other body does, however firm it is itself.
pub(super) fn add_stiffness(block: &ContactBlock, give: &[f64], out: &mut Vec<f64>) {
    let n = block.dofs.len();
    let most = block.dofs.iter().max().map_or(0, |dof| dof + 1);
    if out.len() < most {
        out.resize(most, 0.0);
    }
    let give = |k: usize| give.get(block.dofs[k]).copied().unwrap_or(0.0);
    for q in 0..3 {
        let (row, change) = (&block.rows[q * n..][..n], &block.change[q * n..][..n]);
        let own = |k: usize| (row[k] * change[k]).abs();
        // For springs in series: stiffness of contact times compliance of the bodies, over all points.
        let all: f64 = (0..n).map(|k| own(k) * give(k)).sum();
        for (k, &dof) in block.dofs.iter().enumerate() {
            out[dof] += own(k) / (1.0 + all - own(k) * give(k));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_firm_tie_holds_a_point_no_more_than_the_other_body() {
        let (tie, body) = (1e9, 4.0);
        let block = ContactBlock {
            dofs: vec![2, 5],
            rows: vec![1.0, -1.0, 0.0, 0.0, 0.0, 0.0],
            change: vec![tie, -tie, 0.0, 0.0, 0.0, 0.0],
            hessian: Vec::new(),
            surrogate: Vec::new(),
        };
        let mut give = vec![0.0; 6];
        let mut out = Vec::new();
        add_stiffness(&block, &give, &mut out);
        assert_eq!([out[2], out[5]], [tie, tie]);
        give[5] = 1.0 / body;
        out.clear();
        add_stiffness(&block, &give, &mut out);
        let series = tie * body / (tie + body);
        assert!((out[2] - series).abs() < 1e-9 * series, "{}", out[2]);
        assert_eq!(out[5], tie);
    }
}
