use std::collections::BTreeSet;
use std::fmt::Write;
use std::path::Path;

use crate::error::{Error, MeshError};
use crate::io::numbers::Numbers;
use crate::io::write_atomically;
use crate::mesh::{Mesh, check};
use crate::shape::ElementKind;

use super::faces::face_number;
use super::types::Space;

/// Entries a line: more are not allowed in data lines.
const ENTRIES_A_LINE: usize = 16;

/// Characters of a number that CalculiX reads.
const NUMBER_WIDTH: usize = 20;

/// Characters of a name.
const LABEL: usize = 80;

/// Writes a mesh to an input file and returns notes; see [`text`].
///
/// # Errors
/// [`Error::Mesh`] if [`text`] refuses the mesh, [`Error::Io`] if the file cannot be written.
pub fn write(path: &Path, mesh: &Mesh, plane: Space) -> Result<Vec<String>, Error> {
    let (text, notes) = text(mesh, plane)?;
    write_atomically(path, text.as_bytes())?;
    Ok(notes)
}

/// A mesh as part of an input file, and notes about what was changed: `*NODE`, an `*ELEMENT` for each block, `*NSET`, `*ELSET`, and
/// `*SURFACE` for facet sets, which make a `*NSET` as well. Cells of a plane mesh are of the type of the space `plane`, which does not matter in 3D.
///
/// # Errors
/// A mesh whose structure is wrong (see [`check_structure`](crate::mesh::check::check_structure)).
pub fn text(mesh: &Mesh, plane: Space) -> Result<(String, Vec<String>), MeshError> {
    check::check_structure(mesh)?;
    let numbers = Numbers::of(mesh);
    let mut notes = numbers.notes.clone();
    let mut out = String::from("*HEADING\nmesh written by stickslip\n*NODE\n");
    for (id, x) in numbers.points.iter().zip(&mesh.points) {
        let x: Vec<String> = x[..mesh.dim].iter().map(|&x| number(x)).collect();
        let _ = writeln!(out, "{id}, {}", x.join(", "));
    }
    let mut ids = numbers.cells.iter();
    for block in &mesh.blocks {
        let _ = writeln!(out, "*ELEMENT, TYPE={}", type_name(block.kind, plane));
        let cells = block.connectivity.chunks_exact(block.kind.node_count());
        for (id, nodes) in ids.by_ref().zip(cells) {
            let nodes = nodes.iter().map(|&node| numbers.points[node]);
            list(&mut out, std::iter::once(*id).chain(nodes));
        }
    }
    // Cells are numbered over all blocks.
    let mut first = Vec::new();
    let mut count = 0;
    for block in &mesh.blocks {
        first.push(count);
        count += block.cell_ids.len();
    }
    let id = |cell: crate::mesh::CellRef| numbers.cells[first[cell.block] + cell.cell];

    let mut names = Names::new("node set");
    for (name, points) in &mesh.point_sets {
        let _ = writeln!(out, "*NSET, NSET={}", names.label(name, &mut notes));
        list_all(&mut out, points.iter().map(|&p| numbers.points[p]));
    }
    // Supports and loads on nodes need a node set where readers of other formats make one.
    for (name, facets) in &mesh.facet_sets {
        if !mesh.point_sets.contains_key(name) {
            let _ = writeln!(out, "*NSET, NSET={}", names.label(name, &mut Vec::new()));
            let points = mesh.points_of_facets(facets);
            list_all(&mut out, points.iter().map(|&p| numbers.points[p]));
        }
    }
    let mut names = Names::new("element set");
    for (name, cells) in &mesh.cell_sets {
        let _ = writeln!(out, "*ELSET, ELSET={}", names.label(name, &mut notes));
        list_all(&mut out, cells.iter().map(|&cell| id(cell)));
    }
    let mut names = Names::new("surface");
    for (name, facets) in &mesh.facet_sets {
        let label = names.label(name, &mut notes);
        let _ = writeln!(out, "*SURFACE, NAME={label}, TYPE=ELEMENT");
        for facet in facets {
            let face = face_number(mesh.cell_kind(facet.cell), facet.face).ok_or_else(|| {
                MeshError::new(format!(
                    "the set \"{name}\" names a face that has no number"
                ))
                .help("make the set from the mesh it belongs to")
            })?;
            let _ = writeln!(out, "{}, S{face}", id(facet.cell));
        }
    }
    Ok((out, notes))
}

/// The element type of a kind.
fn type_name(kind: ElementKind, plane: Space) -> String {
    let family = match (kind.dim(), plane) {
        (3, _) => "C3D",
        (_, Space::PlaneStress) => "CPS",
        (_, Space::Axisymmetric) => "CAX",
        (_, Space::PlaneStrain | Space::Solid) => "CPE",
    };
    format!("{family}{}", kind.node_count())
}

/// A number in no more characters than are read: the shortest text of the same number, or as many digits as fit.
fn number(x: f64) -> String {
    let exact = format!("{x:?}");
    if exact.len() <= NUMBER_WIDTH {
        return exact;
    }
    let fits = (0..=16)
        .rev()
        .map(|digits| format!("{x:.digits$e}"))
        .find(|text| text.len() <= NUMBER_WIDTH);
    fits.unwrap_or(exact)
}

/// One record: lines of a record that goes on end with a comma.
fn list(out: &mut String, numbers: impl Iterator<Item = u64>) {
    let words: Vec<String> = numbers.map(|n| n.to_string()).collect();
    let lines: Vec<String> = words
        .chunks(ENTRIES_A_LINE)
        .map(|line| line.join(", "))
        .collect();
    out.push_str(&lines.join(",\n"));
    out.push('\n');
}

/// Members of a set: each line is a record of its own.
fn list_all(out: &mut String, numbers: impl Iterator<Item = u64>) {
    let words: Vec<String> = numbers.map(|n| n.to_string()).collect();
    for line in words.chunks(ENTRIES_A_LINE) {
        let _ = writeln!(out, "{}", line.join(", "));
    }
}

/// The labels of one kind of set: case does not distinguish them.
struct Names {
    what: &'static str,
    taken: BTreeSet<String>,
}

impl Names {
    fn new(what: &'static str) -> Names {
        Names {
            what,
            taken: BTreeSet::new(),
        }
    }

    fn label(&mut self, name: &str, notes: &mut Vec<String>) -> String {
        let plain = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '-' | '.');
        let mut label: String = name
            .chars()
            .map(|c| if plain(c) { c } else { '_' })
            .take(LABEL - 4)
            .collect();
        // A label begins with a letter.
        if !label.starts_with(|c: char| c.is_ascii_alphabetic()) {
            label.insert_str(0, "S_");
        }
        let stem = label.clone();
        let mut copy = 1;
        while !self.taken.insert(label.to_ascii_uppercase()) {
            copy += 1;
            label = format!("{stem}_{copy}");
        }
        if label != name {
            notes.push(format!("the {} {name:?} is written as {label}", self.what));
        }
        label
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::generators::{Cuboid, Generate, Rectangle};

    #[test]
    fn a_plane_mesh_is_written_line_by_line() {
        let mut mesh = Rectangle::new([0.0, 0.0], [2.0, 1.0], [2, 1])
            .generate()
            .unwrap();
        mesh.point_sets = [("tip".to_string(), vec![5])].into();
        mesh.facet_sets
            .retain(|name, _| name == "top" || name == "right");
        let cells = mesh.cells().collect();
        mesh.cell_sets = [("all cells".to_string(), cells)].into();
        let (text, notes) = text(&mesh, Space::PlaneStrain).unwrap();
        let expected = "*HEADING\nmesh written by stickslip\n*NODE\n\
            1, 0.0, 0.0\n2, 1.0, 0.0\n3, 2.0, 0.0\n4, 0.0, 1.0\n5, 1.0, 1.0\n6, 2.0, 1.0\n\
            *ELEMENT, TYPE=CPE4\n1, 1, 2, 5, 4\n2, 2, 3, 6, 5\n\
            *NSET, NSET=tip\n6\n*NSET, NSET=right\n3, 6\n*NSET, NSET=top\n4, 5, 6\n\
            *ELSET, ELSET=all_cells\n1, 2\n\
            *SURFACE, NAME=right, TYPE=ELEMENT\n2, S2\n\
            *SURFACE, NAME=top, TYPE=ELEMENT\n1, S3\n2, S3\n";
        assert_eq!(text, expected);
        assert_eq!(
            notes,
            ["the element set \"all cells\" is written as all_cells"]
        );
    }

    #[test]
    fn long_records_go_on_with_a_comma() {
        let mut out = String::new();
        list(&mut out, 1..=21);
        assert!(out.contains("15, 16,\n17, 18"), "{out}");
        let mesh = Cuboid::new([0.0; 3], [1.0; 3], [1; 3]).generate().unwrap();
        let (text, _) = text(&mesh, Space::Solid).unwrap();
        assert!(
            text.contains("*ELEMENT, TYPE=C3D8\n1, 1, 2, 4, 3, 5, 6, 8, 7\n"),
            "{text}"
        );
    }

    #[test]
    fn numbers_fit_the_columns_of_calculix() {
        for x in [1.0 / 3.0, -1.0 / 3.0e-7, -1e-300 / 3.0, 1e22, -0.1, 0.0] {
            let text = number(x);
            assert!(text.len() <= 20, "{text}");
            let back: f64 = text.parse().unwrap();
            assert!((back - x).abs() <= 1e-12 * x.abs(), "{text}");
        }
    }

    #[test]
    fn labels_are_distinct_in_any_case() {
        let mut names = Names::new("surface");
        let mut notes = Vec::new();
        let labels: Vec<String> = ["Top", "top", "a.b", "1", "ä"]
            .map(|name| names.label(name, &mut notes))
            .into();
        assert_eq!(labels, ["Top", "top_2", "a.b", "S_1", "S__"]);
        assert_eq!(notes.len(), 3);
    }
}
