//! Tetrahedra of four nodes.

use pulp::Simd;

use super::lane::{Lane, Nodes};
use super::law::Law;
use super::sweep::CellForce;
use super::tensor::{cofactors, strain, traction};

/// Constant strain: one point. Mean dilatation changes nothing.
pub struct Tet4<L>(L);

impl<L: Law> Tet4<L> {
    /// With the law as it acts.
    pub fn new(law: L) -> Self {
        Tet4(law.scaled(1.0 / 6.0))
    }
}

impl<L: Law> CellForce<4, 3> for Tet4<L> {
    #[inline(always)]
    fn force<S: Simd>(
        &self,
        simd: S,
        part: usize,
        x: &Nodes<4, 3>,
        u: &Nodes<4, 3>,
        f: &mut Nodes<4, 3>,
    ) {
        let zero = Lane::splat(simd, 0.0);
        let mut edges = [[zero; 3]; 3];
        let mut stretches = edges;
        for i in 0..3 {
            let (origin, base) = (
                Lane::load(simd, &x[0][i], part),
                Lane::load(simd, &u[0][i], part),
            );
            for k in 0..3 {
                edges[k][i] = Lane::load(simd, &x[k + 1][i], part) - origin;
                stretches[k][i] = Lane::load(simd, &u[k + 1][i], part) - base;
            }
        }
        let (c, determinant) = cofactors(simd, &edges);
        let e = strain::<S, 3, 6, 3>(simd, &stretches, &c);
        let stress = self.0.stress(simd, &e, determinant.inverse());
        let mut sum = [zero; 3];
        for k in 0..3 {
            let t = traction(&stress, &c[k], &[zero; 3]);
            for i in 0..3 {
                t[i].store(&mut f[k + 1][i], part);
                sum[i] = sum[i] - t[i];
            }
        }
        for i in 0..3 {
            sum[i].store(&mut f[0][i], part);
        }
    }
}
