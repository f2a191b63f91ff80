use super::reference::{ElementKind, Face, QuadraturePoint, ReferenceElement};
use super::simplex::barycentric;

/// The 4-node tetrahedron.
pub(super) struct Tet4;

pub(super) static NODES: [[f64; 3]; 4] = [
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
];

static FACES: [Face; 4] = [
    Face::of(ElementKind::Tri3, &[0, 2, 1]),
    Face::of(ElementKind::Tri3, &[0, 1, 3]),
    Face::of(ElementKind::Tri3, &[1, 2, 3]),
    Face::of(ElementKind::Tri3, &[2, 0, 3]),
];

/// Gradients of the barycentric coordinates.
pub(super) static BARYCENTRIC: [[f64; 3]; 4] = [
    [-1.0, -1.0, -1.0],
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
];

static RULE: [QuadraturePoint; 1] = [QuadraturePoint {
    xi: [0.25; 3],
    weight: 1.0 / 6.0,
}];

impl ReferenceElement for Tet4 {
    fn nodes(&self) -> &'static [[f64; 3]] {
        &NODES
    }

    fn values(&self, xi: [f64; 3], n: &mut [f64]) {
        n.copy_from_slice(&barycentric(xi));
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
