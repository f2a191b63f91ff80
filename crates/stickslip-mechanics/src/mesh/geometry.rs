//! Jacobians and measures.

use super::{CellRef, Mesh};
use crate::math::{Mat3, Vec3, determinant, distance, norm};
use crate::shape::{ElementKind, MAX_NODES};

/// The derivative of position with respect to the reference coordinates of a cell, `j[i][a] = ∂x_i/∂ξ_a`
/// `[length]`. In 2D the third row and column are those of the unit matrix, so that the determinant is the ratio of
/// areas.
pub fn cell_jacobian(mesh: &Mesh, cell: CellRef, xi: [f64; 3]) -> Mat3 {
    jacobian(mesh.cell_kind(cell), xi, |i| {
        mesh.points[mesh.cell_points(cell)[i]]
    })
}

/// Area (2D) or volume (3D) of a cell.
pub fn cell_measure(mesh: &Mesh, cell: CellRef) -> f64 {
    let rule = mesh.cell_kind(cell).reference().quadrature();
    rule.iter()
        .map(|q| q.weight * determinant(&cell_jacobian(mesh, cell, q.xi)))
        .sum()
}

/// Area (2D) or volume (3D) of all cells.
pub fn measure(mesh: &Mesh) -> f64 {
    mesh.cells().map(|cell| cell_measure(mesh, cell)).sum()
}

/// Lowest and highest coordinates; `None` without points.
pub fn bounding_box(mesh: &Mesh) -> Option<(Vec3, Vec3)> {
    let first = *mesh.points.first()?;
    Some(mesh.points.iter().fold((first, first), |(lo, hi), p| {
        (
            std::array::from_fn(|i| lo[i].min(p[i])),
            std::array::from_fn(|i| hi[i].max(p[i])),
        )
    }))
}

/// Diagonal of the bounding box `[length]`; zero without points.
pub fn diameter(mesh: &Mesh) -> f64 {
    bounding_box(mesh).map_or(0.0, |(lo, hi)| distance(lo, hi))
}

/// See [`cell_jacobian`].
fn jacobian(kind: ElementKind, xi: [f64; 3], point: impl Fn(usize) -> Vec3) -> Mat3 {
    let mut d = [[0.0; 3]; MAX_NODES];
    let d = &mut d[..kind.node_count()];
    kind.reference().gradients(xi, d);
    let mut j = [[0.0; 3]; 3];
    for (node, d) in d.iter().enumerate() {
        let x = point(node);
        for i in 0..3 {
            for a in 0..3 {
                j[i][a] += x[i] * d[a];
            }
        }
    }
    if kind.dim() == 2 {
        j[2] = [0.0, 0.0, 1.0];
    }
    j
}

/// The determinant over the product of the lengths of its columns: 1 for right angles, 0 for a collapsed cell,
/// negative for one turned inside out; aspect ratio and size do not matter. `size` `[length]` is that of the cell: a
/// column below its rounding error counts as collapsed.
pub(super) fn shape_quality(j: &Mat3, dim: usize, size: f64) -> f64 {
    let mut scale = 1.0;
    let [x, y, z] = j;
    for ((x, y), z) in x.iter().zip(y).zip(z).take(dim) {
        let length = norm([*x, *y, *z]);
        if length <= 1e-12 * size {
            return 0.0;
        }
        scale *= length;
    }
    determinant(j) / scale
}
