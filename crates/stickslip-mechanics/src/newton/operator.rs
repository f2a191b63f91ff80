use crate::linear::BlockCsr;
use crate::system::{ContactBlock, ContactPair};

/// The matrix of one Newton iteration: the bulk on the free dofs plus the blocks of the interfaces.
#[derive(Debug, Clone, Copy)]
pub struct Operator<'a> {
    /// The bulk, over all dofs.
    pub matrix: &'a BlockCsr,
    /// What factors are made of in its place: positive definite on the free dofs, of the same pattern.
    pub stand_in: &'a BlockCsr,
    /// Prescribed dofs, whose rows and columns are left out.
    pub fixed: &'a [bool],
    /// Contact points.
    pub blocks: &'a [ContactBlock],
    /// Dofs that may come to be coupled by contact, for the symbolic factorisation.
    pub couplings: &'a [Vec<usize>],
    /// Which points meet which facets, for multigrid.
    pub pairs: &'a [ContactPair],
}

impl Operator<'_> {
    /// `out = (bulk + blocks) v` on the free dofs.
    pub(super) fn apply(&self, v: &[f64], out: &mut [f64]) {
        self.matrix.mul(v, out);
        let (mut moved, mut force) = (Vec::new(), Vec::new());
        for block in self.blocks {
            moved.clear();
            moved.extend(block.dofs.iter().map(|&dof| v[dof]));
            force.clear();
            force.resize(moved.len(), 0.0);
            block.apply(&moved, &mut force);
            for (&dof, f) in block.dofs.iter().zip(&force) {
                out[dof] += f;
            }
        }
        for (o, &fixed) in out.iter_mut().zip(self.fixed) {
            if fixed {
                *o = 0.0;
            }
        }
    }
}
