//! What must hold of a mesh before anything is computed on it.

use super::geometry::shape_quality;
use super::{CellRef, Mesh};
use crate::error::MeshError;
use crate::math::distance;
use crate::mesh::geometry;
use crate::number::figure;

/// A Jacobian below this part of that of a right-angled cell is collapsed. It is about the root of a machine epsilon: half of the digits of the gradients are
/// lost there.
const COLLAPSED: f64 = 1e-8;

/// Checks the structure (indices in range, lengths that fit), the coordinates and the Jacobian of every cell at
/// its quadrature points and corners. Unused points are allowed: see [`unused_points`].
///
/// # Errors
/// The first finding, with the user's number of the point or cell.
pub fn check(mesh: &Mesh) -> Result<(), MeshError> {
    check_structure(mesh)?;
    check_faces(mesh)?;
    mesh.cells().try_for_each(|cell| check_jacobian(mesh, cell))
}

/// Checks indices, lengths and coordinates, not the shape of cells: what files can hold.
///
/// # Errors
/// The first finding, with the user's number of the point or cell.
pub fn check_structure(mesh: &Mesh) -> Result<(), MeshError> {
    check_points(mesh)?;
    check_blocks(mesh)?;
    check_sets(mesh)
}

/// The points that no cell uses, sorted.
pub fn unused_points(mesh: &Mesh) -> Vec<usize> {
    let mut used = vec![false; mesh.points.len()];
    for &p in mesh.blocks.iter().flat_map(|b| &b.connectivity) {
        if let Some(used) = used.get_mut(p) {
            *used = true;
        }
    }
    (0..used.len()).filter(|&p| !used[p]).collect()
}

fn check_points(mesh: &Mesh) -> Result<(), MeshError> {
    if !(2..=3).contains(&mesh.dim) {
        return Err(
            MeshError::new(format!("a mesh cannot have dimension {}", mesh.dim))
                .help("the dimension is 2 or 3"),
        );
    }
    if mesh.point_ids.len() != mesh.points.len() {
        return Err(MeshError::new(format!(
            "{} points have {} numbers",
            mesh.points.len(),
            mesh.point_ids.len()
        ))
        .help("give every point one number"));
    }
    for (p, x) in mesh.points.iter().enumerate() {
        let id = mesh.point_ids[p];
        if x.iter().any(|x| !x.is_finite()) {
            return Err(MeshError::new(format!(
                "point {id} has a coordinate that is not finite: ({}, {}, {})",
                x[0], x[1], x[2]
            ))
            .help("repair the mesh where it was made"));
        }
        if mesh.dim == 2 && x[2] != 0.0 {
            return Err(
                MeshError::new(format!("point {id} of a 2D mesh has z = {}", x[2]))
                    .help("a 2D mesh lies in the plane z = 0"),
            );
        }
    }
    Ok(())
}

fn check_blocks(mesh: &Mesh) -> Result<(), MeshError> {
    if mesh.cell_count() == 0 {
        return Err(MeshError::new("the mesh has no cells").help(format!(
            "a {}D mesh needs cells of dimension {}",
            mesh.dim, mesh.dim
        )));
    }
    for (index, block) in mesh.blocks.iter().enumerate() {
        let kind = block.kind;
        if kind.dim() != mesh.dim {
            return Err(MeshError::new(format!(
                "block {index} of a {}D mesh holds {kind} cells",
                mesh.dim
            ))
            .help("cells have the dimension of the mesh; give faces as facet sets"));
        }
        if block.connectivity.len() != block.cell_ids.len() * kind.node_count() {
            return Err(MeshError::new(format!(
                "block {index} lists {} nodes for {} cells of kind {kind}",
                block.connectivity.len(),
                block.cell_ids.len()
            ))
            .help(format!("a {kind} has {} nodes", kind.node_count())));
        }
        for (nodes, id) in block
            .connectivity
            .chunks_exact(kind.node_count())
            .zip(&block.cell_ids)
        {
            if let Some(p) = nodes.iter().find(|&&p| p >= mesh.points.len()) {
                return Err(MeshError::new(format!(
                    "cell {id} ({kind}) uses the point at position {p} of {}",
                    mesh.points.len()
                ))
                .help("every node of a cell must be a point of the mesh"));
            }
        }
    }
    Ok(())
}

fn check_sets(mesh: &Mesh) -> Result<(), MeshError> {
    let missing = |what: &str, name: &str| {
        Err(MeshError::new(format!(
            "the set \"{name}\" names a {what} that does not exist"
        ))
        .help("make the set from the mesh it belongs to"))
    };
    let exists = |c: &CellRef| {
        mesh.blocks
            .get(c.block)
            .is_some_and(|b| c.cell < b.cell_ids.len())
    };
    for (name, points) in &mesh.point_sets {
        if points.iter().any(|&p| p >= mesh.points.len()) {
            return missing("point", name);
        }
    }
    for (name, cells) in &mesh.cell_sets {
        if !cells.iter().all(exists) {
            return missing("cell", name);
        }
    }
    for (name, facets) in &mesh.facet_sets {
        let valid = |f: &super::FacetRef| {
            exists(&f.cell) && f.face < mesh.cell_kind(f.cell).reference().faces().len()
        };
        if !facets.iter().all(valid) {
            return missing("facet", name);
        }
    }
    Ok(())
}

/// A face joins two cells at most, and these agree about its mid-side nodes.
fn check_faces(mesh: &Mesh) -> Result<(), MeshError> {
    for users in mesh.shared_faces().chunk_by(|a, b| a.0 == b.0) {
        let cells: Vec<String> = users
            .iter()
            .map(|(_, f)| mesh.cell_id(f.cell).to_string())
            .collect();
        if users.len() > 2 {
            return Err(
                MeshError::new(format!("the cells {} share one face", cells.join(", ")))
                    .help("a face belongs to two cells at most; look for cells given twice"),
            );
        }
        if users.len() == 2 {
            let sorted = |f| {
                let mut points = mesh.facet_points(f).1;
                points.sort_unstable();
                points
            };
            if sorted(users[0].1) != sorted(users[1].1) {
                return Err(MeshError::new(format!(
                    "the cells {} share the corners of a face but not its mid-side nodes",
                    cells.join(" and ")
                ))
                .help("use cells of one order, or tie them as separate bodies"));
            }
        }
    }
    Ok(())
}

fn check_jacobian(mesh: &Mesh, cell: CellRef) -> Result<(), MeshError> {
    let kind = mesh.cell_kind(cell);
    let points = mesh.cell_points(cell);
    let reference = kind.reference();
    let corners = reference.nodes()[..kind.corner_count()].iter().copied();
    let origin = mesh.points[points[0]];
    let size = points
        .iter()
        .map(|&p| distance(mesh.points[p], origin))
        .fold(0.0, f64::max);
    let worst = corners
        .chain(reference.quadrature().iter().map(|q| q.xi))
        .map(|xi| shape_quality(&geometry::cell_jacobian(mesh, cell, xi), mesh.dim, size))
        .fold(f64::INFINITY, f64::min);
    if worst > COLLAPSED {
        return Ok(());
    }
    let (what, help) = if worst < -COLLAPSED {
        (
            "negative",
            "its nodes are in the wrong order or it is folded over",
        )
    } else {
        (
            "collapsed",
            "two of its nodes coincide or an angle is 180 degrees",
        )
    };
    Err(MeshError::new(format!(
        "cell {} ({kind}) has a {what} Jacobian: {worst} of that of a right-angled cell with its edges",
        mesh.cell_id(cell),
        worst = figure(worst),
    ))
    .help(format!("{help}; repair the mesh there")))
}

#[cfg(test)]
mod tests {
    use super::super::generators::{Generate, Rectangle};
    use super::*;

    fn grid() -> Mesh {
        let mut mesh = Rectangle::new([0.0, 0.0], [2.0, 1.0], [2, 1])
            .generate()
            .unwrap();
        mesh.point_ids = vec![101, 102, 103, 104, 105, 106];
        mesh.blocks[0].cell_ids = vec![71, 72];
        mesh
    }

    fn message(mesh: &Mesh) -> String {
        check(mesh).unwrap_err().message
    }

    #[test]
    fn a_good_mesh_passes() {
        let mesh = grid();
        check(&mesh).unwrap();
        assert!(unused_points(&mesh).is_empty());
    }

    #[test]
    fn findings_name_the_point_or_cell_of_the_user() {
        let mut mesh = grid();
        mesh.points[2][1] = f64::NAN;
        assert!(message(&mesh).contains("point 103"), "{}", message(&mesh));

        let mut mesh = grid();
        mesh.points[3][2] = 0.5;
        assert!(message(&mesh).contains("point 104"), "{}", message(&mesh));

        let mut mesh = grid();
        mesh.blocks[0].connectivity[4..].reverse();
        assert!(message(&mesh).contains("cell 72 (quad4) has a negative"));

        let mut mesh = grid();
        mesh.blocks[0].connectivity[5] = mesh.blocks[0].connectivity[4];
        assert!(message(&mesh).contains("cell 72 (quad4) has a collapsed"));

        let mut mesh = grid();
        mesh.blocks[0].connectivity[1] = 6;
        assert!(message(&mesh).contains("cell 71"));
    }

    #[test]
    fn structure_is_checked() {
        let mut mesh = grid();
        mesh.point_sets.insert("tip".into(), vec![9]);
        assert!(message(&mesh).contains("\"tip\""));

        let mut mesh = grid();
        mesh.blocks[0].cell_ids.pop();
        assert!(message(&mesh).contains("lists 8 nodes"));

        let mut mesh = grid();
        let twin = mesh.blocks[0].clone();
        mesh.blocks.push(twin);
        assert!(message(&mesh).contains("share one face"));

        assert!(
            check(&Mesh {
                dim: 2,
                ..Mesh::default()
            })
            .is_err()
        );
        assert!(check(&Mesh::default()).is_err());
    }

    #[test]
    fn unused_points_are_listed_not_refused() {
        let mut mesh = grid();
        mesh.points.push([7.0, 7.0, 0.0]);
        mesh.point_ids.push(1);
        check(&mesh).unwrap();
        assert_eq!(unused_points(&mesh), [6]);
    }

    #[test]
    fn flat_cells_are_not_collapsed() {
        let mesh = Rectangle::new([0.0, 0.0], [1.0, 1e-7], [1, 1])
            .generate()
            .unwrap();
        check(&mesh).unwrap();
    }
}
