use super::reference::{ElementKind, Face, QuadraturePoint, ReferenceElement, with_middles};
use super::simplex::{self, barycentric};
use super::tet4::BARYCENTRIC;

/// The 10-node tetrahedron, edges in the order 01 12 20 03 13 23.
pub(super) struct Tet10;

static NODES: [[f64; 3]; 10] = with_middles(&super::tet4::NODES, &EDGES);

static FACES: [Face; 4] = [
    Face::of(ElementKind::Tri6, &[0, 2, 1, 6, 5, 4]),
    Face::of(ElementKind::Tri6, &[0, 1, 3, 4, 8, 7]),
    Face::of(ElementKind::Tri6, &[1, 2, 3, 5, 9, 8]),
    Face::of(ElementKind::Tri6, &[2, 0, 3, 6, 7, 9]),
];

static EDGES: [[usize; 2]; 6] = [[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]];

/// `(5 - √5) / 20`
const SMALL_COORDINATE: f64 = 0.138_196_601_125_010_5;
/// `(5 + 3 √5) / 20`
const LARGE_COORDINATE: f64 = 0.585_410_196_624_968_5;

/// Exact for quadratics.
static RULE: [QuadraturePoint; 4] = [
    point(SMALL_COORDINATE, SMALL_COORDINATE, SMALL_COORDINATE),
    point(LARGE_COORDINATE, SMALL_COORDINATE, SMALL_COORDINATE),
    point(SMALL_COORDINATE, LARGE_COORDINATE, SMALL_COORDINATE),
    point(SMALL_COORDINATE, SMALL_COORDINATE, LARGE_COORDINATE),
];

const fn point(x: f64, y: f64, z: f64) -> QuadraturePoint {
    QuadraturePoint {
        xi: [x, y, z],
        weight: 1.0 / 24.0,
    }
}

impl ReferenceElement for Tet10 {
    fn nodes(&self) -> &'static [[f64; 3]] {
        &NODES
    }

    fn values(&self, xi: [f64; 3], n: &mut [f64]) {
        simplex::values(&barycentric(xi), &EDGES, n);
    }

    fn gradients(&self, xi: [f64; 3], d: &mut [[f64; 3]]) {
        simplex::gradients(&barycentric(xi), &BARYCENTRIC, &EDGES, d);
    }

    fn faces(&self) -> &'static [Face] {
        &FACES
    }

    fn quadrature(&self) -> &'static [QuadraturePoint] {
        &RULE
    }
}
