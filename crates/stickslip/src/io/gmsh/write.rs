//! Writes meshes in version 4.1, as text.
//!
//! Elements of the format lie on geometrical entities, and these are in physical groups. Here an entity stands for a
//! combination of sets: cells, facets or points that are in the same sets share one.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;

use crate::error::{Error, MeshError};
use crate::io::numbers::Numbers;
use crate::io::sets::{memberships, own_point_sets};
use crate::io::write_atomically;
use crate::mesh::{Mesh, check, geometry};
use crate::shape::ElementKind;

use super::kinds::{Kind, kind};

/// Gmsh's number of a point element.
const POINT: i64 = 15;

/// Writes a mesh to a file and returns notes; see [`text`].
///
/// # Errors
/// [`Error::Mesh`] if [`text`] refuses the mesh, [`Error::Io`] if the file cannot be written.
pub fn write(path: &Path, mesh: &Mesh) -> Result<Vec<String>, Error> {
    let (text, notes) = text(mesh)?;
    write_atomically(path, text.as_bytes())?;
    Ok(notes)
}

/// A mesh as a file of version 4.1, and notes about what [`parse`](super::parse) will not give back.
///
/// Points and cells keep their numbers and their order. Cell sets, facet sets and point sets become physical groups of the
/// same names: facets as elements that point out of their cell, numbered behind the cells, and points as point elements. A
/// point set that has the name and the points of a facet or cell set is not written, as readers derive it.
///
/// # Errors
/// A mesh whose structure is wrong (see [`check_structure`](crate::mesh::check::check_structure)).
pub fn text(mesh: &Mesh) -> Result<(String, Vec<String>), MeshError> {
    check::check_structure(mesh)?;
    let numbers = Numbers::of(mesh);
    let mut notes = numbers.notes.clone();
    if !check::unused_points(mesh).is_empty() {
        notes.push(
            "there are points that no cell uses: they are written, but most readers drop them"
                .into(),
        );
    }
    let mut layers: [Layer; 4] = Default::default();
    let groups = memberships(mesh.cell_sets.iter());
    for (cell, &id) in mesh.cells().zip(&numbers.cells) {
        let of_cell = groups.get(&cell).map_or(&[][..], Vec::as_slice);
        let nodes = mesh.cell_points(cell).to_vec();
        layers[mesh.dim].add(Some(mesh.cell_kind(cell)), nodes, id, of_cell);
    }
    let mut id = numbers.next_cell();
    for (facet, groups) in memberships(mesh.facet_sets.iter()) {
        let (kind, nodes) = mesh.facet_points(facet);
        layers[mesh.dim - 1].add(Some(kind), nodes, id, &groups);
        id += 1;
    }
    for (point, groups) in memberships(own_point_sets(mesh)) {
        layers[0].add(None, vec![point], id, &groups);
        id += 1;
    }
    let tags = tags(&layers);
    let mut out = String::from("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n");
    physical_names(&mut out, &tags, &mut notes);
    entities(&mut out, mesh, &layers, &tags);
    nodes(&mut out, mesh, &numbers);
    elements(&mut out, &layers, &numbers);
    Ok((out, notes))
}

/// The elements of one dimension.
#[derive(Default)]
struct Layer<'a> {
    /// The sets that each entity stands for, entity 1 first.
    entities: Vec<Vec<&'a str>>,
    /// Positions in `entities`.
    known: BTreeMap<Vec<&'a str>, usize>,
    elements: Vec<Element>,
}

struct Element {
    /// `None` is a point.
    kind: Option<ElementKind>,
    nodes: Vec<usize>,
    id: u64,
    entity: usize,
}

impl<'a> Layer<'a> {
    fn add(&mut self, kind: Option<ElementKind>, nodes: Vec<usize>, id: u64, groups: &[&'a str]) {
        let entity = match self.known.get(groups) {
            Some(&entity) => entity,
            None => {
                self.entities.push(groups.to_vec());
                self.known.insert(groups.to_vec(), self.entities.len());
                self.entities.len()
            }
        };
        self.elements.push(Element {
            kind,
            nodes,
            id,
            entity,
        });
    }
}

/// The tags of physical groups by dimension and name. No two groups share one, which some readers need.
type Tags<'a> = BTreeMap<(usize, &'a str), usize>;

fn tags<'a>(layers: &[Layer<'a>; 4]) -> Tags<'a> {
    let mut tags = Tags::new();
    for (dim, layer) in layers.iter().enumerate() {
        for &name in layer.entities.iter().flatten() {
            let next = tags.len() + 1;
            tags.entry((dim, name)).or_insert(next);
        }
    }
    tags
}

fn physical_names(out: &mut String, tags: &Tags, notes: &mut Vec<String>) {
    if tags.is_empty() {
        return;
    }
    let _ = writeln!(out, "$PhysicalNames\n{}", tags.len());
    for (&(dim, name), tag) in tags {
        let plain: String = name
            .chars()
            .map(|c| if c == '"' || c.is_control() { '_' } else { c })
            .collect();
        if plain != name {
            notes.push(format!("the set {name:?} is written as {plain:?}"));
        }
        let _ = writeln!(out, "{dim} {tag} \"{plain}\"");
    }
    out.push_str("$EndPhysicalNames\n");
}

/// `tag, bounds, physical tags`; there is no geometry, so that the bounds are those of the mesh.
fn entities(out: &mut String, mesh: &Mesh, layers: &[Layer; 4], tags: &Tags) {
    let (lo, hi) = geometry::bounding_box(mesh).unwrap_or_default();
    let counts: Vec<String> = layers
        .iter()
        .map(|layer| layer.entities.len().to_string())
        .collect();
    let _ = writeln!(out, "$Entities\n{}", counts.join(" "));
    for (dim, layer) in layers.iter().enumerate() {
        for (entity, groups) in (1..).zip(&layer.entities) {
            let _ = write!(out, "{entity}");
            let bounds = if dim == 0 {
                &lo[..]
            } else {
                &[lo, hi].concat()
            };
            for x in bounds {
                let _ = write!(out, " {x:?}");
            }
            let _ = write!(out, " {}", groups.len());
            for &name in groups {
                let _ = write!(out, " {}", tags[&(dim, name)]);
            }
            out.push_str(if dim == 0 { "\n" } else { " 0\n" });
        }
    }
    out.push_str("$EndEntities\n");
}

fn nodes(out: &mut String, mesh: &Mesh, numbers: &Numbers) {
    let count = mesh.points.len();
    let (first, last) = extremes(numbers.points.iter());
    let _ = writeln!(out, "$Nodes\n1 {count} {first} {last}");
    let _ = writeln!(out, "{} 1 0 {count}", mesh.dim);
    for id in &numbers.points {
        let _ = writeln!(out, "{id}");
    }
    for [x, y, z] in &mesh.points {
        // The shortest text that reads back to the same number.
        let _ = writeln!(out, "{x:?} {y:?} {z:?}");
    }
    out.push_str("$EndNodes\n");
}

/// Blocks of elements of one entity and kind that follow each other, so that the order stays.
fn elements(out: &mut String, layers: &[Layer; 4], numbers: &Numbers) {
    let all = || layers.iter().flat_map(|layer| &layer.elements);
    let (first, last) = extremes(all().map(|element| &element.id));
    let same = |a: &Element, b: &Element| a.entity == b.entity && a.kind == b.kind;
    let blocks: usize = layers
        .iter()
        .map(|layer| layer.elements.chunk_by(same).count())
        .sum();
    let _ = writeln!(out, "$Elements\n{blocks} {} {first} {last}", all().count());
    for (dim, layer) in layers.iter().enumerate() {
        for run in layer.elements.chunk_by(same) {
            let (number, order) = gmsh_type(run[0].kind);
            let _ = writeln!(out, "{dim} {} {number} {}", run[0].entity, run.len());
            for element in run {
                let _ = write!(out, "{}", element.id);
                let mut ordered = element.nodes.clone();
                for (&node, &to) in element.nodes.iter().zip(order) {
                    ordered[to] = node;
                }
                for node in ordered {
                    let _ = write!(out, " {}", numbers.points[node]);
                }
                out.push('\n');
            }
        }
    }
    out.push_str("$EndElements\n");
}

fn extremes<'a>(ids: impl Iterator<Item = &'a u64> + Clone) -> (u64, u64) {
    let (low, high) = (ids.clone().min(), ids.max());
    (low.copied().unwrap_or(0), high.copied().unwrap_or(0))
}

/// Gmsh's number of a kind and its node order, from the table of the reader.
fn gmsh_type(wanted: Option<ElementKind>) -> (i64, &'static [usize]) {
    let found = wanted.and_then(|wanted| {
        (1..=20).find_map(|number| match kind(number) {
            Kind::Solid(kind, order) if kind == wanted => Some((number, order)),
            _ => None,
        })
    });
    found.unwrap_or((POINT, &[]))
}

#[cfg(test)]
mod tests {
    use super::super::parse;
    use super::*;
    use crate::mesh::{Block, CellRef};
    use std::path::PathBuf;

    fn again(mesh: &Mesh) -> (Mesh, Vec<String>) {
        let (text, notes) = text(mesh).unwrap();
        (
            parse(text.as_bytes(), Path::new("again.msh")).unwrap(),
            notes,
        )
    }

    #[test]
    fn meshes_of_gmsh_come_back_equal() {
        let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/meshes");
        let mut count = 0;
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_none_or(|e| e != "msh") {
                continue;
            }
            let mesh = super::super::read(&path).unwrap();
            let (found, notes) = again(&mesh);
            assert_eq!(found, mesh, "{}", path.display());
            assert!(notes.is_empty(), "{notes:?}");
            count += 1;
        }
        assert!(count > 10);
    }

    #[test]
    fn every_kind_comes_back_with_sets_that_overlap_and_share_names() {
        for kind in ElementKind::ALL.into_iter().filter(|kind| kind.dim() > 1) {
            let nodes = kind.reference().nodes();
            let count = nodes.len();
            let shift = |i: usize| if i < count { 0.0 } else { 3.0 };
            let mut mesh = Mesh {
                dim: kind.dim(),
                points: (0..2 * count)
                    .map(|i| {
                        let x = nodes[i % count];
                        [x[0] + shift(i), x[1] / 3.0, x[2]]
                    })
                    .collect(),
                point_ids: (0..2 * count as u64).map(|i| 1000 - 7 * i).collect(),
                blocks: vec![Block {
                    kind,
                    connectivity: (0..2 * count).collect(),
                    cell_ids: vec![900, 30],
                }],
                ..Mesh::default()
            };
            let [a, b] = [0, 1].map(|cell| CellRef { block: 0, cell });
            mesh.cell_sets.insert("both".into(), vec![a, b]);
            mesh.cell_sets.insert("second body".into(), vec![b]);
            let boundary = mesh.boundary();
            mesh.facet_sets.insert("skin".into(), boundary.clone());
            mesh.facet_sets
                .insert("both".into(), boundary[..1].to_vec());
            for (name, cells) in mesh.cell_sets.clone() {
                mesh.point_sets.insert(name, mesh.points_of_cells(&cells));
            }
            for (name, facets) in mesh.facet_sets.clone() {
                mesh.point_sets.insert(name, mesh.points_of_facets(&facets));
            }
            mesh.point_sets.insert("tip".into(), vec![0, 2]);
            mesh.point_sets.insert("skin".into(), vec![1]);
            let (found, notes) = again(&mesh);
            assert_eq!(found, mesh, "{kind}");
            assert!(notes.is_empty());
        }
    }

    #[test]
    fn what_cannot_be_kept_is_noted() {
        let mut mesh = crate::mesh::Mesh {
            dim: 2,
            points: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [9.0, 9.0, 0.0]],
            point_ids: vec![1, 1, 2, 3],
            blocks: vec![Block {
                kind: ElementKind::Tri3,
                connectivity: vec![0, 1, 2],
                cell_ids: vec![5],
            }],
            ..Mesh::default()
        };
        mesh.point_sets.insert("a \"b\"".into(), vec![0]);
        let (found, notes) = again(&mesh);
        assert_eq!(found.point_ids, [1, 2, 3]);
        assert_eq!(found.point_sets["a _b_"], [0]);
        assert_eq!(notes.len(), 3, "{notes:?}");
        mesh.blocks[0].connectivity[1] = 17;
        assert!(text(&mesh).is_err());
    }
}
