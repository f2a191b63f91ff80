use super::reference::{ElementKind, Face, QuadraturePoint, ReferenceElement};

/// The 6-node wedge: a triangle times a line.
pub(super) struct Wedge6;

pub(super) static NODES: [[f64; 3]; 6] = [
    [0.0, 0.0, -1.0],
    [1.0, 0.0, -1.0],
    [0.0, 1.0, -1.0],
    [0.0, 0.0, 1.0],
    [1.0, 0.0, 1.0],
    [0.0, 1.0, 1.0],
];

static FACES: [Face; 5] = [
    Face::of(ElementKind::Tri3, &[0, 2, 1]),
    Face::of(ElementKind::Tri3, &[3, 4, 5]),
    Face::of(ElementKind::Quad4, &[0, 1, 4, 3]),
    Face::of(ElementKind::Quad4, &[1, 2, 5, 4]),
    Face::of(ElementKind::Quad4, &[2, 0, 3, 5]),
];

impl ReferenceElement for Wedge6 {
    fn nodes(&self) -> &'static [[f64; 3]] {
        &NODES
    }

    fn values(&self, xi: [f64; 3], n: &mut [f64]) {
        let l = barycentric(xi);
        for (i, n) in n.iter_mut().enumerate() {
            *n = 0.5 * l[i % 3] * (1.0 + NODES[i][2] * xi[2]);
        }
    }

    fn gradients(&self, xi: [f64; 3], d: &mut [[f64; 3]]) {
        let l = barycentric(xi);
        for (i, d) in d.iter_mut().enumerate() {
            let end = NODES[i][2];
            let across = 0.5 * (1.0 + end * xi[2]);
            let [a, b] = SLOPES[i % 3];
            *d = [a * across, b * across, 0.5 * end * l[i % 3]];
        }
    }

    fn faces(&self) -> &'static [Face] {
        &FACES
    }

    fn quadrature(&self) -> &'static [QuadraturePoint] {
        &super::gauss::WEDGE_3X2
    }

    fn reduced_quadrature(&self) -> &'static [QuadraturePoint] {
        &super::gauss::WEDGE_1X2
    }
}

/// Barycentric coordinates in the triangle.
pub(super) fn barycentric(xi: [f64; 3]) -> [f64; 3] {
    [1.0 - xi[0] - xi[1], xi[0], xi[1]]
}

/// Their derivatives.
pub(super) static SLOPES: [[f64; 2]; 3] = [[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]];
