use super::reference::{ElementKind, Face, QuadraturePoint, ReferenceElement};
use super::simplex::barycentric;

/// The 3-node triangle.
pub(super) struct Tri3;

pub(super) static NODES: [[f64; 3]; 3] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

static FACES: [Face; 3] = [
    Face::of(ElementKind::Line2, &[0, 1]),
    Face::of(ElementKind::Line2, &[1, 2]),
    Face::of(ElementKind::Line2, &[2, 0]),
];

/// Gradients of the barycentric coordinates.
pub(super) static BARYCENTRIC: [[f64; 3]; 3] =
    [[-1.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

static RULE: [QuadraturePoint; 1] = [QuadraturePoint {
    xi: [1.0 / 3.0, 1.0 / 3.0, 0.0],
    weight: 0.5,
}];

impl ReferenceElement for Tri3 {
    fn nodes(&self) -> &'static [[f64; 3]] {
        &NODES
    }

    fn values(&self, xi: [f64; 3], n: &mut [f64]) {
        n.copy_from_slice(&barycentric([xi[0], xi[1], 0.0])[..3]);
    }

    fn gradients(&self, _xi: [f64; 3], d: &mut [[f64; 3]]) {
        d.copy_from_slice(&BARYCENTRIC);
    }

    fn faces(&self) -> &'static [Face] {
        &FACES
    }

    fn quadrature(&self) -> &'static [QuadraturePoint] {
        &RULE
    }
}
