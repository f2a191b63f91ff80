//! Meshes from meshes: several bodies in one, a part of one.

use std::ops::Range;

use super::{Block, CellRef, FacetRef, Mesh};
use crate::error::MeshError;

/// Where [`append`] put the points and blocks of the other mesh.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Appended {
    /// Positions of its points.
    pub points: Range<usize>,
    /// Positions of its blocks.
    pub blocks: Range<usize>,
}

/// Appends another mesh: its points and blocks follow, its sets are renamed `prefix.name` (or keep their names
/// if `prefix` is empty), and the numbers of the user stay as they are. An empty `mesh` takes its dimension.
///
/// # Errors
/// If the dimensions differ or a renamed set exists already; `mesh` is then unchanged.
pub fn append(mesh: &mut Mesh, other: &Mesh, prefix: &str) -> Result<Appended, MeshError> {
    if mesh.points.is_empty() && mesh.blocks.is_empty() {
        mesh.dim = other.dim;
    } else if mesh.dim != other.dim {
        return Err(MeshError::new(format!(
            "a {}D mesh cannot be joined to a {}D mesh",
            other.dim, mesh.dim
        ))
        .help("all bodies of a problem have the same dimension"));
    }
    let rename = |name: &String| {
        if prefix.is_empty() {
            name.clone()
        } else {
            format!("{prefix}.{name}")
        }
    };
    let taken = other
        .point_sets
        .keys()
        .find(|&n| mesh.point_sets.contains_key(&rename(n)))
        .or_else(|| {
            other
                .cell_sets
                .keys()
                .find(|&n| mesh.cell_sets.contains_key(&rename(n)))
        })
        .or_else(|| {
            other
                .facet_sets
                .keys()
                .find(|&n| mesh.facet_sets.contains_key(&rename(n)))
        });
    if let Some(name) = taken {
        return Err(
            MeshError::new(format!("there are two sets named \"{}\"", rename(name)))
                .help("append each mesh under a name of its own"),
        );
    }

    let (point, block) = (mesh.points.len(), mesh.blocks.len());
    let cell = |c: &CellRef| CellRef {
        block: c.block + block,
        cell: c.cell,
    };
    let facet = |f: &FacetRef| FacetRef {
        cell: cell(&f.cell),
        face: f.face,
    };
    mesh.points.extend_from_slice(&other.points);
    mesh.point_ids.extend_from_slice(&other.point_ids);
    mesh.blocks.extend(other.blocks.iter().map(|b| Block {
        connectivity: b.connectivity.iter().map(|p| p + point).collect(),
        ..b.clone()
    }));
    for (name, points) in &other.point_sets {
        let moved = points.iter().map(|p| p + point).collect();
        mesh.point_sets.insert(rename(name), moved);
    }
    for (name, cells) in &other.cell_sets {
        mesh.cell_sets
            .insert(rename(name), cells.iter().map(cell).collect());
    }
    for (name, facets) in &other.facet_sets {
        mesh.facet_sets
            .insert(rename(name), facets.iter().map(facet).collect());
    }
    Ok(Appended {
        points: point..mesh.points.len(),
        blocks: block..mesh.blocks.len(),
    })
}

/// The mesh of some of the cells, in the order of this mesh, with their points and the parts of the sets that
/// remain; sets of which nothing remains are left out. The numbers of the user are kept.
pub fn extract(mesh: &Mesh, cells: &[CellRef]) -> Mesh {
    let mut cells = cells.to_vec();
    cells.sort_unstable();
    cells.dedup();
    let points = mesh.points_of_cells(&cells);
    let new_point = |p: &usize| points.binary_search(p).ok();

    let mut blocks: Vec<Block> = Vec::new();
    let mut new_cells: Vec<CellRef> = Vec::with_capacity(cells.len());
    for group in cells.chunk_by(|a, b| a.block == b.block) {
        let old = &mesh.blocks[group[0].block];
        new_cells.extend((0..group.len()).map(|cell| CellRef {
            block: blocks.len(),
            cell,
        }));
        blocks.push(Block {
            kind: old.kind,
            connectivity: group
                .iter()
                .flat_map(|&c| mesh.cell_points(c).iter().filter_map(new_point))
                .collect(),
            cell_ids: group.iter().map(|c| old.cell_ids[c.cell]).collect(),
        });
    }
    let new_cell = |c: &CellRef| cells.binary_search(c).ok().map(|i| new_cells[i]);
    let new_facet = |f: &FacetRef| new_cell(&f.cell).map(|cell| FacetRef { cell, face: f.face });
    Mesh {
        dim: mesh.dim,
        points: points.iter().map(|&p| mesh.points[p]).collect(),
        point_ids: points.iter().map(|&p| mesh.point_ids[p]).collect(),
        blocks,
        point_sets: part_of(&mesh.point_sets, new_point),
        cell_sets: part_of(&mesh.cell_sets, new_cell),
        facet_sets: part_of(&mesh.facet_sets, new_facet),
    }
}

type Sets<T> = std::collections::BTreeMap<String, Vec<T>>;

fn part_of<T>(sets: &Sets<T>, new: impl Fn(&T) -> Option<T>) -> Sets<T> {
    sets.iter()
        .map(|(name, members)| {
            (
                name.clone(),
                members.iter().filter_map(&new).collect::<Vec<T>>(),
            )
        })
        .filter(|(_, members)| !members.is_empty())
        .collect()
}

#[cfg(test)]
mod tests {
    use super::super::generators::{Generate, Rectangle};
    use super::*;
    use crate::mesh::check;
    use crate::mesh::geometry;

    #[test]
    fn parts_of_a_joined_mesh_are_the_originals() {
        let lower = Rectangle::new([0.0, 0.0], [2.0, 1.0], [2, 3])
            .generate()
            .unwrap();
        let upper = Rectangle::new([0.0, 1.0], [2.0, 2.0], [3, 2])
            .generate()
            .unwrap();
        let mut both = Mesh::default();
        append(&mut both, &lower, "lower").unwrap();
        let place = append(&mut both, &upper, "upper").unwrap();
        check::check(&both).unwrap();
        assert_eq!(place.points, lower.points.len()..both.points.len());
        assert_eq!(place.blocks, 1..2);
        assert!((geometry::measure(&both) - 4.0).abs() < 1e-14);
        let tops = both.facet_set_points("upper.top").unwrap();
        assert!(tops.iter().all(|&p| both.points[p][1] == 2.0));

        let cells: Vec<CellRef> = both.cells().filter(|c| c.block == 1).collect();
        let mut part = extract(&both, &cells);
        assert_eq!(part.points, upper.points);
        assert_eq!(part.point_ids, upper.point_ids);
        assert_eq!(part.blocks, upper.blocks);
        part.facet_sets = part
            .facet_sets
            .into_iter()
            .map(|(name, facets)| (name.replace("upper.", ""), facets))
            .collect();
        assert_eq!(part.facet_sets, upper.facet_sets);
    }

    #[test]
    fn a_part_keeps_the_numbers_and_drops_what_is_gone() {
        let mesh = Rectangle::new([0.0, 0.0], [3.0, 1.0], [3, 1])
            .generate()
            .unwrap();
        let last = CellRef { block: 0, cell: 2 };
        let part = extract(&mesh, &[last, last]);
        check::check(&part).unwrap();
        assert_eq!(part.cell_count(), 1);
        assert_eq!(part.blocks[0].cell_ids, [mesh.blocks[0].cell_ids[2]]);
        assert!(part.facet_sets.contains_key("right") && !part.facet_sets.contains_key("left"));
        assert!(extract(&mesh, &[]).blocks.is_empty());
    }

    #[test]
    fn dimensions_and_names_must_fit() {
        let mesh = Rectangle::new([0.0, 0.0], [1.0, 1.0], [1, 1])
            .generate()
            .unwrap();
        let mut twice = Mesh::default();
        append(&mut twice, &mesh, "a").unwrap();
        let before = twice.clone();
        assert!(
            append(&mut twice, &mesh, "a")
                .unwrap_err()
                .message
                .contains("a.")
        );
        assert!(
            append(
                &mut twice,
                &Mesh {
                    dim: 3,
                    ..Mesh::default()
                },
                "b"
            )
            .is_err()
        );
        assert_eq!(twice, before);
    }
}
