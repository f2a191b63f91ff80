use super::gauss::HEX_2X2X2;
use super::reference::{ElementKind, Face, QuadraturePoint, ReferenceElement};

/// The 8-node hexahedron, trilinear.
pub(super) struct Hex8;

pub(super) static NODES: [[f64; 3]; 8] = [
    [-1.0, -1.0, -1.0],
    [1.0, -1.0, -1.0],
    [1.0, 1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
    [1.0, -1.0, 1.0],
    [1.0, 1.0, 1.0],
    [-1.0, 1.0, 1.0],
];

static FACES: [Face; 6] = [
    Face::of(ElementKind::Quad4, &[0, 3, 2, 1]),
    Face::of(ElementKind::Quad4, &[4, 5, 6, 7]),
    Face::of(ElementKind::Quad4, &[0, 1, 5, 4]),
    Face::of(ElementKind::Quad4, &[1, 2, 6, 5]),
    Face::of(ElementKind::Quad4, &[2, 3, 7, 6]),
    Face::of(ElementKind::Quad4, &[3, 0, 4, 7]),
];

fn factors(xi: [f64; 3], node: &[f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| 1.0 + xi[i] * node[i])
}

impl ReferenceElement for Hex8 {
    fn nodes(&self) -> &'static [[f64; 3]] {
        &NODES
    }

    fn values(&self, xi: [f64; 3], n: &mut [f64]) {
        for (n, node) in n.iter_mut().zip(&NODES) {
            let f = factors(xi, node);
            *n = 0.125 * f[0] * f[1] * f[2];
        }
    }

    fn gradients(&self, xi: [f64; 3], d: &mut [[f64; 3]]) {
        for (d, node) in d.iter_mut().zip(&NODES) {
            let f = factors(xi, node);
            *d = [
                0.125 * node[0] * f[1] * f[2],
                0.125 * node[1] * f[0] * f[2],
                0.125 * node[2] * f[0] * f[1],
            ];
        }
    }

    fn faces(&self) -> &'static [Face] {
        &FACES
    }

    fn quadrature(&self) -> &'static [QuadraturePoint] {
        &HEX_2X2X2
    }

    fn reduced_quadrature(&self) -> &'static [QuadraturePoint] {
        &super::gauss::HEX_1
    }
}
