//! From quadrature points to the nodes of a cell.

use super::scheme::{Scheme, stiffness_rule};
use super::{Formulation, Space};
use crate::math::symmetric_eigen;
use crate::shape::{ElementKind, MAX_NODES};

/// The matrix of shape `(nodes, quadrature points)` that takes values at the quadrature points to the nodes.
///
/// A polynomial is fitted to the points by least squares and evaluated at the nodes: the shape functions of the linear
/// element of the same form (constant for tri3 and tet4, and where the strain is uniform; along the axis of wedge6 only where it has
/// reduced integration). Quadratic cells are thus smoothed to the order at which
/// their stresses are accurate.
pub(super) fn matrix(kind: ElementKind, space: Space, formulation: Formulation) -> Vec<Vec<f64>> {
    if Scheme::of(kind, formulation) == Scheme::Uniform {
        return vec![vec![1.0]; kind.node_count()];
    }
    let rule = stiffness_rule(kind, space, formulation);
    let nodes = kind.reference().nodes();
    let basis = |xi: [f64; 3]| -> Vec<f64> {
        let corner = match kind {
            ElementKind::Wedge6 if rule.len() == 2 => return vec![1.0, xi[2]],
            ElementKind::Wedge6 | ElementKind::Wedge15 => ElementKind::Wedge6,
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
    use super::super::testing;
    use super::*;
    use crate::math::dot;

    #[test]
    fn reproduces_linear_fields() {
        for (kind, space, formulation) in testing::combinations() {
            let scheme = Scheme::of(kind, formulation);
            let constant = matches!(kind, ElementKind::Tri3 | ElementKind::Tet4);
            let two = kind == ElementKind::Wedge6 && formulation == Formulation::Reduced;
            let slopes = match (constant || scheme == Scheme::Uniform, two) {
                (true, _) => [0.0; 3],
                (_, true) => [0.0, 0.0, 0.9],
                _ => [0.5, -0.7, 0.9],
            };
            let f = |xi: [f64; 3]| 2.0 + dot(slopes, xi);
            let fit = matrix(kind, space, formulation);
            let mut values = vec![2.0];
            if scheme != Scheme::Uniform {
                let rule = stiffness_rule(kind, space, formulation);
                values = rule.iter().map(|p| f(p.xi)).collect();
            }
            for (row, &xi) in fit.iter().zip(kind.reference().nodes()) {
                assert_eq!(row.len(), values.len());
                let x: f64 = row.iter().zip(&values).map(|(r, v)| r * v).sum();
                assert!((x - f(xi)).abs() < 1e-12, "{}", kind.name());
            }
        }
    }
}
