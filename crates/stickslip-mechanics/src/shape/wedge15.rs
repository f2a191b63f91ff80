use super::reference::{
    ElementKind, Face, QuadraturePoint, ReferenceElement, edges_of_prism, with_middles,
};
use super::wedge6::{SLOPES, barycentric};

/// The 15-node serendipity wedge, nodes as in VTK: corners, edges 01 12 20, 34 45 53, 03 14 25.
pub(super) struct Wedge15;

static NODES: [[f64; 3]; 15] = with_middles(&super::wedge6::NODES, &EDGES);

static FACES: [Face; 5] = [
    Face::of(ElementKind::Tri6, &[0, 2, 1, 8, 7, 6]),
    Face::of(ElementKind::Tri6, &[3, 4, 5, 9, 10, 11]),
    Face::of(ElementKind::Quad8, &[0, 1, 4, 3, 6, 13, 9, 12]),
    Face::of(ElementKind::Quad8, &[1, 2, 5, 4, 7, 14, 10, 13]),
    Face::of(ElementKind::Quad8, &[2, 0, 3, 5, 8, 12, 11, 14]),
];

/// Corners at the ends of the edges, those of the first triangle first.
const EDGES: [[usize; 2]; 9] = edges_of_prism();

impl ReferenceElement for Wedge15 {
    fn nodes(&self) -> &'static [[f64; 3]] {
        &NODES
    }

    fn values(&self, xi: [f64; 3], n: &mut [f64]) {
        let l = barycentric(xi);
        let bubble = 1.0 - xi[2] * xi[2];
        for (i, n) in n.iter_mut().enumerate() {
            let across = 0.5 * (1.0 + NODES[i][2] * xi[2]);
            let k = i % 3;
            *n = match i {
                // quadratic in the triangle at both ends, less the share of the middle between them
                0..6 => l[k] * ((2.0 * l[k] - 1.0) * across - 0.5 * bubble),
                6..12 => 4.0 * l[EDGES[k][0]] * l[EDGES[k][1]] * across,
                _ => l[k] * bubble,
            };
        }
    }

    fn gradients(&self, xi: [f64; 3], d: &mut [[f64; 3]]) {
        let l = barycentric(xi);
        let (bubble, slope) = (1.0 - xi[2] * xi[2], -2.0 * xi[2]);
        for (i, d) in d.iter_mut().enumerate() {
            let end = NODES[i][2];
            let across = 0.5 * (1.0 + end * xi[2]);
            let k = i % 3;
            // ∂N/∂ζ, and the factors of the gradients of one or two barycentric coordinates
            let (along, factors) = match i {
                0..6 => (
                    0.5 * l[k] * ((2.0 * l[k] - 1.0) * end - slope),
                    [(k, (4.0 * l[k] - 1.0) * across - 0.5 * bubble), (k, 0.0)],
                ),
                6..12 => {
                    let [a, b] = EDGES[k];
                    (
                        2.0 * l[a] * l[b] * end,
                        [(a, 4.0 * l[b] * across), (b, 4.0 * l[a] * across)],
                    )
                }
                _ => (l[k] * slope, [(k, bubble), (k, 0.0)]),
            };
            *d = [0.0, 0.0, along];
            for (corner, factor) in factors {
                d[0] += factor * SLOPES[corner][0];
                d[1] += factor * SLOPES[corner][1];
            }
        }
    }

    fn faces(&self) -> &'static [Face] {
        &FACES
    }

    fn quadrature(&self) -> &'static [QuadraturePoint] {
        // Three points in the triangle, as in C3D15: terms of third and fourth order of the stiffness are left out, which adds no
        // motion without energy.
        &super::gauss::WEDGE_3X3
    }
}
