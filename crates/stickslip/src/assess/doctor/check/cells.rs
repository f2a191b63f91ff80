//! Cells that are next to nothing: so flat that their stiffness drowns that of the others.

use super::super::finding::{DoctorCause, Finding};
use super::super::suspect::{LocationKind, Suspect};
use crate::math::{Vec3, add_scaled, determinant, distance, symmetric_eigen};
use crate::model::definition::{Body, Model};
use crate::number::digits;
use crate::shape::{ElementKind, MAX_NODES};

/// Bodies with slivers, one finding each.
pub(crate) fn slivers(model: &Model) -> Vec<Finding> {
    model.elastic().filter_map(|b| sliver(model, b)).collect()
}

fn sliver(model: &Model, body: &Body) -> Option<Finding> {
    let mut found: Vec<(f64, u64, ElementKind, Vec3)> = Vec::new();
    for block in &model.mesh.blocks[body.blocks.clone()] {
        let kind = block.kind;
        let cells = block.connectivity.chunks_exact(kind.node_count());
        for (cell, &id) in cells.zip(&block.cell_ids) {
            let x: Vec<Vec3> = cell.iter().map(|&p| model.mesh.points[p]).collect();
            let flat = flatness(kind, &x);
            // A cell with a smaller extent over its largest is a sliver.
            if flat < 1e-6 {
                found.push((flat, id, kind, x[0]));
            }
        }
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (worst, id, kind, _) = *found.first()?;
    let mut finding = DoctorCause::CollapsedCell.warning(format!(
        "body {}: cell {id} ({kind}) is a sliver, its extents 1 to {worst}: next to it all other stiffness is lost in rounding",
        body.name,
        worst = digits(worst, 2),
    ));
    for (flat, id, kind, x) in found {
        finding = finding.blame(
            Suspect {
                what: LocationKind::Cell,
                name: body.name.clone(),
                id: Some(id),
                body: Some(body.name.clone()),
                remark: format!("{kind}, extents 1 to {flat}", flat = digits(flat, 2)),
                ..Suspect::default()
            }
            .at(x),
        );
    }
    Some(finding.advise(
        "repair the mesh there: merge nodes that almost coincide, or give the cell a height",
    ))
}

/// The smallest over the largest extent of a cell: of its Jacobian at the centre, and of its edges.
fn flatness(kind: ElementKind, x: &[Vec3]) -> f64 {
    let element = kind.reference();
    let dim = kind.dim();
    let corners = corners(kind);
    let mut xi = [0.0; 3];
    for node in &element.nodes()[..corners] {
        xi = add_scaled(xi, 1.0 / corners as f64, *node);
    }
    let mut d = [[0.0; 3]; MAX_NODES];
    element.gradients(xi, &mut d[..kind.node_count()]);
    let mut jacobian = [[0.0; 3]; 3];
    for (x, d) in x.iter().zip(&d) {
        for (row, x) in jacobian.iter_mut().zip(x) {
            for (j, d) in row.iter_mut().zip(d) {
                *j += x * d;
            }
        }
    }
    let mut edges = [f64::INFINITY, 0.0_f64];
    for a in 0..corners {
        for b in 0..a {
            let length = distance(x[a], x[b]);
            edges = [edges[0].min(length), edges[1].max(length)];
        }
    }
    let shortest = edges[0] / edges[1];
    if dim == 2 {
        jacobian[2][2] = 1.0;
    }
    // A cell that fills more than a thousandth of the cube of its longest edge cannot be a sliver, whatever its shape.
    if determinant(&jacobian).abs() > 1e-3 * edges[1].powi(dim as i32) {
        return shortest;
    }
    let gram: Vec<Vec<f64>> = (0..dim)
        .map(|a| {
            (0..dim)
                .map(|b| (0..dim).map(|i| jacobian[i][a] * jacobian[i][b]).sum())
                .collect()
        })
        .collect();
    let (values, _) = symmetric_eigen(&gram);
    let ratio = match values.as_slice() {
        [first, .., last] if *last > 0.0 => (first.max(0.0) / last).sqrt(),
        _ => 0.0,
    };
    ratio.min(shortest)
}

/// How many of its nodes, the first, are corners.
fn corners(kind: ElementKind) -> usize {
    let faces = kind.reference().faces();
    let corner = |face: &crate::shape::Face| match face.nodes.len() {
        _ if kind.dim() == 2 => 2,
        3 | 6 => 3,
        _ => 4,
    };
    let nodes = faces.iter().flat_map(|f| &f.nodes[..corner(f)]);
    nodes.max().map_or(0, |n| n + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flat_cell_is_told_from_a_thin_layer() {
        let quad = |height: f64, last: f64| {
            let x = [
                [0.0, 0.0, 0.0],
                [1.0, 0.0, 0.0],
                [1.0, last, 0.0],
                [0.0, height, 0.0],
            ];
            flatness(ElementKind::Quad4, &x)
        };
        assert!((quad(1.0, 1.0) - 1.0).abs() < 0.5);
        assert!(quad(1e-4, 1e-4) > 0.5e-4);
        assert!(quad(1e-9, 1e-9) < 1e-8);
        // One edge alone.
        assert!(quad(1.0, 1e-9) < 1e-8);
    }
}
