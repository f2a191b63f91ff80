//! quad4 in the plane and hex8 with the mean strain of the cell, and stiffness against hourglassing.
//!
//! With `B_a = ∫ ∇N_a`, `h_m` and `κ` of `hourglass.rs`, and `α_m = γ_m · u = h_m · u - Σ_j (h_m · x_j) (B_j · u) / V`,
//!
//! ```text
//! f_a = σ B_a + κ Σ_m (h_ma - Σ_j (h_m · x_j) B_aj / V) α_m
//! ```

use pulp::Simd;

use super::super::Space;
use super::super::medium::Medium;
use super::lane::{Lane, Nodes};
use super::law::Law;
use super::sweep::CellForce;
use super::tensor::{Vector, cofactors, traction};
use crate::material::VOIGT;

/// Cells of `N` nodes in `D` dimensions, with `V = 2 D` components of stress.
pub struct Uniform<L, const N: usize, const D: usize, const V: usize> {
    medium: Medium<N>,
    law: L,
    thickness: f64,
}

impl<L: Law, const N: usize, const D: usize, const V: usize> Uniform<L, N, D, V> {
    /// With the law as it acts. Not around an axis.
    pub fn new(medium: Medium<N>, law: L) -> Self {
        let thickness = match medium.space {
            Space::PlaneStrain { thickness } | Space::PlaneStress { thickness } => thickness,
            Space::Solid | Space::Axisymmetric => 1.0,
        };
        Uniform {
            medium,
            law,
            thickness,
        }
    }

    /// The integrals of the gradients, and the volume.
    #[inline(always)]
    fn gradients<S: Simd>(
        &self,
        simd: S,
        part: usize,
        x: &Nodes<N, D>,
    ) -> ([Vector<S, D>; N], Lane<S>) {
        let zero = Lane::splat(simd, 0.0);
        let mut b = [[zero; D]; N];
        let mut volume = zero;
        let table = &self.medium.table;
        for (gradients, weight) in table.gradients.iter().zip(&table.weights) {
            let mut j = [[zero; D]; D];
            for (a, node) in x.iter().enumerate() {
                for k in 0..D {
                    let derivative = Lane::splat(simd, gradients[k][a]);
                    for i in 0..D {
                        j[k][i] = derivative.times_plus(Lane::load(simd, &node[i], part), j[k][i]);
                    }
                }
            }
            let (mut c, determinant) = cofactors(simd, &j);
            let factor = Lane::splat(simd, weight * self.thickness);
            volume = determinant.times_plus(factor, volume);
            for row in &mut c {
                for entry in row {
                    *entry = *entry * factor;
                }
            }
            for (a, b) in b.iter_mut().enumerate() {
                for k in 0..D {
                    let derivative = Lane::splat(simd, gradients[k][a]);
                    for i in 0..D {
                        b[i] = derivative.times_plus(c[k][i], b[i]);
                    }
                }
            }
        }
        (b, volume)
    }
}

impl<L: Law, const N: usize, const D: usize, const V: usize> CellForce<N, D>
    for Uniform<L, N, D, V>
{
    #[inline(always)]
    fn force<S: Simd>(
        &self,
        simd: S,
        part: usize,
        x: &Nodes<N, D>,
        u: &Nodes<N, D>,
        f: &mut Nodes<N, D>,
    ) {
        let zero = Lane::splat(simd, 0.0);
        let (b, volume) = self.gradients(simd, part, x);
        let inverse = volume.inverse();

        // `g[j][i] = B_j · u_i`, and the square of `B`.
        let mut g = [[zero; D]; D];
        let mut square = zero;
        for (b, node) in b.iter().zip(u) {
            for j in 0..D {
                square = b[j].times_plus(b[j], square);
                for i in 0..D {
                    g[j][i] = b[j].times_plus(Lane::load(simd, &node[i], part), g[j][i]);
                }
            }
        }
        let mut strain = [zero; V];
        for i in 0..D {
            strain[i] = g[i][i];
            for j in i + 1..D {
                strain[VOIGT[i][j]] = g[i][j] + g[j][i];
            }
        }
        let stress = self.law.stress(simd, &strain, inverse);
        let mut force = [[zero; D]; N];
        for (force, b) in force.iter_mut().zip(&b) {
            *force = traction(&stress, b, force);
        }

        let stiffness = self.medium.hourglass.factor(self.medium.modulus);
        let kappa = Lane::splat(simd, stiffness) * square * inverse;
        // What the forces have of `B` over the volume, by direction of `B` and of the force.
        let mut along = [[zero; D]; D];
        for h in self.medium.hourglass.base() {
            let (mut of_x, mut of_u) = ([zero; D], [zero; D]);
            for ((h, x), u) in h.iter().zip(x).zip(u) {
                let h = Lane::splat(simd, *h);
                for i in 0..D {
                    of_x[i] = h.times_plus(Lane::load(simd, &x[i], part), of_x[i]);
                    of_u[i] = h.times_plus(Lane::load(simd, &u[i], part), of_u[i]);
                }
            }
            for i in 0..D {
                let mut linear = zero;
                for j in 0..D {
                    linear = of_x[j].times_plus(g[j][i], linear);
                }
                let amount = kappa * linear.times_from(inverse, of_u[i]);
                for (h, force) in h.iter().zip(&mut force) {
                    force[i] = Lane::splat(simd, *h).times_plus(amount, force[i]);
                }
                for j in 0..D {
                    along[j][i] = of_x[j].times_plus(amount, along[j][i]);
                }
            }
        }
        for ((force, b), f) in force.iter().zip(&b).zip(f) {
            for i in 0..D {
                let mut linear = zero;
                for j in 0..D {
                    linear = b[j].times_plus(along[j][i], linear);
                }
                linear.times_from(inverse, force[i]).store(&mut f[i], part);
            }
        }
    }
}
