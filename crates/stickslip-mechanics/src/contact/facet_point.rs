//! A place of a facet with all that follows from it: shape functions and geometry, with their derivatives.

use crate::math::{Vec3, add_scaled, cross, dot, norm, scale};
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
