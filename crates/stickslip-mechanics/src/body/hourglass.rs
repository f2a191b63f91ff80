//! Stiffness of quad4 and hex8 against the motions that have no mean strain.
//!
//! With the mean gradients `b_i` over the cell, the motions beside the linear ones are `h_m` (`ξη`; in space `ξη`, `ηζ`, `ζξ` and
//! `ξηζ`) at the nodes. What a displacement has of them is measured by
//!
//! ```text
//! γ_m = h_m - Σ_i (h_m · x_i) b_i,      K = κ Σ_m γ_m γ_mᵀ  in each direction,      κ = ε E V Σ_i b_i·b_i
//! ```
//!
//! `γ_m` is orthogonal to every linear field, so that constant strains are exact
//! ([`flanagan_1981`](stickslip_base::references::flanagan_1981), eq. 27-30 and 63 and following). `E` is Young's modulus. The mean gradients are integrated exactly: with the gradients at the centre hexahedra with warped faces would
//! fail the patch test.
//!
//! Around an axis a ring of one layer could also turn its section, which costs hoop strain that grows along the axis and has no
//! mean. Its first moment gets the stiffness that it has in a ring without lateral stress:
//!
//! ```text
//! K = E / I  w wᵀ  in the radial direction,      w = ∫ (N / r) (y - ȳ) dV,      I = ∫ (y - ȳ)² dV
//! ```

use std::ops::Range;

use super::Space;
use super::geometry::{Nodal, Point, Table};
use crate::material::Stiffness;
use crate::shape::ElementKind;

/// `ε`: that of C3D8R in CalculiX, found by runs of single cells. Half a percent of the stiffness in bending of a cube.
const HOURGLASS_STIFFNESS: f64 = 5e-4;

/// Most motions a cell has: hex8.
pub(super) const CELL_MODES: usize = 4;

/// The motions of a kind.
#[derive(Debug, Clone)]
pub(super) struct Hourglass<const N: usize> {
    base: [[f64; N]; CELL_MODES],
    /// How many they are.
    count: usize,
    space: Space,
}

impl<const N: usize> Hourglass<N> {
    /// For quad4 and hex8; no motions for any other kind.
    pub fn new(kind: ElementKind, space: Space) -> Self {
        let count = match kind {
            ElementKind::Quad4 => 1,
            ElementKind::Hex8 => 4,
            _ => 0,
        };
        let mut base = [[0.0; N]; CELL_MODES];
        for (a, x) in kind.reference().nodes().iter().enumerate() {
            let products = [x[0] * x[1], x[1] * x[2], x[2] * x[0], x[0] * x[1] * x[2]];
            for (row, value) in base.iter_mut().zip(products).take(count) {
                row[a] = value;
            }
        }
        Hourglass { base, count, space }
    }

    /// `h_m` at the nodes.
    pub fn base(&self) -> &[[f64; N]] {
        &self.base[..self.count]
    }

    /// `κ V / (Σ_i b_i·b_i V²)`.
    pub fn factor(&self, modulus: f64) -> f64 {
        HOURGLASS_STIFFNESS * modulus
    }

    /// What [`vectors`](Self::vectors) fills, and the directions in which each acts.
    pub fn directions(&self) -> impl Iterator<Item = Range<usize>> + use<N> {
        let turning = (self.space == Space::Axisymmetric).then_some(0..1);
        let dim = self.space.dim();
        (0..self.count).map(move |_| 0..dim).chain(turning)
    }

    /// `√κ γ_m`, and around an axis `√(E / I) w`, for the cell with nodes `x`, the points of its rule and their `mean`.
    pub fn vectors(
        &self,
        x: &Nodal<N>,
        table: &Table<N>,
        points: &[Point<N>],
        mean: &Point<N>,
        modulus: f64,
    ) -> [[f64; N]; CELL_MODES] {
        let dim = self.space.dim();
        let square: f64 = mean.d[..dim].as_flattened().iter().map(|d| d * d).sum();
        let factor = (self.factor(modulus) * mean.volume * square).sqrt();
        let mut vectors = self.base;
        for vector in vectors.iter_mut().take(self.count) {
            let h = *vector;
            for (x, d) in x.iter().zip(&mean.d).take(dim) {
                let along: f64 = h.iter().zip(x).map(|(h, x)| h * x).sum();
                for (v, d) in vector.iter_mut().zip(d) {
                    *v -= along * d;
                }
            }
            for v in vector {
                *v *= factor;
            }
        }
        if self.space == Space::Axisymmetric {
            vectors[self.count] = turning(&x[1], table, points, mean.volume, modulus);
        }
        vectors
    }
}

/// `√(E / I) w` of a cell whose nodes are at `y`.
fn turning<const N: usize>(
    y: &[f64; N],
    table: &Table<N>,
    points: &[Point<N>],
    volume: f64,
    modulus: f64,
) -> [f64; N] {
    let height = |n: &[f64; N]| n.iter().zip(y).map(|(n, y)| n * y).sum::<f64>();
    let all = || points.iter().zip(table.values.iter().map(height));
    let middle = all().map(|(p, y)| p.volume * y).sum::<f64>() / volume;
    let (mut w, mut second) = ([0.0; N], 0.0);
    for (p, y) in all() {
        second += p.volume * (y - middle).powi(2);
        for (w, d) in w.iter_mut().zip(&p.d[2]) {
            *w += p.volume * (y - middle) * d;
        }
    }
    let factor = (modulus / second).sqrt();
    w.map(|w| factor * w)
}

/// Young's modulus `[Pa]`, of a material that is not isotropic one of its size.
pub(super) fn modulus(c: &Stiffness, space: Space) -> f64 {
    if matches!(space, Space::PlaneStress { .. }) {
        return c[0][0] - c[0][1] * c[0][1] / c[1][1];
    }
    let bulk = c[..3].iter().flat_map(|row| &row[..3]).sum::<f64>() / 9.0;
    let shear = (c[3][3] + c[4][4] + c[5][5]) / 3.0;
    9.0 * bulk * shear / (3.0 * bulk + shear)
}

/// The mean gradients over a cell, with its volume.
pub(super) fn mean<const N: usize>(points: &[Point<N>]) -> Point<N> {
    let volume: f64 = points.iter().map(|p| p.volume).sum();
    let mut d = [[0.0; N]; 3];
    for p in points {
        for (row, source) in d.iter_mut().zip(&p.d) {
            for (d, s) in row.iter_mut().zip(source) {
                *d += p.volume * s / volume;
            }
        }
    }
    Point {
        d,
        volume,
        jacobian: f64::NAN,
    }
}
