use super::gauss::QUAD_2X2;
use super::reference::{ElementKind, Face, QuadraturePoint, ReferenceElement};

/// The 4-node quadrilateral, bilinear.
pub(super) struct Quad4;

pub(super) static NODES: [[f64; 3]; 4] = [
    [-1.0, -1.0, 0.0],
    [1.0, -1.0, 0.0],
    [1.0, 1.0, 0.0],
    [-1.0, 1.0, 0.0],
];

static FACES: [Face; 4] = [
    Face::of(ElementKind::Line2, &[0, 1]),
    Face::of(ElementKind::Line2, &[1, 2]),
    Face::of(ElementKind::Line2, &[2, 3]),
    Face::of(ElementKind::Line2, &[3, 0]),
];

impl ReferenceElement for Quad4 {
    fn nodes(&self) -> &'static [[f64; 3]] {
        &NODES
    }

    fn values(&self, xi: [f64; 3], n: &mut [f64]) {
        for (n, node) in n.iter_mut().zip(&NODES) {
            *n = 0.25 * (1.0 + xi[0] * node[0]) * (1.0 + xi[1] * node[1]);
        }
    }

    fn gradients(&self, xi: [f64; 3], d: &mut [[f64; 3]]) {
        for (d, node) in d.iter_mut().zip(&NODES) {
            let (a, b) = (1.0 + xi[0] * node[0], 1.0 + xi[1] * node[1]);
            *d = [0.25 * node[0] * b, 0.25 * node[1] * a, 0.0];
        }
    }

    fn second_derivatives(&self, _xi: [f64; 3], d: &mut [[f64; 3]]) {
        for (d, node) in d.iter_mut().zip(&NODES) {
            *d = [0.0, 0.0, 0.25 * node[0] * node[1]];
        }
    }

    fn faces(&self) -> &'static [Face] {
        &FACES
    }

    fn quadrature(&self) -> &'static [QuadraturePoint] {
        &QUAD_2X2
    }

    fn reduced_quadrature(&self) -> &'static [QuadraturePoint] {
        &super::gauss::QUAD_1
    }
}
