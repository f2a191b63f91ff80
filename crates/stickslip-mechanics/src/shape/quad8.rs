use super::gauss::QUAD_3X3;
use super::reference::{ElementKind, Face, QuadraturePoint, ReferenceElement, with_middles};

/// The 8-node serendipity quadrilateral.
pub(super) struct Quad8;

static NODES: [[f64; 3]; 8] = with_middles(&super::quad4::NODES, &[[0, 1], [1, 2], [2, 3], [3, 0]]);

static FACES: [Face; 4] = [
    Face::of(ElementKind::Line3, &[0, 1, 4]),
    Face::of(ElementKind::Line3, &[1, 2, 5]),
    Face::of(ElementKind::Line3, &[2, 3, 6]),
    Face::of(ElementKind::Line3, &[3, 0, 7]),
];

impl ReferenceElement for Quad8 {
    fn nodes(&self) -> &'static [[f64; 3]] {
        &NODES
    }

    fn values(&self, xi: [f64; 3], n: &mut [f64]) {
        let [x, y, _] = xi;
        for (n, &[xn, yn, _]) in n.iter_mut().zip(&NODES) {
            let (a, b) = (x * xn, y * yn);
            *n = if xn == 0.0 {
                0.5 * (1.0 - x * x) * (1.0 + b)
            } else if yn == 0.0 {
                0.5 * (1.0 + a) * (1.0 - y * y)
            } else {
                0.25 * (1.0 + a) * (1.0 + b) * (a + b - 1.0)
            };
        }
    }

    fn gradients(&self, xi: [f64; 3], d: &mut [[f64; 3]]) {
        let [x, y, _] = xi;
        for (d, &[xn, yn, _]) in d.iter_mut().zip(&NODES) {
            let (a, b) = (x * xn, y * yn);
            *d = if xn == 0.0 {
                [-x * (1.0 + b), 0.5 * yn * (1.0 - x * x), 0.0]
            } else if yn == 0.0 {
                [0.5 * xn * (1.0 - y * y), -y * (1.0 + a), 0.0]
            } else {
                [
                    0.25 * xn * (1.0 + b) * (2.0 * a + b),
                    0.25 * yn * (1.0 + a) * (a + 2.0 * b),
                    0.0,
                ]
            };
        }
    }

    fn second_derivatives(&self, xi: [f64; 3], d: &mut [[f64; 3]]) {
        let [x, y, _] = xi;
        for (d, &[xn, yn, _]) in d.iter_mut().zip(&NODES) {
            let (a, b) = (x * xn, y * yn);
            *d = if xn == 0.0 {
                [-(1.0 + b), 0.0, -x * yn]
            } else if yn == 0.0 {
                [0.0, -(1.0 + a), -y * xn]
            } else {
                [
                    0.5 * (1.0 + b),
                    0.5 * (1.0 + a),
                    0.25 * xn * yn * (1.0 + 2.0 * (a + b)),
                ]
            };
        }
    }

    fn third_derivatives(&self, _xi: [f64; 3], d: &mut [[f64; 4]]) {
        for (d, &[xn, yn, _]) in d.iter_mut().zip(&NODES) {
            *d = if xn == 0.0 {
                [0.0, -yn, 0.0, 0.0]
            } else if yn == 0.0 {
                [0.0, 0.0, -xn, 0.0]
            } else {
                [0.0, 0.5 * yn, 0.5 * xn, 0.0]
            };
        }
    }

    fn faces(&self) -> &'static [Face] {
        &FACES
    }

    fn quadrature(&self) -> &'static [QuadraturePoint] {
        &QUAD_3X3
    }

    fn reduced_quadrature(&self) -> &'static [QuadraturePoint] {
        &super::gauss::QUAD_2X2
    }
}
