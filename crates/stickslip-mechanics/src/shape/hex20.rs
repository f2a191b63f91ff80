use super::gauss::HEX_3X3X3;
use super::reference::{
    ElementKind, Face, QuadraturePoint, ReferenceElement, edges_of_prism, with_middles,
};
use crate::math::{Slope, dot};

/// The 20-node serendipity hexahedron, nodes as in VTK.
pub(super) struct Hex20;

static NODES: [[f64; 3]; 20] = with_middles(&super::hex8::NODES, &edges_of_prism::<12>());

static FACES: [Face; 6] = [
    Face::of(ElementKind::Quad8, &[0, 3, 2, 1, 11, 10, 9, 8]),
    Face::of(ElementKind::Quad8, &[4, 5, 6, 7, 12, 13, 14, 15]),
    Face::of(ElementKind::Quad8, &[0, 1, 5, 4, 8, 17, 12, 16]),
    Face::of(ElementKind::Quad8, &[1, 2, 6, 5, 9, 18, 13, 17]),
    Face::of(ElementKind::Quad8, &[2, 3, 7, 6, 10, 19, 14, 18]),
    Face::of(ElementKind::Quad8, &[3, 0, 4, 7, 11, 16, 15, 19]),
];

/// The direction of the edge whose middle this node is; `None` for a corner.
fn middle(node: &[f64; 3]) -> Option<usize> {
    node.iter().position(|&x| x == 0.0)
}

/// In each direction `1 + ξ ξ_node`, or `1 - ξ²` along the edge of a mid-side node.
fn factors(xi: [f64; 3], node: &[f64; 3]) -> [Slope; 3] {
    std::array::from_fn(|i| {
        if node[i] == 0.0 {
            Slope {
                value: 1.0 - xi[i] * xi[i],
                slope: -2.0 * xi[i],
            }
        } else {
            Slope {
                value: 1.0 + xi[i] * node[i],
                slope: node[i],
            }
        }
    })
}

impl ReferenceElement for Hex20 {
    fn nodes(&self) -> &'static [[f64; 3]] {
        &NODES
    }

    fn values(&self, xi: [f64; 3], n: &mut [f64]) {
        for (n, node) in n.iter_mut().zip(&NODES) {
            let f = factors(xi, node);
            let product = f[0].value * f[1].value * f[2].value;
            *n = match middle(node) {
                Some(_) => 0.25 * product,
                None => 0.125 * product * (dot(xi, *node) - 2.0),
            };
        }
    }

    fn gradients(&self, xi: [f64; 3], d: &mut [[f64; 3]]) {
        for (d, node) in d.iter_mut().zip(&NODES) {
            let f = factors(xi, node);
            // The product rule: the factor of direction `i` replaced by its slope.
            let product = f[0].value * f[1].value * f[2].value;
            let slopes: [f64; 3] =
                std::array::from_fn(|i| f[i].slope * f[(i + 1) % 3].value * f[(i + 2) % 3].value);
            *d = match middle(node) {
                Some(_) => slopes.map(|s| 0.25 * s),
                None => {
                    let last = dot(xi, *node) - 2.0;
                    std::array::from_fn(|i| 0.125 * (slopes[i] * last + product * node[i]))
                }
            };
        }
    }

    fn faces(&self) -> &'static [Face] {
        &FACES
    }

    fn quadrature(&self) -> &'static [QuadraturePoint] {
        &HEX_3X3X3
    }

    fn reduced_quadrature(&self) -> &'static [QuadraturePoint] {
        &super::gauss::HEX_2X2X2
    }
}
