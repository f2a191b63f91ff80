//! The projection of a point on a facet. Pure geometry; tolerances are lengths.
//!
//! Newton's method asks for positions and their derivatives many times, and for shape functions nowhere: a facet is a polynomial here.

use super::facet_point::FACET_NODES;
use crate::math::{Vec3, add_scaled, cross, distance, dot, norm, scale, sub};
use crate::shape::ElementKind;
use crate::tolerance::SAME;

/// The geometry of a facet: the coefficients of `1, ξ, η, ξη, ξ², η², ξ²η, ξη²`, among which are all that lines, triangles and quadrilaterals, linear or
/// quadratic, have.
#[derive(Debug, Clone, Copy)]
pub struct Patch {
    /// Line, triangle or quadrilateral.
    pub kind: ElementKind,
    c: [Vec3; 8],
    quadratic: bool,
}

/// A place of a facet.
#[derive(Debug, Clone, Copy)]
pub struct Foot {
    /// Reference coordinates.
    pub xi: [f64; 2],
    /// Position.
    pub x: Vec3,
    /// Base vectors `∂x/∂ξ`; in 2D the second is the unit vector out of the plane.
    pub a: [Vec3; 2],
    /// Unit normal, out of the primary body.
    pub normal: Vec3,
}

/// Steps of Newton's method for a projection.
const PROJECTION_STEPS: usize = 25;

/// Reference coordinates beyond which Newton's method leads nowhere: no projection and no place in a facet is sought there.
/// A facet reaches to 1, and steps of the method are no longer than that. Between 300 and 3000 all short cases (see
/// [`tolerance`](crate::tolerance)) have the same digits.
pub(super) const FARTHEST: f64 = 1e3;

impl Patch {
    /// Of a facet with these nodes.
    pub fn new(kind: ElementKind, nodes: &[Vec3]) -> Patch {
        let reference = kind.reference();
        let count = nodes.len();
        let origin = [0.0; 3];
        let mut n = [0.0; FACET_NODES];
        let mut d = [[0.0; 3]; FACET_NODES];
        reference.values(origin, &mut n[..count]);
        reference.gradients(origin, &mut d[..count]);
        let mut c = [[0.0; 3]; 8];
        let mut add = |k: usize, x: &Vec3, w: f64| c[k] = add_scaled(c[k], w, *x);
        for ((x, n), d) in nodes.iter().zip(n).zip(d) {
            add(0, x, n);
            add(1, x, d[0]);
            add(2, x, d[1]);
        }
        // Taylor's series at the origin, which ends.
        if !matches!(kind, ElementKind::Line2 | ElementKind::Tri3) {
            reference.second_derivatives(origin, &mut d[..count]);
            for (x, [along, across, mixed]) in nodes.iter().zip(d) {
                add(3, x, mixed);
                add(4, x, 0.5 * along);
                add(5, x, 0.5 * across);
            }
        }
        if kind == ElementKind::Quad8 {
            let mut d = [[0.0; 4]; FACET_NODES];
            reference.third_derivatives(origin, &mut d[..count]);
            for (x, d) in nodes.iter().zip(d) {
                add(6, x, 0.5 * d[1]);
                add(7, x, 0.5 * d[2]);
            }
        }
        Patch {
            kind,
            c,
            quadratic: kind.order() > 1,
        }
    }

    /// Position and base vectors.
    #[inline]
    pub fn at(&self, [s, t]: [f64; 2]) -> (Vec3, [Vec3; 2]) {
        let c = &self.c;
        let mut a = [add_scaled(c[1], t, c[3]), add_scaled(c[2], s, c[3])];
        let mut x = add_scaled(add_scaled(c[0], s, c[1]), t, a[1]);
        if self.quadratic {
            let (along, across) = (add_scaled(c[4], t, c[6]), add_scaled(c[5], s, c[7]));
            x = add_scaled(add_scaled(x, s * s, along), t * t, across);
            a[0] = add_scaled(add_scaled(a[0], 2.0 * s, along), t * t, c[7]);
            a[1] = add_scaled(add_scaled(a[1], 2.0 * t, across), s * s, c[6]);
        }
        if self.kind.dim() == 1 {
            a[1] = [0.0, 0.0, 1.0];
        }
        (x, a)
    }

    /// Second derivatives of the position, `11, 22, 12`.
    #[inline]
    fn bending(&self, [s, t]: [f64; 2]) -> [Vec3; 3] {
        let c = &self.c;
        let mixed = add_scaled(add_scaled(c[3], 2.0 * s, c[6]), 2.0 * t, c[7]);
        [
            scale(2.0, add_scaled(c[4], t, c[6])),
            scale(2.0, add_scaled(c[5], s, c[7])),
            mixed,
        ]
    }

    /// A place.
    #[inline]
    pub fn foot(&self, xi: [f64; 2]) -> Foot {
        let (x, a) = self.at(xi);
        let n = cross(a[0], a[1]);
        Foot {
            xi,
            x,
            a,
            normal: scale(1.0 / norm(n), n),
        }
    }

    /// Projects `point` orthogonally on the facet extended beyond its edges. `None` if the iteration does not settle, which happens only far
    /// from a strongly curved facet.
    pub fn project(&self, point: Vec3) -> Option<Foot> {
        let [s, t, _] = self.kind.centre();
        self.project_from(point, [s, t])
    }

    /// The same from the projection of a place nearby; from the centre if that leads nowhere.
    pub fn project_near(&self, point: Vec3, xi: [f64; 2]) -> Option<Foot> {
        // Far outside the facet its extension is no guide.
        // A guess from before beyond these reference coordinates is no guide.
        let near = xi[0].abs().max(xi[1].abs()) < 1.5;
        let found = near.then(|| self.project_from(point, xi));
        found.flatten().or_else(|| self.project(point))
    }

    fn project_from(&self, point: Vec3, start: [f64; 2]) -> Option<Foot> {
        let mut xi = start;
        let linear = matches!(self.kind, ElementKind::Line2 | ElementKind::Tri3);
        for _ in 0..PROJECTION_STEPS {
            let (x, a) = self.at(xi);
            let r = sub(point, x);
            let f = [dot(r, a[0]), dot(r, a[1])];
            let metric = metric(&a);
            let mut matrix = metric;
            let mut positive = true;
            if !linear {
                let [along, across, mixed] = self.bending(xi).map(|aa| dot(r, aa));
                matrix = [
                    [metric[0][0] - along, metric[0][1] - mixed],
                    [metric[1][0] - mixed, metric[1][1] - across],
                ];
                positive =
                    matrix[0][0] > 0.0 && matrix[0][0] * matrix[1][1] > matrix[0][1] * matrix[0][1];
            }
            // Gauss-Newton far away is safer than Newton: the curvature term may make the matrix indefinite.
            let inverse = invert2(if positive { &matrix } else { &metric })?;
            let mut step = [
                inverse[0][0] * f[0] + inverse[0][1] * f[1],
                inverse[1][0] * f[0] + inverse[1][1] * f[1],
            ];
            if self.kind.dim() == 1 {
                step[1] = 0.0;
            }
            let longest = step[0].abs().max(step[1].abs());
            if !longest.is_finite() {
                return None;
            }
            // Slip is a difference of such coordinates: every digit counts.
            if !linear && longest <= f64::EPSILON {
                return Some(self.foot(xi));
            }
            let damp = if !linear && longest > 1.0 {
                1.0 / longest
            } else {
                1.0
            };
            xi = [xi[0] + damp * step[0], xi[1] + damp * step[1]];
            // After such a step Newton's method, which squares the error, has converged to rounding.
            if linear || (positive && longest < SAME) {
                return Some(self.foot(xi));
            }
            if xi[0].abs() + xi[1].abs() > FARTHEST {
                return None;
            }
        }
        let foot = self.foot(xi);
        let r = sub(point, foot.x);
        let size = match self.kind.dim() {
            1 => norm(foot.a[0]),
            _ => norm(foot.a[0]).max(norm(foot.a[1])),
        };
        let miss = dot(r, foot.a[0]).abs().max(dot(r, foot.a[1]).abs());
        // How far from a right angle a projection may be that Newton's method has not settled on.
        (miss < 1e-10 * size * size).then_some(foot)
    }
}

/// Products of base vectors.
#[inline]
fn metric(a: &[Vec3; 2]) -> [[f64; 2]; 2] {
    let mixed = dot(a[0], a[1]);
    [[dot(a[0], a[0]), mixed], [mixed, dot(a[1], a[1])]]
}

/// Inverse of a symmetric 2×2 matrix; `None` if it is singular.
pub(crate) fn invert2(m: &[[f64; 2]; 2]) -> Option<[[f64; 2]; 2]> {
    let det = m[0][0] * m[1][1] - m[0][1] * m[1][0];
    // A NaN is singular as well.
    if det.is_nan() || det.abs() <= 1e-12 * (m[0][0] * m[1][1]).abs() {
        return None;
    }
    Some([
        [m[1][1] / det, -m[0][1] / det],
        [-m[1][0] / det, m[0][0] / det],
    ])
}

/// How far a projection lies beyond the facet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Beyond {
    /// Distance from the facet within its surface `[m]`; zero inside.
    pub distance: f64,
    /// The place of the facet it is beyond; the projection itself inside.
    pub from: Vec3,
    /// The edge it lies beyond, in the order of `surface::edges`; meaningless inside.
    pub edge: usize,
}

/// The nearest place inside the reference domain, and the edge in between.
fn clamp(kind: ElementKind, xi: [f64; 2]) -> ([f64; 2], usize) {
    match kind {
        ElementKind::Line2 | ElementKind::Line3 => {
            ([xi[0].clamp(-1.0, 1.0), 0.0], usize::from(xi[0] > 0.0))
        }
        ElementKind::Tri3 | ElementKind::Tri6 => {
            let excess = [-xi[1], xi[0] + xi[1] - 1.0, -xi[0]];
            let edge = (0..3).fold(0, |b, i| if excess[i] > excess[b] { i } else { b });
            let (mut a, mut b) = (xi[0].max(0.0), xi[1].max(0.0));
            if a + b > 1.0 {
                let over = 0.5 * (a + b - 1.0);
                a -= over;
                b -= over;
                if a < 0.0 {
                    (a, b) = (0.0, 1.0);
                } else if b < 0.0 {
                    (a, b) = (1.0, 0.0);
                }
            }
            ([a, b], edge)
        }
        _ => {
            let excess = [-1.0 - xi[1], xi[0] - 1.0, xi[1] - 1.0, -1.0 - xi[0]];
            let edge = (0..4).fold(0, |b, i| if excess[i] > excess[b] { i } else { b });
            ([xi[0].clamp(-1.0, 1.0), xi[1].clamp(-1.0, 1.0)], edge)
        }
    }
}

impl Patch {
    /// How far a projection lies beyond the facet.
    pub fn beyond(&self, foot: &Foot) -> Beyond {
        let (inside, edge) = clamp(self.kind, foot.xi);
        if inside == foot.xi || (self.kind.dim() == 1 && inside[0] == foot.xi[0]) {
            return Beyond {
                distance: 0.0,
                from: foot.x,
                edge,
            };
        }
        let (x, _) = self.at(inside);
        Beyond {
            distance: distance(foot.x, x),
            from: x,
            edge,
        }
    }
}

/// Distance from `point` to the facet itself (not its extension), given its projection. The extension of a curved facet may come near to
/// any place, and its height there says nothing about how far the facet is.
pub fn facet_distance(point: Vec3, foot: &Foot, beyond: Beyond) -> f64 {
    if beyond.distance == 0.0 {
        return dot(sub(point, foot.x), foot.normal).abs();
    }
    distance(point, beyond.from)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::facet_point::evaluate;

    /// The polynomial is the facet: positions, base vectors and second derivatives are those of the shape functions.
    #[test]
    fn a_patch_is_the_facet_of_its_shape_functions() {
        for kind in [
            ElementKind::Line2,
            ElementKind::Line3,
            ElementKind::Tri3,
            ElementKind::Tri6,
            ElementKind::Quad4,
            ElementKind::Quad8,
        ] {
            let bent = |(k, xi): (usize, &[f64; 3])| {
                let wave = |c: usize| 0.3 * (1.7 * (k + 11 * c) as f64).sin();
                [3.0 + xi[0] + wave(0), xi[1] + wave(1), wave(2)]
            };
            let nodes: Vec<Vec3> =
                (kind.reference().nodes().iter().enumerate().map(bent)).collect();
            let patch = Patch::new(kind, &nodes);
            for xi in [
                [0.0, 0.0],
                [0.3, -0.7],
                [-0.9, 0.2],
                [1.2, 0.6],
                [-1.5, -1.1],
            ] {
                let p = evaluate(kind, &nodes, xi);
                let foot = patch.foot(xi);
                let pairs = [(foot.x, p.x), (foot.a[0], p.a[0]), (foot.a[1], p.a[1])];
                let normal = [(foot.normal, p.normal)];
                let bending = patch.bending(xi).into_iter().zip(p.aa);
                let dims = if kind.dim() == 1 { 1 } else { 3 };
                let all = pairs.into_iter().chain(normal).chain(bending.take(dims));
                for (mine, theirs) in all {
                    assert!(distance(mine, theirs) < 1e-14 * 20.0, "{kind} at {xi:?}");
                }
            }
        }
    }
}
