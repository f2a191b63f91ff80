//! Taking the mass away from points in contact and giving it to the cells around them.
//!
//! A point with mass that meets a rigid surface has to stop at once: whatever the time step, its momentum turns into an oscillation of
//! the contact force, and Newmark's method can gain energy by it. Without mass the point just follows
//! ([`khenous_2008`](stickslip_base::references::khenous_2008)).
//!
//! What is left of the mass of a cell without its points in contact is multiplied by a factor near those points, so that total mass and
//! centre of mass of the body stay as they were; its moments of inertia change by the square of the cell size. Factors are positive, so
//! the mass matrix stays positive definite on all other points. They fall off slowly: a strong and local change, which the exact moments
//! of inertia would need, rings (on the bar of `examples/impact-bar` ten times as much).

use crate::math::{Vec3, symmetric_eigen};

/// Layers of cells that take mass.
const MASS_LAYERS: usize = 8;

/// Mass matrices of the cells of a body, one direction, and their points.
pub(super) struct Cell {
    pub points: Vec<usize>,
    /// Shape `(n, n)`, row by row.
    pub mass: Vec<f64>,
}

/// The factor of every cell, after the mass of the points `light` is gone; `None` if no other point could take it. `x` are the coordinates
/// of all points of the mesh.
pub(super) fn factors(cells: &[Cell], x: &[Vec3], light: &[bool], dim: usize) -> Option<Vec<f64>> {
    let frame = Frame::about(cells, x, light, dim)?;
    let none = vec![false; light.len()];
    let mut missing = vec![0.0; frame.count()];
    let mut left: Vec<Vec<f64>> = Vec::with_capacity(cells.len());
    for cell in cells {
        let whole = frame.moments(cell, x, &none);
        let rest = frame.moments(cell, x, light);
        for ((m, a), b) in missing.iter_mut().zip(&whole).zip(&rest) {
            *m += a - b;
        }
        left.push(rest);
    }
    let weights = weights(cells, light);
    // Mass and centre; the mass alone.
    [1 + dim, 1]
        .into_iter()
        .find_map(|kept| solve(&left, &weights, &missing[..kept]))
}

/// How much of the mass a cell is to take, by how far it is from the light points.
fn weights(cells: &[Cell], light: &[bool]) -> Vec<f64> {
    let mut reached = light.to_vec();
    let mut weights = vec![0.0; cells.len()];
    for layer in 0..MASS_LAYERS {
        let mut next = reached.clone();
        for (cell, weight) in cells.iter().zip(&mut weights) {
            if *weight == 0.0 && cell.points.iter().any(|&p| reached[p]) {
                // A layer has half of the weight of the one before.
                *weight = 0.5_f64.powi(layer as i32);
                cell.points.iter().for_each(|&p| next[p] = true);
            }
        }
        reached = next;
    }
    weights
}

/// Factors `1 + w m·c` with which the moments are what they were, smallest in the weighted mean.
fn solve(left: &[Vec<f64>], weights: &[f64], missing: &[f64]) -> Option<Vec<f64>> {
    let kept = missing.len();
    let takers: Vec<usize> = (0..left.len())
        .filter(|&i| weights[i] > 0.0 && left[i][0] > 0.0)
        .collect();
    // With moments per mass as shape the system is symmetric.
    let gram: Vec<Vec<f64>> = (0..kept)
        .map(|k| {
            (0..kept)
                .map(|l| {
                    let terms = takers.iter();
                    terms
                        .map(|&i| weights[i] * left[i][k] * left[i][l] / left[i][0])
                        .sum()
                })
                .collect()
        })
        .collect();
    let (values, vectors) = symmetric_eigen(&gram);
    let largest = values.last().copied().unwrap_or(0.0);
    let mut c = vec![0.0; kept];
    for (e, value) in values.iter().enumerate() {
        if *value > 1e-10 * largest {
            let along: f64 = (0..kept).map(|k| vectors[k][e] * missing[k]).sum();
            for (k, c) in c.iter_mut().enumerate() {
                *c += vectors[k][e] * along / value;
            }
        }
    }
    let mut factors = vec![1.0; left.len()];
    for &i in &takers {
        let shape: f64 = (0..kept).map(|k| left[i][k] * c[k]).sum();
        factors[i] += weights[i] * shape / left[i][0];
    }
    // Where the takers lie in a plane not all moments can be had.
    let reached = (0..kept).all(|k| {
        let sum: f64 = takers
            .iter()
            .map(|&i| (factors[i] - 1.0) * left[i][k])
            .sum();
        (sum - missing[k]).abs() <= 1e-9 * missing[0].abs()
    });
    // The least factor of a cell.
    (reached && factors.iter().all(|&f| f >= 0.2)).then_some(factors)
}

/// Coordinates about the middle of the light points, in units of the cells that lose mass, so that the small system is well scaled.
struct Frame {
    centre: Vec3,
    size: f64,
    dim: usize,
}

impl Frame {
    fn about(cells: &[Cell], x: &[Vec3], light: &[bool], dim: usize) -> Option<Self> {
        let near: Vec<usize> = cells
            .iter()
            .filter(|c| c.points.iter().any(|&p| light[p]))
            .flat_map(|c| c.points.iter().copied())
            .collect();
        let n = near.len() as f64;
        let mut centre = [0.0; 3];
        for &p in &near {
            for i in 0..dim {
                centre[i] += x[p][i] / n;
            }
        }
        let away = near.iter().flat_map(|&p| (0..dim).map(move |i| (p, i)));
        let size = away.fold(0.0_f64, |m, (p, i)| m.max((x[p][i] - centre[i]).abs()));
        (size > 0.0).then_some(Frame { centre, size, dim })
    }

    /// Number of moments to the first degree.
    fn count(&self) -> usize {
        1 + self.dim
    }

    /// Mass and first moments of a cell without the mass of some points.
    fn moments(&self, cell: &Cell, x: &[Vec3], without: &[bool]) -> Vec<f64> {
        let n = cell.points.len();
        let place = |p: usize, i: usize| (x[p][i] - self.centre[i]) / self.size;
        let mut sums = vec![0.0; self.count()];
        let kept = |p: usize| !without[cell.points[p]];
        for (k, m) in cell.mass.iter().enumerate() {
            let (a, b) = (k / n, k % n);
            if kept(a) && kept(b) {
                sums[0] += m;
                for i in 0..self.dim {
                    sums[1 + i] += m * place(cell.points[a], i);
                }
            }
        }
        sums
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::mass;
    use crate::body::{MassKind, testing};
    use crate::linear::BlockCsr;
    use crate::math::{norm, sub};

    /// Mass, centre of mass and the smallest diagonal entry of the points that are not light.
    fn summary(matrix: &BlockCsr, x: &[Vec3], light: &[bool]) -> (f64, Vec3, f64) {
        let (dim, mut mass, mut first) = (matrix.block_size(), 0.0, [0.0; 3]);
        let mut least = f64::INFINITY;
        for p in 0..x.len() {
            for &q in matrix.neighbours(p) {
                let m = matrix.entry(p * dim, q as usize * dim);
                mass += m;
                for (f, c) in first.iter_mut().zip(x[p]) {
                    *f += m * c;
                }
            }
            if !light[p] {
                least = least.min(matrix.entry(p * dim, p * dim));
            }
        }
        (mass, first.map(|f| f / mass), least)
    }

    #[test]
    fn mass_and_centre_stay_for_every_kind_of_cell() {
        for (kind, space, formulation) in testing::combinations() {
            let mesh = testing::grid(kind, [5, 4, 3], &|x| x);
            let body = testing::body(
                mesh.clone(),
                space,
                formulation,
                testing::isotropic(1.0, 0.3),
            );
            let light: Vec<bool> = mesh.points.iter().map(|x| x[1] < 1e-9).collect();
            let none = vec![false; light.len()];
            for mass in [MassKind::Consistent, MassKind::Lumped] {
                let assemble = |light: &[bool]| {
                    let mut m = BlockCsr::from_couplings(light.len(), space.dim(), &mut |v| {
                        body.couplings(v)
                    });
                    assert!(mass::add_mass(&body, mass, light, &mut m));
                    m
                };
                let (m0, c0, _) = summary(&assemble(&none), &mesh.points, &none);
                let (m1, c1, least) = summary(&assemble(&light), &mesh.points, &light);
                assert!((m1 / m0 - 1.0).abs() < 1e-12, "{kind:?} {space:?} {mass:?}");
                assert!((mass::total_mass(&body) / m0 - 1.0).abs() < 1e-12);
                assert!(norm(sub(c0, c1)) < 1e-9, "{kind:?} {space:?} {mass:?}");
                assert!(least > 0.0);
                let first = light.iter().position(|l| *l).expect("a light point") * space.dim();
                assert_eq!(assemble(&light).entry(first, first), 0.0);
            }
        }
    }

    #[test]
    fn a_body_of_light_points_keeps_its_mass() {
        let (kind, space, formulation) = testing::combinations()[0];
        let mesh = testing::grid(kind, [1, 1, 1], &|x| x);
        let body = testing::body(
            mesh.clone(),
            space,
            formulation,
            testing::isotropic(1.0, 0.3),
        );
        let mut m = BlockCsr::from_couplings(mesh.points.len(), 2, &mut |v| body.couplings(v));
        let all = vec![true; mesh.points.len()];
        assert!(!mass::add_mass(&body, MassKind::Consistent, &all, &mut m));
        let (mass, ..) = summary(&m, &mesh.points, &vec![false; all.len()]);
        assert!((mass / mass::total_mass(&body) - 1.0).abs() < 1e-12);
    }
}
