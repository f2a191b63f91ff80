use super::reference::{ElementKind, Face, QuadraturePoint, ReferenceElement, with_middles};
use super::simplex::{self, barycentric};
use super::tri3::BARYCENTRIC;

/// The 6-node triangle.
pub(super) struct Tri6;

static NODES: [[f64; 3]; 6] = with_middles(&super::tri3::NODES, &EDGES);

static FACES: [Face; 3] = [
    Face::of(ElementKind::Line3, &[0, 1, 3]),
    Face::of(ElementKind::Line3, &[1, 2, 4]),
    Face::of(ElementKind::Line3, &[2, 0, 5]),
];

static EDGES: [[usize; 2]; 3] = [[0, 1], [1, 2], [2, 0]];

/// Exact for quadratics; all points inside.
static RULE: [QuadraturePoint; 3] = [
    point(1.0 / 6.0, 1.0 / 6.0),
    point(2.0 / 3.0, 1.0 / 6.0),
    point(1.0 / 6.0, 2.0 / 3.0),
];

const fn point(x: f64, y: f64) -> QuadraturePoint {
    QuadraturePoint {
        xi: [x, y, 0.0],
        weight: 1.0 / 6.0,
    }
}

impl ReferenceElement for Tri6 {
    fn nodes(&self) -> &'static [[f64; 3]] {
        &NODES
    }

    fn values(&self, xi: [f64; 3], n: &mut [f64]) {
        simplex::values(&barycentric([xi[0], xi[1], 0.0]), &EDGES, n);
    }

    fn gradients(&self, xi: [f64; 3], d: &mut [[f64; 3]]) {
        let l = barycentric([xi[0], xi[1], 0.0]);
        simplex::gradients(&l, &BARYCENTRIC, &EDGES, d);
    }

    fn second_derivatives(&self, _xi: [f64; 3], d: &mut [[f64; 3]]) {
        let hessian = |i: usize, j: usize, factor: f64| {
            let (a, b) = (BARYCENTRIC[i], BARYCENTRIC[j]);
            [
                factor * 2.0 * a[0] * b[0],
                factor * 2.0 * a[1] * b[1],
                factor * (a[0] * b[1] + a[1] * b[0]),
            ]
        };
        for (i, d) in d[..3].iter_mut().enumerate() {
            *d = hessian(i, i, 2.0);
        }
        for (d, &[i, j]) in d[3..].iter_mut().zip(&EDGES) {
            *d = hessian(i, j, 4.0);
        }
    }

    fn faces(&self) -> &'static [Face] {
        &FACES
    }

    fn quadrature(&self) -> &'static [QuadraturePoint] {
        &RULE
    }
}
