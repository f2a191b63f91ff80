//! How far a body has turned, from its displacements alone.

use rayon::prelude::*;

use super::cell_frame::CellFrame;
use super::geometry::{Nodal, Point, Table, by_nodes, coordinates, gather, point};
use super::scheme::stiffness_rule;
use super::{At, Elastic, Formulation, Part};
use crate::body::recover;
use crate::math::{Mat3, Vec3, identity, norm, polar_rotation};
use crate::mesh::CellRef;
use crate::shape::QuadraturePoint;

/// How far a body has turned.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Turning {
    /// As a whole, by the mean of its displacement gradient `[rad]`.
    pub mean: f64,
    /// The same as the rotation vector of the linear theory `[rad]`.
    pub vector: Vec3,
    /// The cell that has turned most, by its gradient at the centre `[rad]`.
    pub largest: f64,
    /// That cell.
    pub cell: Option<CellRef>,
}

/// Cells that one thread looks at together. Fixed, so that sums do not depend on the number of threads.
const TURNED_PER_TASK: usize = 512;

/// What some cells have in common: the integral of the displacement gradient, their volume, and the one that has turned most.
struct Sum {
    gradient: Mat3,
    volume: f64,
    largest: (f64, usize),
}

impl Sum {
    /// Adds a point of a cell with these displacements of its nodes.
    fn add<const N: usize>(&mut self, at: &Point<N>, u: &Nodal<N>, dim: usize, cell: usize) {
        let mut gradient = [[0.0; 3]; 3];
        for (row, u) in gradient.iter_mut().zip(u).take(dim) {
            for (g, d) in row.iter_mut().zip(&at.d).take(dim) {
                *g = u.iter().zip(d).map(|(u, d)| u * d).sum();
            }
        }
        self.volume += at.volume;
        let both = self.gradient.iter_mut().flatten();
        for (s, g) in both.zip(gradient.as_flattened()) {
            *s += at.volume * g;
        }
        if may_turn_more(&gradient, self.largest.0) {
            let turned = rotation_of(&gradient);
            if turned > self.largest.0 {
                self.largest = (turned, cell);
            }
        }
    }
}

/// How far the body has turned at the displacements `u` `[m]` (by dof of the whole mesh): where cells have frames of their own, in these, and `largest` is the
/// angle by which a part of a cell has.
pub fn turning(body: &Elastic, u: &[f64]) -> Turning {
    let mut turning = Turning::default();
    let (mut mean, mut volume) = ([[0.0; 3]; 3], 0.0);
    for part in &body.parts {
        let kind = body.mesh.blocks[part.block].kind;
        for sum in by_nodes!(kind, turning_of(body, part, u)) {
            for (m, g) in mean.iter_mut().flatten().zip(sum.gradient.as_flattened()) {
                *m += g;
            }
            volume += sum.volume;
            let (largest, cell) = sum.largest;
            if largest > turning.largest {
                turning.largest = largest;
                turning.cell = Some(CellRef {
                    block: part.block,
                    cell,
                });
            }
        }
    }
    let volume = volume.max(f64::MIN_POSITIVE);
    let mean = mean.map(|row| row.map(|g| g / volume));
    turning.mean = rotation_of(&mean);
    turning.vector = axial(&mean);
    turning
}

/// How much the body is strained, thermal strains apart, where its energy is: the root of the mean square of the strain, `√(ε:ε)`, weighted with the energy of the
/// cells. Cells at corners where a strain has no limit count for no more than they store.
pub fn strain_level<'a>(body: &Elastic, at: impl Into<At<'a>>) -> f64 {
    let (at, mut sums) = (at.into(), [0.0; 2]);
    for (part, p) in body.parts.iter().enumerate() {
        let kind = body.mesh.blocks[p.block].kind;
        by_nodes!(kind, strain_of(body, part, at, &mut sums));
    }
    (sums[1] / sums[0].max(f64::MIN_POSITIVE)).sqrt()
}

fn strain_of<const N: usize>(body: &Elastic, part: usize, at: At, sums: &mut [f64; 2]) {
    recover::each_cell::<N>(
        body,
        part,
        at,
        2,
        |_, _, recovered, values| {
            let mut squares = [0.0; 2];
            for (q, p) in recovered.points.iter().enumerate() {
                let [xx, yy, zz, xy, yz, xz] = recovered.elastic(q);
                let shear = 0.5 * (xy * xy + yz * yz + xz * xz);
                squares[0] += p.volume;
                squares[1] += p.volume * (xx * xx + yy * yy + zz * zz + shear);
            }
            values[0] = recovered.energy();
            values[1] = values[0] * squares[1] / squares[0];
        },
        |_, values| {
            sums[0] += values[0];
            sums[1] += values[1];
        },
    );
}

fn turning_of<const N: usize>(body: &Elastic, part: &Part, u: &[f64]) -> Vec<Sum> {
    let block = &body.mesh.blocks[part.block];
    // One point for a cell: its gradient is exact for every linear displacement. Where cells have frames of their own they are bent in these.
    let centre = [QuadraturePoint {
        xi: block.kind.centre(),
        weight: 1.0,
    }];
    let rule = match body.corotational {
        true => stiffness_rule(block.kind, body.space, Formulation::Standard),
        false => &centre,
    };
    let table = Table::<N>::with_rule(block.kind, rule);
    let dim = body.space.dim();
    let count = block.connectivity.len() / N;
    let chunks = (0..count.div_ceil(TURNED_PER_TASK)).into_par_iter();
    let of_chunk = |chunk: usize| {
        let mut sum = Sum {
            gradient: [[0.0; 3]; 3],
            volume: 0.0,
            largest: (0.0, 0),
        };
        for cell in chunk * TURNED_PER_TASK..((chunk + 1) * TURNED_PER_TASK).min(count) {
            let x = coordinates::<N>(&body.mesh.points, block, cell);
            let mut u = gather(u, body.dofs(), block, cell);
            if body.corotational {
                u = CellFrame::new(dim, &x, &u).local();
            }
            for q in 0..table.len() {
                sum.add(&point(&table, q, &x, body.space), &u, dim, cell);
            }
        }
        sum
    };
    chunks.map(of_chunk).collect()
}

/// The rotation in a displacement gradient `[rad]`: that of the linear theory, the length of the axial vector of its antisymmetric part, or that of
/// the polar decomposition of `1 + H`, whichever is larger. They differ by a part of the third order; but only the first grows without
/// bound with an unconstrained motion, and only the second sees half a turn that is prescribed.
fn rotation_of(h: &Mat3) -> f64 {
    let linear = norm(axial(h));
    // Far below any limit the difference is in digits that do not matter.
    if linear < 1e-4 && h.as_flattened().iter().all(|h| h.abs() < 0.1) {
        return linear;
    }
    linear.max(polar(h).unwrap_or(0.0))
}

/// Whether a gradient may turn by more than `angle`: of one with entries below a tenth the two rotations of [`rotation_of`] differ by less than half of one.
fn may_turn_more(h: &Mat3, angle: f64) -> bool {
    2.0 * norm(axial(h)) > angle
        || h.as_flattened()
            .iter()
            .any(|h| h.is_nan() || h.abs() >= 0.1)
}

fn axial(m: &Mat3) -> Vec3 {
    [
        0.5 * (m[2][1] - m[1][2]),
        0.5 * (m[0][2] - m[2][0]),
        0.5 * (m[1][0] - m[0][1]),
    ]
}

/// The angle of the orthogonal factor of `1 + H`; `None` where that turns cells inside out.
fn polar(h: &Mat3) -> Option<f64> {
    let unit = identity();
    let f: Mat3 = std::array::from_fn(|i| std::array::from_fn(|j| unit[i][j] + h[i][j]));
    let r = polar_rotation(&f)?;
    let cosine = 0.5 * (r[0][0] + r[1][1] + r[2][2] - 1.0);
    Some(norm(axial(&r)).atan2(cosine))
}

#[cfg(test)]
mod tests {
    use super::super::testing;
    use super::*;
    use crate::math::{add, cross, mat_vec, rotation, sub};

    /// Displacements of all points by a function of their place.
    fn displaced(body: &Elastic, at: &dyn Fn(Vec3) -> Vec3) -> Vec<f64> {
        let dim = body.space().dim();
        let points = body.mesh().points.iter();
        points.flat_map(|&x| at(x).into_iter().take(dim)).collect()
    }

    #[test]
    fn a_turn_is_found_whatever_the_cells_and_whatever_else_they_do() {
        for (kind, space, formulation) in testing::combinations() {
            let body = testing::patch(kind, space, formulation);
            for angle in [0.03, 2.0] {
                let turn = rotation([0.0, 0.0, 1.0], angle);
                let u = displaced(&body, &|x| add(sub(mat_vec(&turn, x), x), [3e3, -2e3, 0.0]));
                let found = turning(&body, &u);
                assert!((found.mean - angle).abs() < 1e-9, "{kind}: {found:?}");
                assert!((found.largest - angle).abs() < 1e-9, "{kind}: {found:?}");
            }
            // Stretched by a third along x and pressed by a fifth along y.
            let u = displaced(&body, &|x| [x[0] / 3.0, -x[1] / 5.0, 0.0]);
            assert!(turning(&body, &u).largest < 1e-12, "{kind}");
            // As the linear theory turns, without bound.
            let u = displaced(&body, &|x| cross([0.0, 0.0, 1e7], x));
            assert!((turning(&body, &u).mean / 1e7 - 1.0).abs() < 1e-9, "{kind}");
        }
    }

    #[test]
    fn a_turn_about_any_axis_has_its_angle() {
        let axis = [1.0 / 3.0, -2.0 / 3.0, 2.0 / 3.0];
        for angle in [1e-3, 0.05, 1.0, 3.0] {
            let r = rotation(axis, angle);
            let unit = identity();
            let h = std::array::from_fn(|i| std::array::from_fn(|j| r[i][j] - unit[i][j]));
            assert!(
                (rotation_of(&h) - angle).abs() < 1e-9 * angle.max(1.0),
                "{angle}"
            );
        }
    }

    #[test]
    fn what_is_passed_over_has_not_turned_more() {
        // The worst of many gradients that are just small enough.
        let mut state = 1_u64;
        let mut next = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        };
        for _ in 0..20_000 {
            let h: Mat3 = std::array::from_fn(|_| std::array::from_fn(|_| 0.0999 * next()));
            assert!(!may_turn_more(&h, 2.0 * norm(axial(&h))));
            assert!(rotation_of(&h) < 1.5 * norm(axial(&h)), "{h:?}");
        }
        assert!(may_turn_more(&[[f64::NAN; 3]; 3], 1.0));
    }

    #[test]
    fn two_halves_that_turn_against_each_other_are_seen_in_their_cells() {
        let (kind, space, formulation) = testing::combinations()
            .into_iter()
            .find(|c| c.1.dim() == 2)
            .expect("a plane one");
        let body = testing::patch(kind, space, formulation);
        let x = body.mesh().points.iter().map(|x| x[0]);
        let middle = 0.5 * x.fold(0.0_f64, f64::max);
        let u = displaced(&body, &|x| [0.0, 0.3 * (x[0] - middle).abs(), 0.0]);
        let found = turning(&body, &u);
        assert!(
            found.largest > 0.1 && found.mean < found.largest,
            "{found:?}"
        );
        assert!(found.cell.is_some());
    }
}
