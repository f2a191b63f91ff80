//! What contact forces write into: a residual by dof and dense tangent blocks.

use crate::math::Vec3;

/// The tangent of one contact point, `rowsᵀ change + hessian`, with a symmetric positive semi-definite approximation for the preconditioner.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ContactBlock {
    /// Global dofs.
    pub dofs: Vec<usize>,
    /// Gradients of the gap and of the two components of slip, row by row, shape `(3, n)`.
    pub rows: Vec<f64>,
    /// How the force along each row changes, multipliers eliminated, shape `(3, n)`.
    pub change: Vec<f64>,
    /// What the curvature of gap and slip adds to the tangent, row by row, shape `(n, n)`; empty where there is none. Symmetric but for shear that is carried
    /// along a facet.
    pub hessian: Vec<f64>,
    /// Symmetric positive semi-definite approximation of the tangent, shape `(n, n)`; empty unless it was asked for.
    pub surrogate: Vec<f64>,
}

impl ContactBlock {
    /// Adds the tangent times `v`, both over the dofs of the block.
    pub fn apply(&self, v: &[f64], out: &mut [f64]) {
        let n = self.dofs.len();
        let times = |row: &[f64]| -> f64 { row.iter().zip(v).map(|(k, v)| k * v).sum() };
        for q in 0..3 {
            let along = times(&self.change[q * n..(q + 1) * n]);
            for (row, out) in self.rows[q * n..(q + 1) * n].iter().zip(&mut *out) {
                *out += row * along;
            }
        }
        if !self.hessian.is_empty() {
            for (row, out) in self.hessian.chunks_exact(n).zip(out) {
                *out += times(row);
            }
        }
    }

    /// The tangent, row by row, shape `(n, n)`; unsymmetric where points slip.
    pub fn tangent(&self) -> Vec<f64> {
        let n = self.dofs.len();
        let mut dense = self.hessian.clone();
        dense.resize(n * n, 0.0);
        for q in 0..3 {
            let (rows, change) = (&self.rows[q * n..], &self.change[q * n..]);
            for k in 0..n {
                for l in 0..n {
                    dense[k * n + l] += rows[k] * change[l];
                }
            }
        }
        dense
    }
}

/// A point of a secondary surface that is a point of the mesh, and the facet it meets.
#[derive(Debug, Clone, Default, PartialEq, crate::keep::Keep)]
pub struct ContactPair {
    /// The point of the mesh.
    pub point: usize,
    /// Points of the facet and their weights where it is met; empty where no facet is, or where the primary has none.
    pub facet: Vec<(usize, f64)>,
    /// Unit normal there, of either side.
    pub normal: Vec3,
}

/// The tangent of a contact point in parts, as [`Assembler`] takes them; see [`ContactBlock`].
#[derive(Debug, Clone, Copy)]
pub struct Tangent<'a> {
    /// Gradients of gap and slip.
    pub rows: &'a [f64],
    /// Change of the tractions along them, multipliers eliminated.
    pub change: &'a [f64],
    /// Area that makes them forces.
    pub area: f64,
    /// Curvature; may be empty.
    pub hessian: &'a [f64],
    /// Symmetric approximation; may be empty.
    pub surrogate: &'a [f64],
}

/// Collects the residual and the tangent blocks of contact forces.
#[derive(Debug)]
pub struct Assembler {
    /// Residual (internal minus external), by dof. For points with multipliers it holds the residual of the
    /// displacement rows themselves, which is what convergence is judged by.
    pub residual: Vec<f64>,
    /// What condensing the multipliers adds to the right-hand side of the Newton system.
    pub condensed: Vec<f64>,
    /// Largest multiplier-row residual, as a force, for the convergence test.
    pub multiplier_residual: f64,
    /// Square of the force that rounding of coordinates may leave, summed over the points.
    pub rounding: f64,
    /// Dofs of every point that may come to act, acting or not: what a symbolic factorisation should provide for.
    pub couplings: Vec<Vec<usize>>,
    /// Tangent blocks; left empty when only a residual is wanted.
    pub blocks: Vec<ContactBlock>,
    /// All points that contact is checked at and that are points of the mesh, acting or not; left empty unless
    /// [`wants_pairs`](Assembler::wants_pairs).
    pub pairs: Vec<ContactPair>,
    /// Whether tangents are wanted.
    pub wants_tangent: bool,
    /// Whether a tangent is to tell of its pairs. Stays as it is from one evaluation to the next; `false` to begin with.
    pub wants_pairs: bool,
    /// Whether the blocks have to bring a symmetric approximation with them, for a preconditioner. Stays as it is from one evaluation to the
    /// next; `true` to begin with.
    pub wants_surrogate: bool,
    /// What the tangent does not know of, the turn of surfaces as a whole, is that of the last accepted state. For bodies that are followed: they roll, and
    /// Newton's method has to see all of what that does. `false` to begin with.
    pub holds_turns: bool,
    /// The state of evaluation may be given up again: forces keep what they remember of the last iterate, from which the step was taken,
    /// until they are told to [`settle`](super::Force::settle). `false` to begin with.
    pub tentative: bool,
    /// Memory of former blocks and couplings, used again.
    spare_blocks: Vec<ContactBlock>,
    spare_couplings: Vec<Vec<usize>>,
}

impl Default for Assembler {
    fn default() -> Self {
        Assembler::new(0)
    }
}

impl Assembler {
    /// An empty assembler for `dofs` unknowns.
    pub fn new(dofs: usize) -> Self {
        Assembler {
            residual: vec![0.0; dofs],
            condensed: vec![0.0; dofs],
            multiplier_residual: 0.0,
            rounding: 0.0,
            couplings: Vec::new(),
            blocks: Vec::new(),
            pairs: Vec::new(),
            wants_tangent: false,
            wants_pairs: false,
            wants_surrogate: true,
            holds_turns: false,
            tentative: false,
            spare_blocks: Vec::new(),
            spare_couplings: Vec::new(),
        }
    }

    /// Empties it for a new evaluation.
    pub fn reset(&mut self, wants_tangent: bool) {
        self.residual.fill(0.0);
        self.condensed.fill(0.0);
        self.multiplier_residual = 0.0;
        self.rounding = 0.0;
        self.spare_blocks.append(&mut self.blocks);
        self.spare_couplings.append(&mut self.couplings);
        self.pairs.clear();
        self.wants_tangent = wants_tangent;
    }

    /// Empties it for an evaluation that has as many dofs as another one and wants the same.
    pub fn begin_beside(&mut self, other: &Assembler) {
        if self.residual.len() != other.residual.len() {
            *self = Assembler::new(other.residual.len());
        }
        self.wants_surrogate = other.wants_surrogate;
        self.wants_pairs = other.wants_pairs;
        self.holds_turns = other.holds_turns;
        self.tentative = other.tentative;
        self.reset(other.wants_tangent);
    }

    /// Takes how gaps and slips curve out of the tangent, and blocks that hold nothing else.
    pub fn straighten(&mut self) {
        self.blocks.iter_mut().for_each(|b| b.hessian.clear());
        self.drop_curvature();
    }

    /// Takes away blocks that hold nothing but curvature; `false` if there are none.
    pub fn drop_curvature(&mut self) -> bool {
        let before = self.blocks.len();
        self.blocks.retain(|b| b.rows.iter().any(|r| *r != 0.0));
        self.blocks.len() < before
    }

    /// Adds the residual of one point.
    pub fn add_residual(&mut self, dofs: &[usize], residual: &[f64]) {
        for (&dof, &r) in dofs.iter().zip(residual) {
            self.residual[dof] += r;
        }
    }

    /// Notes the dofs of a point that may come to act, if tangents are wanted.
    pub fn add_coupling(&mut self, dofs: &[usize]) {
        if self.wants_tangent {
            let mut coupling = self.spare_couplings.pop().unwrap_or_default();
            coupling.clear();
            coupling.extend_from_slice(dofs);
            self.couplings.push(coupling);
        }
    }

    /// Adds the tangent of one point, if tangents are wanted.
    pub fn add_tangent(&mut self, dofs: &[usize], tangent: Tangent) {
        if !self.wants_tangent {
            return;
        }
        let mut block = self.spare_blocks.pop().unwrap_or_default();
        block.dofs.clear();
        block.dofs.extend_from_slice(dofs);
        let parts = [
            (&mut block.rows, tangent.rows),
            (&mut block.change, tangent.change),
            (&mut block.hessian, tangent.hessian),
            (&mut block.surrogate, tangent.surrogate),
        ];
        for (to, from) in parts {
            to.clear();
            to.extend_from_slice(from);
        }
        for c in &mut block.change {
            *c *= tangent.area;
        }
        self.blocks.push(block);
    }

    /// Adds what the elimination of its multipliers asks for of one point: they change by `-shift` without any displacement.
    pub fn add_condensed(&mut self, dofs: &[usize], tangent: Tangent, shift: [f64; 3]) {
        let n = dofs.len();
        for (q, shift) in shift.iter().enumerate() {
            for (row, &dof) in tangent.rows[q * n..(q + 1) * n].iter().zip(dofs) {
                self.condensed[dof] += tangent.area * shift * row;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_block_applies_its_tangent() {
        let numbers = |count: usize, seed: usize| -> Vec<f64> {
            (0..count)
                .map(|k| ((k * 7 + seed * 13) % 11) as f64 - 5.0)
                .collect()
        };
        for hessian in [Vec::new(), numbers(16, 3)] {
            let mut out = Assembler::new(8);
            // twice, as memory is used again
            for _ in 0..2 {
                out.reset(true);
                let tangent = Tangent {
                    rows: &numbers(12, 1),
                    change: &numbers(12, 2),
                    area: 0.5,
                    hessian: &hessian,
                    surrogate: &[],
                };
                out.add_tangent(&[7, 2, 4, 0], tangent);
            }
            let block = &out.blocks[0];
            let v = numbers(4, 5);
            let mut product = vec![1.0; 4];
            block.apply(&v, &mut product);
            for (row, product) in block.tangent().chunks(4).zip(product) {
                let expected: f64 = row.iter().zip(&v).map(|(k, v)| k * v).sum();
                assert!((product - 1.0 - expected).abs() < 1e-12);
            }
            assert_eq!(block.change[0], 0.5 * numbers(12, 2)[0]);
        }
    }

    #[test]
    fn a_straight_tangent_has_rows_alone() {
        let mut out = Assembler::new(8);
        out.reset(true);
        let (some, none) = ([1.0; 6], [0.0; 6]);
        for rows in [&some, &none] {
            let tangent = Tangent {
                rows,
                change: rows,
                area: 1.0,
                hessian: &[3.0; 4],
                surrogate: &[],
            };
            out.add_tangent(&[1, 6], tangent);
        }
        out.straighten();
        assert_eq!(out.blocks.len(), 1, "one held nothing but curvature");
        assert!(out.blocks[0].hessian.is_empty());
        assert_eq!(out.blocks[0].rows, some);
    }
}
