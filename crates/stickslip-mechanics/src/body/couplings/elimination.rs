//! What the stiffness by which multipliers are eliminated is made of.

use crate::system::{ContactBlock, Links};

/// Stiffness by which multipliers are eliminated, relative to all that holds the points of a row. Every iteration leaves about its inverse
/// of what an equation is off; what rounding of displacements leaves of forces grows with it. Tuned: with 1e4 condensed bodies that an
/// equation holds stalled at 1e-4 of the forces.
pub(super) const ELIMINATION_STIFFNESS: f64 = 1e2;

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

impl Elimination {
    /// Stiffness by which the multiplier of a row is eliminated beside contact `[N/m]`; `None` where contact has not been looked at.
    pub fn of(&self, i: usize) -> Option<f64> {
        self.stiffness.get(i).copied()
    }
}

/// `Σ factor² / stiffness` over the displacements that have one.
pub(super) fn compliance(held: &[Held], stiffness: impl Fn(&Held) -> f64) -> f64 {
    let with = held.iter().map(|h| (h.squared, stiffness(h)));
    with.filter(|(_, k)| *k > 0.0).map(|(a, k)| a / k).sum()
}

/// Most passes over all contact: `ELIMINATION_STIFFNESS` leaves room for no more.
const MOST_PASSES: usize = 20;

/// Writes, by dof, the stiffness with which contact resists a displacement while the other points of each block give way as their bodies and other blocks let
/// them: that of the block in series with theirs. A tie between two soft bodies holds a point no more than the other body does, however firm it is itself; where
/// more points meet a facet than it has nodes, each of these is held by what holds the others, and none gives way.
///
/// What other blocks do to a point follows from what they do to others in turn. It is found by passes in which a block sees what all but itself have done in the one
/// before, as in the cavity method: where blocks make no loops that is exact, and where they do it is at most their own stiffness.
pub(super) fn resistance(blocks: &[ContactBlock], give: &[f64], out: &mut Vec<f64>) {
    let dofs = blocks.iter().flat_map(|block| &block.dofs);
    let most = dofs.max().map_or(0, |dof| dof + 1);
    out.clear();
    out.resize(most, 0.0);
    let mut before = out.clone();
    let mut parts = vec![0.0; blocks.iter().map(|block| 3 * block.dofs.len()).sum()];
    let mut gives = Vec::new();
    for _ in 0..MOST_PASSES {
        std::mem::swap(&mut before, out);
        out.fill(0.0);
        let mut parts = parts.as_mut_slice();
        for block in blocks {
            let n = block.dofs.len();
            for q in 0..3 {
                let (row, change) = (&block.rows[q * n..][..n], &block.change[q * n..][..n]);
                let own = |k: usize| (row[k] * change[k]).abs();
                let (mine, rest) = parts.split_at_mut(n);
                parts = rest;
                gives.clear();
                gives.extend(block.dofs.iter().zip(&*mine).map(|(&dof, mine)| {
                    let give = give.get(dof).copied().unwrap_or(0.0);
                    give / (1.0 + give * (before[dof] - mine).max(0.0))
                }));
                // For springs in series: stiffness of contact times compliance of what else there is, over all points.
                let all: f64 = (0..n).map(|k| own(k) * gives[k]).sum();
                for (k, &dof) in block.dofs.iter().enumerate() {
                    mine[k] = own(k) / (1.0 + all - own(k) * gives[k]);
                    out[dof] += mine[k];
                }
            }
        }
        if out
            .iter()
            .zip(&before)
            // No more passes are made once what they find grows by less from one to the next.
            .all(|(now, then)| *now <= 1.2 * then)
        {
            break;
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
        let blocks = [block];
        resistance(&blocks, &give, &mut out);
        assert_eq!([out[2], out[5]], [tie, tie]);
        give[5] = 1.0 / body;
        resistance(&blocks, &give, &mut out);
        let series = tie * body / (tie + body);
        assert!((out[2] - series).abs() < 1e-9 * series, "{}", out[2]);
        assert_eq!(out[5], tie);
    }

    /// Two nodes of a facet beneath a rigid face that meets it at three places: neither can give way to let the other go.
    #[test]
    fn what_other_points_hold_does_not_give_way() {
        let contact = 1e6;
        let meeting = |at: f64| {
            let row = [1.0 - at, at];
            let mut rows = vec![0.0; 6];
            rows[..2].copy_from_slice(&row);
            ContactBlock {
                dofs: vec![0, 1],
                change: rows.iter().map(|a| contact * a).collect(),
                rows,
                ..ContactBlock::default()
            }
        };
        let mut out = Vec::new();
        resistance(&[meeting(0.5)], &[1.0; 2], &mut out);
        assert!(out[0] < 1.01, "{out:?}");
        let three = [0.1, 0.5, 0.9].map(meeting);
        resistance(&three, &[1.0; 2], &mut out);
        assert!(out[0] > 0.5 * contact, "{out:?}");
    }
}
