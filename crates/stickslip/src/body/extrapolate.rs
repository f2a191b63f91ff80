//! From quadrature points to the nodes of a cell.

use super::Space;
use super::geometry::cell_rule;
use crate::math::symmetric_eigen;
use crate::shape::{ElementKind, MAX_NODES};

/// The matrix of shape `(nodes, quadrature points)` that takes values at the quadrature points to the nodes.
///
/// A polynomial is fitted to the points by least squares and evaluated at the nodes: the shape functions of the linear
/// element of the same form (constant for tri3 and tet4). Quadratic cells are thus smoothed to the order at which
/// their stresses are accurate.
pub(super) fn matrix(kind: ElementKind, space: Space) -> Vec<Vec<f64>> {
    let rule = cell_rule(kind, space);
    let nodes = kind.reference().nodes();
    let basis = |xi: [f64; 3]| -> Vec<f64> {
        let corner = match kind {
            ElementKind::Tri6 => ElementKind::Tri3,
            ElementKind::Tet10 => ElementKind::Tet4,
            ElementKind::Quad4 | ElementKind::Quad8 => ElementKind::Quad4,
            ElementKind::Hex8 | ElementKind::Hex20 => ElementKind::Hex8,
            _ => return vec![1.0],
        };
        let mut n = [0.0; MAX_NODES];
        let count = corner.node_count();
        corner.reference().values(xi, &mut n[..count]);
        n[..count].to_vec()
    };
    let at_points: Vec<Vec<f64>> = rule.iter().map(|p| basis(p.xi)).collect();
    let m = at_points[0].len();
    // Normal equations of a handful of unknowns; the rules have at least as many points as there are functions, so
    // that their matrix is regular.
    let normal: Vec<Vec<f64>> = (0..m)
        .map(|i| {
            (0..m)
                .map(|j| at_points.iter().map(|b| b[i] * b[j]).sum())
                .collect()
        })
        .collect();
    let (values, vectors) = symmetric_eigen(&normal);
    nodes
        .iter()
        .map(|&xi| {
            let b = basis(xi);
            // c = normal⁻¹ b through the eigenvectors
            let mut c = vec![0.0; m];
            for (e, value) in values.iter().enumerate() {
                let along: f64 = (0..m).map(|i| vectors[i][e] * b[i]).sum::<f64>() / value;
                for (ci, row) in c.iter_mut().zip(&vectors) {
                    *ci += along * row[e];
                }
            }
            at_points
                .iter()
                .map(|p| p.iter().zip(&c).map(|(p, c)| p * c).sum())
                .collect()
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reproduces_linear_fields() {
        for kind in ElementKind::ALL {
            if kind.dim() < 2 {
                continue;
            }
            let space = if kind.dim() == 3 {
                Space::Solid
            } else {
                Space::Axisymmetric
            };
            let constant_only = matches!(kind, ElementKind::Tri3 | ElementKind::Tet4);
            let slope = if constant_only { 0.0 } else { 1.0 };
            let f = |xi: [f64; 3]| 2.0 + slope * (0.5 * xi[0] - 0.7 * xi[1] + 0.9 * xi[2]);
            let values: Vec<f64> = cell_rule(kind, space).iter().map(|p| f(p.xi)).collect();
            for (row, &xi) in matrix(kind, space).iter().zip(kind.reference().nodes()) {
                let x: f64 = row.iter().zip(&values).map(|(r, v)| r * v).sum();
                assert!((x - f(xi)).abs() < 1e-12, "{}", kind.name());
            }
        }
    }
}
