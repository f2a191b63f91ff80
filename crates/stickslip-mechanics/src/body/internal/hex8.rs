//! Hexahedra of eight nodes with the 2×2×2 rule.

use pulp::Simd;

use super::lane::{Lane, Nodes};
use super::law::Law;
use super::sweep::CellForce;
use super::tensor::{Vector, cofactors, shift, strain, take_mean, trace, traction};
use super::trilinear::{Derivatives, at, derivatives, gather_modes, modes, place, store_nodes};

/// Any hexahedron. `MEAN`: with mean dilatation.
pub struct Hex8<L, const MEAN: bool>(L);

/// The fields of some cells.
struct Fields<S: Simd> {
    /// Derivatives of place, by component.
    dx: [Derivatives<S>; 3],
    /// Derivatives of displacement.
    du: [Derivatives<S>; 3],
    /// With mean dilatation: the mean.
    dilatation: Lane<S>,
}

/// What is summed up over the points of the rule.
struct Sums<S: Simd> {
    /// Forces that belong to the derivatives of displacement.
    forces: [Derivatives<S>; 3],
    /// With mean dilatation: the integral of the mean stress.
    pressure: Lane<S>,
}

/// Cofactors and determinants at the points of the rule.
type Geometry<S> = [([Vector<S, 3>; 3], Lane<S>); 8];

impl<L: Law, const MEAN: bool> Hex8<L, MEAN> {
    /// With the law as it acts.
    pub fn new(law: L) -> Self {
        // Derivatives are 8 times too large, so forces are 8³ times: twice from the cofactors, once from the nodes.
        Hex8(law.scaled(1.0 / 512.0))
    }

    /// Adds the forces of point `q`; `geometry` is of use with mean dilatation only, which has made it before.
    #[inline(always)]
    fn point<S: Simd>(
        &self,
        simd: S,
        q: usize,
        fields: &Fields<S>,
        geometry: &Geometry<S>,
        sums: &mut Sums<S>,
    ) {
        let place = place(q);
        let (c, determinant) = if MEAN {
            geometry[q]
        } else {
            cofactors(simd, &at(&fields.dx, place))
        };
        let mut e = strain::<S, 3, 6, 3>(simd, &at(&fields.du, place), &c);
        if MEAN {
            // In units of the strain times the determinant, as `e` is.
            let third = Lane::splat(simd, 1.0 / 3.0);
            let by = (fields.dilatation * determinant - trace(&e)) * third;
            shift(&mut e, by);
        }
        let mut stress = self.0.stress(simd, &e, determinant.inverse());
        if MEAN {
            let mean = take_mean(simd, &mut stress);
            sums.pressure = mean.times_plus(determinant, sums.pressure);
        }
        for k in 0..3 {
            let mut sum = c[k];
            for i in 0..3 {
                sum[i] = sums.forces[i][k][place[k]];
            }
            let sum = traction(&stress, &c[k], &sum);
            for i in 0..3 {
                sums.forces[i][k][place[k]] = sum[i];
            }
        }
    }

    /// Fills in geometry and mean dilatation, and returns `∫ div` of every component and mode, over the volume.
    #[inline(always)]
    fn means<S: Simd>(
        simd: S,
        geometry: &mut Geometry<S>,
        fields: &mut Fields<S>,
    ) -> [[Lane<S>; 8]; 3] {
        let zero = Lane::splat(simd, 0.0);
        let mut sums = [[[zero; 4]; 3]; 3];
        let mut volume = zero;
        for q in 0..8 {
            let place = place(q);
            let (c, determinant) = cofactors(simd, &at(&fields.dx, place));
            geometry[q] = (c, determinant);
            volume += determinant;
            for i in 0..3 {
                for k in 0..3 {
                    sums[i][k][place[k]] += c[k][i];
                }
            }
        }
        let inverse = volume.inverse();
        let mut divergence = [[zero; 8]; 3];
        for i in 0..3 {
            for k in 0..3 {
                for m in 0..4 {
                    fields.dilatation =
                        sums[i][k][m].times_plus(fields.du[i][k][m], fields.dilatation);
                }
            }
            divergence[i] = gather_modes(zero, &sums[i]);
            for m in 1..8 {
                divergence[i][m] = divergence[i][m] * inverse;
            }
        }
        fields.dilatation = fields.dilatation * inverse;
        divergence
    }
}

impl<L: Law, const MEAN: bool> CellForce<8, 3> for Hex8<L, MEAN> {
    #[inline(always)]
    fn force<S: Simd>(
        &self,
        simd: S,
        part: usize,
        x: &Nodes<8, 3>,
        u: &Nodes<8, 3>,
        f: &mut Nodes<8, 3>,
    ) {
        let zero = Lane::splat(simd, 0.0);
        let empty = [[[zero; 4]; 3]; 3];
        let mut fields = Fields {
            dx: empty,
            du: empty,
            dilatation: zero,
        };
        let mut geometry = [([[zero; 3]; 3], zero); 8];
        for i in 0..3 {
            fields.dx[i] = derivatives(&modes(simd, part, x, i));
            fields.du[i] = derivatives(&modes(simd, part, u, i));
        }
        let divergence = if MEAN {
            Self::means(simd, &mut geometry, &mut fields)
        } else {
            [[zero; 8]; 3]
        };
        // Apart from the fields, so that the compiler can split it up into registers.
        let mut sums = Sums {
            forces: empty,
            pressure: zero,
        };
        // Not a loop: with the numbers known, more stays in registers (a tenth of the time).
        self.point(simd, 0, &fields, &geometry, &mut sums);
        self.point(simd, 1, &fields, &geometry, &mut sums);
        self.point(simd, 2, &fields, &geometry, &mut sums);
        self.point(simd, 3, &fields, &geometry, &mut sums);
        self.point(simd, 4, &fields, &geometry, &mut sums);
        self.point(simd, 5, &fields, &geometry, &mut sums);
        self.point(simd, 6, &fields, &geometry, &mut sums);
        self.point(simd, 7, &fields, &geometry, &mut sums);
        for i in 0..3 {
            let mut m = gather_modes(zero, &sums.forces[i]);
            if MEAN {
                for k in 1..8 {
                    m[k] = divergence[i][k].times_plus(sums.pressure, m[k]);
                }
            }
            store_nodes(simd, part, &m, f, i);
        }
    }
}

/// Hexahedra with parallel faces: the Jacobian is constant.
///
/// The derivative of the displacement by the reference coordinates is a sum of the seven products 1, ξ, η, ζ, ξη, ηζ,
/// ζξ, over which the rule is exact and which are orthogonal to each other. So strain and stress are needed once for
/// each product, and most of its columns are empty.
pub struct Parallelepiped<L, const MEAN: bool>(L);

impl<L: Law, const MEAN: bool> Parallelepiped<L, MEAN> {
    /// With the law as it acts.
    pub fn new(law: L) -> Self {
        // Edges are twice the derivatives of place, modes 8 times those of the displacement; the rule has 8 points.
        Parallelepiped(law.scaled(1.0 / 16.0))
    }

    /// The stress of a product other than 1. It has no mean: with mean dilatation it changes no volume and carries no
    /// pressure.
    #[inline(always)]
    fn deviator<S: Simd>(&self, simd: S, e: [Lane<S>; 6], factor: Lane<S>) -> [Lane<S>; 6] {
        let mut e = e;
        if MEAN {
            take_mean(simd, &mut e);
        }
        let mut s = self.0.stress(simd, &e, factor);
        if MEAN {
            take_mean(simd, &mut s);
        }
        s
    }
}

impl<L: Law, const MEAN: bool> CellForce<8, 3> for Parallelepiped<L, MEAN> {
    #[inline(always)]
    fn force<S: Simd>(
        &self,
        simd: S,
        part: usize,
        x: &Nodes<8, 3>,
        u: &Nodes<8, 3>,
        f: &mut Nodes<8, 3>,
    ) {
        let zero = Lane::splat(simd, 0.0);
        let mut edges = [[zero; 3]; 3];
        let mut m = [[zero; 3]; 8];
        for i in 0..3 {
            let origin = Lane::load(simd, &x[0][i], part);
            for (k, a) in [1, 3, 4].into_iter().enumerate() {
                edges[k][i] = Lane::load(simd, &x[a][i], part) - origin;
            }
            let all = modes(simd, part, u, i);
            for k in 1..8 {
                m[k][i] = all[k];
            }
        }
        let (c, determinant) = cofactors(simd, &edges);
        let inverse = determinant.inverse();

        let mut forces = [[zero; 3]; 8];
        let e = strain::<S, 3, 6, 3>(simd, &[m[1], m[2], m[3]], &c);
        let constant = self.0.stress(simd, &e, inverse);
        for k in 0..3 {
            forces[1 + k] = traction(&constant, &c[k], &forces[1 + k]);
        }
        // The products ξ, η, ζ: two columns and the modes they come from.
        for ((j, p), (k, q)) in [((1, 4), (2, 6)), ((0, 4), (2, 5)), ((0, 6), (1, 5))] {
            let e = strain::<S, 3, 6, 2>(simd, &[m[p], m[q]], &[c[j], c[k]]);
            let s = self.deviator(simd, e, inverse);
            forces[p] = traction(&s, &c[j], &forces[p]);
            forces[q] = traction(&s, &c[k], &forces[q]);
        }
        // The products ηζ, ζξ, ξη: one column, from the last mode.
        for k in 0..3 {
            let e = strain::<S, 3, 6, 1>(simd, &[m[7]], &[c[k]]);
            let s = self.deviator(simd, e, inverse);
            forces[7] = traction(&s, &c[k], &forces[7]);
        }
        for i in 0..3 {
            let mut component = [zero; 8];
            for k in 1..8 {
                component[k] = forces[k][i];
            }
            store_nodes(simd, part, &component, f, i);
        }
    }
}
