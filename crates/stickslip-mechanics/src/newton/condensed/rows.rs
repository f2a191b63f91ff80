use super::active::{NONE, Placed};
use crate::linear::Digest;
use crate::math::vector::dot;
use crate::math::{identity, inverse, transpose_vec};

/// The rows of one contact point: gradients of its gap and slips over the active dofs, and how the forces along them change.
#[derive(Debug, Clone, crate::keep::Keep)]
pub(super) struct Rows {
    /// Positions in the active list.
    pub at: Vec<u32>,
    /// First of its gap rows.
    first: usize,
    /// Gradients `B`, row by row.
    gradients: Vec<f64>,
    /// Changes `C`, row by row.
    changes: Vec<f64>,
}

/// Gaps and slips of contact points, row by row.
#[derive(Debug, Clone, Copy)]
pub(super) struct GapRows<'a> {
    /// By point.
    pub rows: &'a [Rows],
    /// Of all points.
    pub count: usize,
}

/// `S` of a point, row by row: `C = S B`.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Tied {
    pub count: usize,
    pub values: [[f64; 3]; 3],
}

impl Tied {
    /// `S u`.
    pub fn times(&self, u: &[f64], out: &mut [f64]) {
        for (out, row) in out.iter_mut().zip(&self.values) {
            *out = row.iter().zip(u).map(|(s, u)| s * u).sum();
        }
    }
}

impl Rows {
    /// The rows of all points that have any, and how many there are.
    pub fn of(blocks: &[Placed]) -> (Vec<Rows>, usize) {
        let mut all = Vec::with_capacity(blocks.len());
        let mut count = 0;
        for Placed { at, block } in blocks {
            let n = at.len();
            let mut point = Rows {
                at: at.clone(),
                first: count,
                gradients: Vec::new(),
                changes: Vec::new(),
            };
            for (row, change) in block.rows.chunks(n).zip(block.change.chunks(n)) {
                // In the plane there is one direction of slip.
                if change.iter().any(|c| *c != 0.0) && row.iter().any(|r| *r != 0.0) {
                    point.gradients.extend_from_slice(row);
                    point.changes.extend_from_slice(change);
                    count += 1;
                }
            }
            if count > point.first {
                all.push(point);
            }
        }
        (all, count)
    }

    /// Whether they are of the same point: they start with the same dof and are as many.
    pub fn is_of(&self, other: &Rows) -> bool {
        self.at.first() == other.at.first()
            && (self.first, self.count()) == (other.first, other.count())
    }

    /// Number of rows.
    pub fn count(&self) -> usize {
        self.gradients.len() / self.at.len()
    }

    /// The rows of `C`.
    pub fn changes(&self) -> impl Iterator<Item = &[f64]> {
        self.changes.chunks(self.at.len())
    }

    /// The entries of row `q` of `B` at active dofs, with their positions.
    pub fn gradient(&self, q: usize) -> impl Iterator<Item = (usize, f64)> {
        let width = self.at.len();
        let row = &self.gradients[q * width..(q + 1) * width];
        at_active(&self.at, row)
    }

    /// What tells its gradients from those of other points, and from its own when it has moved on.
    pub fn key(&self) -> [u64; 2] {
        let mut digest = Digest::default();
        digest.indices(&self.at);
        digest.floats(&self.gradients);
        digest.finish()
    }

    /// `S` with `C = S B`; `None` where forces follow from more than gaps and slips, or where these are not independent.
    pub fn tied(&self) -> Option<Tied> {
        let (count, width) = (self.count(), self.at.len());
        let line = |of: &[f64], k: usize| -> Vec<f64> {
            at_active(&self.at, &of[k * width..(k + 1) * width])
                .map(|(_, value)| value)
                .collect()
        };
        let b: Vec<Vec<f64>> = (0..count).map(|k| line(&self.gradients, k)).collect();
        // C = S B, so that C Bᵀ = S (B Bᵀ)
        let mut gram = identity();
        for (row, b_i) in gram.iter_mut().zip(&b) {
            for (entry, b_j) in row.iter_mut().zip(&b) {
                *entry = dot(b_i, b_j);
            }
        }
        let (inverse, _) = inverse(&gram)?;
        let mut values = [[0.0; 3]; 3];
        for (k, s) in values.iter_mut().enumerate().take(count) {
            let c = line(&self.changes, k);
            let mut along = [0.0; 3];
            along.iter_mut().zip(&b).for_each(|(a, b)| *a = dot(&c, b));
            *s = transpose_vec(&inverse, along);
            let size = c.iter().fold(0.0_f64, |m, c| m.max(c.abs()));
            let left = c.iter().enumerate().map(|(i, c)| {
                let made: f64 = s.iter().zip(&b).map(|(s, b)| s * b[i]).sum();
                (c - made).abs()
            });
            // A smaller part of a change of forces that is left over is rounding.
            if left.fold(0.0, f64::max) > 1e-10 * size {
                return None;
            }
        }
        Some(Tied { count, values })
    }

    /// `out = B u`.
    pub fn apply_gradients(&self, u: &[f64], out: &mut [f64]) {
        for (q, out) in out.iter_mut().enumerate() {
            *out = self.gradient(q).map(|(at, b)| b * u[at]).sum();
        }
    }

    /// `q = C u`.
    pub fn apply_changes(&self, u: &[f64], q: &mut [f64]) {
        for (q, c) in q[self.first..].iter_mut().zip(self.changes()) {
            *q = 0.0;
            for (at, c) in at_active(&self.at, c) {
                *q += c * u[at];
            }
        }
    }

    /// `y -= Bᵀ q`.
    pub fn subtract_forces(&self, q: &[f64], y: &mut [f64]) {
        for (k, q) in q[self.first..].iter().take(self.count()).enumerate() {
            for (at, b) in self.gradient(k) {
                y[at] -= b * q;
            }
        }
    }
}

/// Entries of a row at active dofs, with their positions.
pub(super) fn at_active<'a>(
    at: &'a [u32],
    row: &'a [f64],
) -> impl Iterator<Item = (usize, f64)> + 'a {
    let entries = at.iter().zip(row);
    entries
        .filter(|(at, _)| **at != NONE)
        .map(|(&at, &value)| (at as usize, value))
}
