//! Cells one by one, as the recovery of stresses computes them: for schemes that have no kernel of their own.

use pulp::Simd;

use super::super::medium::Medium;
use super::super::recover::Recovered;
use super::lane::Nodes;
use super::sweep::CellForce;

/// Cells of `N` nodes in `D` dimensions.
pub struct Cellwise<const N: usize, const D: usize>(pub Medium<N>);

impl<const N: usize, const D: usize> CellForce<N, D> for Cellwise<N, D> {
    fn force<S: Simd>(
        &self,
        _simd: S,
        part: usize,
        x: &Nodes<N, D>,
        u: &Nodes<N, D>,
        f: &mut Nodes<N, D>,
    ) {
        let mut recovered = Recovered::new();
        let mut force = [[0.0; D]; N];
        for lane in part * S::F64_LANES..(part + 1) * S::F64_LANES {
            let take = |from: &Nodes<N, D>| {
                let mut to = [[0.0; N]; 3];
                for (a, node) in from.iter().enumerate() {
                    for (row, component) in to.iter_mut().zip(node) {
                        row[a] = component.0[lane];
                    }
                }
                to
            };
            recovered.compute(&self.0, &take(x), &take(u), None);
            recovered.force(&self.0, force.as_flattened_mut());
            for (node, force) in f.iter_mut().zip(&force) {
                for (row, value) in node.iter_mut().zip(force) {
                    row.0[lane] = *value;
                }
            }
        }
    }
}
