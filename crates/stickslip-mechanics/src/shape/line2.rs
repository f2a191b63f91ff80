use super::gauss::LINE_2;
use super::reference::{Face, QuadraturePoint, ReferenceElement};

/// The 2-node line.
pub(super) struct Line2;

static NODES: [[f64; 3]; 2] = [[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]];

impl ReferenceElement for Line2 {
    fn nodes(&self) -> &'static [[f64; 3]] {
        &NODES
    }

    fn values(&self, xi: [f64; 3], n: &mut [f64]) {
        n[0] = 0.5 * (1.0 - xi[0]);
        n[1] = 0.5 * (1.0 + xi[0]);
    }

    fn gradients(&self, _xi: [f64; 3], d: &mut [[f64; 3]]) {
        d[0] = [-0.5, 0.0, 0.0];
        d[1] = [0.5, 0.0, 0.0];
    }

    fn faces(&self) -> &'static [Face] {
        &[]
    }

    fn quadrature(&self) -> &'static [QuadraturePoint] {
        &LINE_2
    }
}
