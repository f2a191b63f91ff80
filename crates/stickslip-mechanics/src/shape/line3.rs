use super::gauss::LINE_3;
use super::reference::{Face, QuadraturePoint, ReferenceElement};

/// The 3-node line, its middle node last.
pub(super) struct Line3;

static NODES: [[f64; 3]; 3] = [[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]];

impl ReferenceElement for Line3 {
    fn nodes(&self) -> &'static [[f64; 3]] {
        &NODES
    }

    fn values(&self, xi: [f64; 3], n: &mut [f64]) {
        let x = xi[0];
        n[0] = 0.5 * x * (x - 1.0);
        n[1] = 0.5 * x * (x + 1.0);
        n[2] = 1.0 - x * x;
    }

    fn gradients(&self, xi: [f64; 3], d: &mut [[f64; 3]]) {
        let x = xi[0];
        d[0] = [x - 0.5, 0.0, 0.0];
        d[1] = [x + 0.5, 0.0, 0.0];
        d[2] = [-2.0 * x, 0.0, 0.0];
    }

    fn second_derivatives(&self, _xi: [f64; 3], d: &mut [[f64; 3]]) {
        d[0] = [1.0, 0.0, 0.0];
        d[1] = [1.0, 0.0, 0.0];
        d[2] = [-2.0, 0.0, 0.0];
    }

    fn faces(&self) -> &'static [Face] {
        &[]
    }

    fn quadrature(&self) -> &'static [QuadraturePoint] {
        &LINE_3
    }
}
