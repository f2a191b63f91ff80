//! The projection of a point on a facet. Pure geometry; tolerances are lengths.

use crate::math::{Vec3, add_scaled, cross, distance, dot, norm, scale, sub};
use crate::shape::ElementKind;

/// Most nodes of a facet.
pub const FACET_NODES: usize = 8;

/// A facet's shape functions and its geometry at one place.
#[derive(Debug, Clone, Copy)]
pub struct FacetPoint {
    /// Reference coordinates.
    pub xi: [f64; 2],
    /// Shape functions.
    pub n: [f64; FACET_NODES],
    /// Their first derivatives, `[direction][node]`.
    pub dn: [[f64; FACET_NODES]; 2],
    /// Their second derivatives `[11, 22, 12][node]`.
    pub ddn: [[f64; FACET_NODES]; 3],
    /// Position.
    pub x: Vec3,
    /// Base vectors `∂x/∂ξ`; in 2D the second is the unit vector out of the plane.
    pub a: [Vec3; 2],
    /// Second derivatives of the position, `11, 22, 12`.
    pub aa: [Vec3; 3],
    /// Unit normal, out of the primary body.
    pub normal: Vec3,
}

/// Evaluates a facet at `xi`.
pub fn evaluate(kind: ElementKind, coordinates: &[Vec3], xi: [f64; 2]) -> FacetPoint {
    let reference = kind.reference();
    let count = coordinates.len();
    let at = [xi[0], xi[1], 0.0];
    let mut p = FacetPoint {
        xi,
        n: [0.0; FACET_NODES],
        dn: [[0.0; FACET_NODES]; 2],
        ddn: [[0.0; FACET_NODES]; 3],
        x: [0.0; 3],
        a: [[0.0; 3]; 2],
        aa: [[0.0; 3]; 3],
        normal: [0.0; 3],
    };
    let mut d = [[0.0; 3]; FACET_NODES];
    reference.values(at, &mut p.n[..count]);
    reference.gradients(at, &mut d[..count]);
    for (k, dk) in d[..count].iter().enumerate() {
        p.dn[0][k] = dk[0];
        p.dn[1][k] = dk[1];
    }
    let straight = matches!(kind, ElementKind::Line2 | ElementKind::Tri3);
    if !straight {
        reference.second_derivatives(at, &mut d[..count]);
        for (k, dk) in d[..count].iter().enumerate() {
            for (q, &value) in dk.iter().enumerate() {
                p.ddn[q][k] = value;
            }
        }
    }
    for (k, &c) in coordinates.iter().enumerate() {
        p.x = add_scaled(p.x, p.n[k], c);
        p.a[0] = add_scaled(p.a[0], p.dn[0][k], c);
        p.a[1] = add_scaled(p.a[1], p.dn[1][k], c);
        if !straight {
            for q in 0..3 {
                p.aa[q] = add_scaled(p.aa[q], p.ddn[q][k], c);
            }
        }
    }
    if kind.dim() == 1 {
        p.a[1] = [0.0, 0.0, 1.0];
    }
    let n = cross(p.a[0], p.a[1]);
    p.normal = scale(1.0 / norm(n), n);
    p
}

/// Index of a pair of directions in `11, 22, 12`.
#[inline]
pub(crate) fn pair_index(a: usize, b: usize) -> usize {
    if a == b { a } else { 2 }
}

/// The metric of the projection's iteration, `a_α·a_β - r·a_αβ` with `r` from the facet to the point.
pub(crate) fn projection_matrix(p: &FacetPoint, r: Vec3) -> [[f64; 2]; 2] {
    std::array::from_fn(|i| {
        std::array::from_fn(|j| dot(p.a[i], p.a[j]) - dot(r, p.aa[pair_index(i, j)]))
    })
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

/// Step in reference coordinates after which Newton's method, which squares the error, has converged to rounding.
const LAST_STEP: f64 = 1e-9;

/// Projects `point` orthogonally on a facet extended beyond its edges. `None` if the iteration does not settle, which
/// happens only far from a strongly curved facet.
pub fn project(kind: ElementKind, coordinates: &[Vec3], point: Vec3) -> Option<FacetPoint> {
    let centre = match kind {
        ElementKind::Tri3 | ElementKind::Tri6 => [1.0 / 3.0; 2],
        _ => [0.0; 2],
    };
    project_from(kind, coordinates, point, centre)
}

/// The same from the projection of a place nearby; from the centre if that leads nowhere.
pub fn project_near(
    kind: ElementKind,
    coordinates: &[Vec3],
    point: Vec3,
    xi: [f64; 2],
) -> Option<FacetPoint> {
    // Far outside the facet its extension is no guide.
    let near = xi[0].abs().max(xi[1].abs()) < 1.5;
    let found = near.then(|| project_from(kind, coordinates, point, xi));
    found
        .flatten()
        .or_else(|| project(kind, coordinates, point))
}

fn project_from(
    kind: ElementKind,
    coordinates: &[Vec3],
    point: Vec3,
    start: [f64; 2],
) -> Option<FacetPoint> {
    let mut xi = start;
    let linear = matches!(kind, ElementKind::Line2 | ElementKind::Tri3);
    for _ in 0..25 {
        let p = evaluate(kind, coordinates, xi);
        let r = sub(point, p.x);
        let f = [dot(r, p.a[0]), dot(r, p.a[1])];
        // Gauss-Newton far away is safer than Newton: the curvature term may make the matrix indefinite.
        let full = projection_matrix(&p, r);
        let positive = full[0][0] > 0.0 && full[0][0] * full[1][1] > full[0][1] * full[0][1];
        let matrix = if positive {
            full
        } else {
            projection_matrix(&p, [0.0; 3])
        };
        let inverse = invert2(&matrix)?;
        let mut step = [
            inverse[0][0] * f[0] + inverse[0][1] * f[1],
            inverse[1][0] * f[0] + inverse[1][1] * f[1],
        ];
        if kind.dim() == 1 {
            step[1] = 0.0;
        }
        let longest = step[0].abs().max(step[1].abs());
        if !longest.is_finite() {
            return None;
        }
        // Slip is a difference of such coordinates: every digit counts.
        if !linear && longest <= f64::EPSILON {
            return Some(p);
        }
        let damp = if !linear && longest > 1.0 {
            1.0 / longest
        } else {
            1.0
        };
        xi = [xi[0] + damp * step[0], xi[1] + damp * step[1]];
        if linear || (positive && longest < LAST_STEP) {
            return Some(evaluate(kind, coordinates, xi));
        }
        if xi[0].abs() + xi[1].abs() > 1e3 {
            return None;
        }
    }
    let p = evaluate(kind, coordinates, xi);
    let r = sub(point, p.x);
    let size = match kind.dim() {
        1 => norm(p.a[0]),
        _ => norm(p.a[0]).max(norm(p.a[1])),
    };
    let settled = dot(r, p.a[0]).abs().max(dot(r, p.a[1]).abs()) < 1e-10 * size * size;
    settled.then_some(p)
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

/// How far the projection `p` lies beyond its facet.
pub fn beyond(kind: ElementKind, coordinates: &[Vec3], p: &FacetPoint) -> Beyond {
    let (inside, edge) = clamp(kind, p.xi);
    if inside == p.xi || (kind.dim() == 1 && inside[0] == p.xi[0]) {
        return Beyond {
            distance: 0.0,
            from: p.x,
            edge,
        };
    }
    let mut n = [0.0; FACET_NODES];
    let n = &mut n[..coordinates.len()];
    kind.reference().values([inside[0], inside[1], 0.0], n);
    let weighted = n.iter().zip(coordinates);
    let x = weighted.fold([0.0; 3], |x, (&n, &c)| add_scaled(x, n, c));
    Beyond {
        distance: distance(p.x, x),
        from: x,
        edge,
    }
}

/// Distance from `point` to the facet itself (not its extension), given its projection. The extension of a curved facet may come near to
/// any place, and its height there says nothing about how far the facet is.
pub fn facet_distance(point: Vec3, p: &FacetPoint, beyond: Beyond) -> f64 {
    if beyond.distance == 0.0 {
        return dot(sub(point, p.x), p.normal).abs();
    }
    distance(point, beyond.from)
}
