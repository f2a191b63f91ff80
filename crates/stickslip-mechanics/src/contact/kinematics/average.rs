//! The gap of a contact point that is a weighted mean over nodes, above an obstacle.
//!
//! A point of a quadratic face stands for `x = Σ wᵢ xᵢ`. Where obstacle or face are curved the gap at that place is not the mean of the gaps: what lies
//! on the obstacle with all of its nodes would have a gap of the square of the face times the curvature. The mean `Σ wᵢ g(xᵢ)` has none.

use super::stencil::Stencil;
use crate::contact::obstacle::{Foot, Pose, Shape};
use crate::contact::surface::ContactPoint;
use crate::math::Vec3;

fn foot(shape: &dyn Shape, pose: &Pose, x: Vec3) -> Option<Foot> {
    shape.foot(pose.inward(x))
}

/// The mean gap of a point over its nodes, which are at `x` by number; `None` at a centre.
pub fn mean_gap(shape: &dyn Shape, pose: &Pose, point: &ContactPoint, x: &[Vec3]) -> Option<f64> {
    let mut gap = 0.0;
    for (&node, w) in point.nodes.iter().zip(&point.weights) {
        gap += w * foot(shape, pose, x[node])?.gap;
    }
    Some(gap)
}

/// Replaces gap and gradient of a stencil by the means over the nodes of its point; `None` at a centre.
pub fn average(
    shape: &dyn Shape,
    pose: &Pose,
    point: &ContactPoint,
    x: &[Vec3],
    dim: usize,
    out: &mut Stencil,
) -> Option<()> {
    out.gap = 0.0;
    for (k, (&node, w)) in point.nodes.iter().zip(&point.weights).enumerate() {
        let foot = foot(shape, pose, x[node])?;
        let normal = pose.turn(foot.normal);
        out.gap += w * foot.gap;
        for (c, n) in normal.iter().enumerate().take(dim) {
            out.rows[0][k * dim + c] = w * n;
        }
    }
    Some(())
}

/// Adds `weight` times the second derivatives of that gap, shape `(n, n)`; `false` if there are none.
pub fn add_average_hessian(
    shape: &dyn Shape,
    pose: &Pose,
    point: &ContactPoint,
    x: &[Vec3],
    dim: usize,
    weight: f64,
    out: &mut [f64],
) -> bool {
    let n = point.nodes.len() * dim;
    let mut any = false;
    for (k, (&node, w)) in point.nodes.iter().zip(&point.weights).enumerate() {
        let Some(foot) = foot(shape, pose, x[node]) else {
            continue;
        };
        if foot.curvature == [[0.0; 3]; 3] {
            continue;
        }
        any = true;
        for j in 0..dim {
            let mut e = [0.0; 3];
            e[j] = 1.0;
            let local = crate::math::mat_vec(&foot.curvature, pose.turn_back(e));
            let column = pose.turn(local);
            for i in 0..dim {
                out[(k * dim + i) * n + k * dim + j] += weight * w * column[i];
            }
        }
    }
    any
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::mortar::mean_weights;
    use crate::contact::obstacle::{Motion, ObstacleShape};
    use crate::registry::Family;
    use crate::shape::ElementKind;

    fn point() -> ContactPoint {
        let (_, weights) = mean_weights(ElementKind::Tri6, 4);
        ContactPoint {
            nodes: vec![0, 1, 2],
            weights,
            area: 1.0,
            stiffness: 1.0,
            normal: [0.0, 0.0, -1.0],
            size: 1.0,
            across: Default::default(),
        }
    }

    const PLACES: [Vec3; 3] = [[0.31, -0.22, 0.17], [0.4, -0.1, 0.2], [0.2, -0.3, 0.19]];

    fn gap(shape: &dyn Shape, x: &[Vec3]) -> (f64, Vec<f64>) {
        let pose = Motion::default().pose(0.0);
        let mut stencil = Stencil::default();
        stencil.reset(9);
        average(shape, &pose, &point(), x, 3, &mut stencil).expect("not at a centre");
        assert_eq!(mean_gap(shape, &pose, &point(), x), Some(stencil.gap));
        (stencil.gap, stencil.rows[0].clone())
    }

    #[test]
    fn derivatives_agree_with_differences() {
        for shape in ObstacleShape::samples() {
            let shape = shape.as_dyn();
            let pose = Motion::default().pose(0.0);
            let (_, row) = gap(shape, &PLACES);
            let mut hessian = vec![0.0; 81];
            add_average_hessian(shape, &pose, &point(), &PLACES, 3, 1.0, &mut hessian);
            let h = 1e-6;
            for (k, d) in row.iter().enumerate() {
                let at = |step: f64| {
                    let mut x = PLACES;
                    x[k / 3][k % 3] += step;
                    gap(shape, &x)
                };
                let (a, b) = (at(-h), at(h));
                assert!(((b.0 - a.0) / (2.0 * h) - d).abs() < 1e-8);
                for l in 0..9 {
                    let found = (b.1[l] - a.1[l]) / (2.0 * h);
                    assert!((found - hessian[9 * k + l]).abs() < 1e-7, "{k} {l}");
                }
            }
        }
    }

    #[test]
    fn what_lies_on_the_obstacle_with_all_nodes_has_no_gap() {
        for shape in ObstacleShape::samples() {
            let shape = shape.as_dyn();
            let on = PLACES.map(|x| shape.foot(x).expect("not at a centre").point);
            assert!(gap(shape, &on).0.abs() < 1e-14);
        }
    }
}
