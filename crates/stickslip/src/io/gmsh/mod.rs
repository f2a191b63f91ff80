//! Reader for Gmsh meshes: `.msh` 2.2 and 4.1, ASCII and binary of either byte order
//! (Gmsh reference manual, *MSH file format*); and a writer of version 4.1, ASCII.
//!
//! What becomes of the file:
//!
//! - The mesh is three-dimensional if it has volume elements, otherwise two-dimensional: then all its nodes must lie in a
//!   plane of constant `z`, which is set to zero.
//! - Elements of the dimension of the mesh become cells, one block a kind, in the order of the file. Elements of lower
//!   dimension only serve their physical groups.
//! - A physical group of the dimension of the mesh becomes a cell set. One of a dimension less becomes a facet set: each
//!   of its elements is matched to the face of a cell with the same nodes. Every group becomes a point set as well.
//!   Where groups of several dimensions share a name, the point set is that of the lowest dimension.
//! - A facet inside the mesh belongs to two cells. The one chosen is the cell it points *out* of, by the orientation of the
//!   element in the group (a curve in 2D has the cell on its left), so `Physical Surface("a") = {-5}` chooses the other.
//! - A group whose elements are no faces at all (a sheet beside the bodies) gives no facet set; a group of which only a
//!   part are faces is refused.
//! - Groups without a name are called `physical-<tag>`.
//! - Nodes that no cell uses are dropped. Node and element numbers survive as `point_ids` and `cell_ids`.
//! - In two dimensions a surface all of whose cells run clockwise is turned over: its side has no meaning in the plane.
//!   One that mixes both is left for the check of Jacobians.
//!
//! Elements saved several times because they are in several groups (which 2.2 does) are read once, under their first
//! number. Sections other than the mesh are skipped. Note that Gmsh itself leaves the groups out of a 2.2 file when
//! `Mesh.SaveAll` is set, and that partitioning adds groups without a name to a 4.1 file.

mod build;
mod cursor;
mod facets;
mod kinds;
mod raw;
mod v2;
mod v4;
mod write;

#[cfg(test)]
mod tests;

pub use write::{text, write};

pub(super) use build::turned;
pub(super) use facets::Faces;

use std::path::Path;

use crate::error::MeshError;
use crate::mesh::Mesh;

use cursor::{Cursor, Mode};
use raw::Raw;

/// Reads the mesh file at `path`.
///
/// # Errors
/// A file that cannot be opened, and everything [`parse`] refuses.
pub fn read(path: &Path) -> Result<Mesh, MeshError> {
    let bytes = crate::io::input::read(path, u64::MAX).map_err(|e| MeshError {
        file: Some(path.to_path_buf()),
        line: None,
        message: format!("the mesh cannot be read: {e}"),
        help: Some("paths of meshes are relative to the problem file".into()),
    })?;
    parse(&bytes, path)
}

/// Reads a mesh from the bytes of a file; `path` is for messages only.
///
/// # Errors
/// Other versions of the format, truncated or malformed sections, counts that exceed the file, coordinates that are not
/// finite, elements on unknown nodes, elements outside the family, a mesh without cells or a surface mesh that is not
/// planar. Each names the line (ASCII) or byte (binary) and what to do.
pub fn parse(bytes: &[u8], path: &Path) -> Result<Mesh, MeshError> {
    let mut cursor = Cursor::new(bytes, path);
    let version = header(&mut cursor)?;
    let mut raw = Raw::default();
    let mut seen = Vec::new();
    while let Some(section) = cursor.section()? {
        if matches!(section, "Nodes" | "Elements") {
            if seen.contains(&section) {
                return Err(cursor
                    .error(format!("a second ${section} section"))
                    .help("a file holds one mesh: save one mesh a file"));
            }
            seen.push(section);
        }
        match (section, version) {
            ("PhysicalNames", _) => physical_names(&mut cursor, &mut raw)?,
            ("Nodes", Version::V2) => v2::nodes(&mut cursor, &mut raw)?,
            ("Elements", Version::V2) => v2::elements(&mut cursor, &mut raw)?,
            ("Entities", Version::V4) => v4::entities(&mut cursor, &mut raw)?,
            ("PartitionedEntities", Version::V4) => v4::partitioned(&mut cursor, &mut raw)?,
            ("Nodes", Version::V4) => v4::nodes(&mut cursor, &mut raw)?,
            ("Elements", Version::V4) => v4::elements(&mut cursor, &mut raw)?,
            ("ParametricNodes", Version::V2) => {
                return Err(cursor
                    .error("nodes with parameters ($ParametricNodes) are not read in version 2.2")
                    .help("set Mesh.SaveParametric = 0, or save with -format msh41"));
            }
            _ => {
                cursor.skip_section(section)?;
                continue;
            }
        }
        cursor.end_section(section)?;
    }
    for needed in ["Nodes", "Elements"] {
        if !seen.contains(&needed) {
            return Err(cursor
                .error(format!("the file ends without a ${needed} section"))
                .help("the file is truncated or holds no mesh: save it again with Gmsh"));
        }
    }
    build::mesh(raw, &cursor)
}

/// The two formats that are read.
#[derive(Clone, Copy)]
enum Version {
    V2,
    V4,
}

const RESAVE: &str =
    "convert it with Gmsh: gmsh old.msh -save -format msh41 -o new.msh (or -format msh22)";

fn header(cursor: &mut Cursor) -> Result<Version, MeshError> {
    match cursor.section() {
        Ok(Some("MeshFormat")) => {}
        Ok(Some("NOD")) => {
            return Err(cursor
                .error("version 1 of the Gmsh format is not read")
                .help(RESAVE));
        }
        _ => {
            return Err(cursor
                .error("this is not a Gmsh mesh: it does not begin with $MeshFormat")
                .help("meshes are read from Gmsh .msh files of version 2.2 or 4.1"));
        }
    }
    let word = cursor.word("the version of the format")?;
    let version = match word {
        "2.2" => Version::V2,
        "4.1" => Version::V4,
        other => {
            return Err(cursor
                .error(format!(
                    "version {other} of the Gmsh format is not read; 2.2 and 4.1 are"
                ))
                .help(RESAVE));
        }
    };
    let binary = match cursor.word("the file type")? {
        "0" => false,
        "1" => true,
        other => {
            return Err(cursor
                .error(format!(
                    "the file type is {other}, not 0 (ASCII) or 1 (binary)"
                ))
                .help("the file is damaged: save it again with Gmsh"));
        }
    };
    let size = cursor.word("the size of numbers")?;
    if size != "8" {
        return Err(cursor
            .error(format!("numbers of {size} bytes are not read, only of 8"))
            .help(RESAVE));
    }
    if binary {
        cursor.rest_of_line();
        let at = cursor.position();
        let mark = cursor.array::<4>("the byte order mark")?;
        cursor.mode = if mark == 1i32.to_le_bytes() {
            Mode::Little
        } else if mark == 1i32.to_be_bytes() {
            Mode::Big
        } else {
            return Err(cursor
                .error_at(at, "the byte order mark is not the integer 1")
                .help("the file was damaged, perhaps by a transfer in text mode"));
        };
    }
    cursor.end_section("MeshFormat")?;
    Ok(version)
}

/// `$PhysicalNames`, which is text in binary files too: a count, then `dimension tag "name"` a line.
fn physical_names(cursor: &mut Cursor, raw: &mut Raw) -> Result<(), MeshError> {
    let count = cursor.text_count("the number of physical names")?;
    cursor.rest_of_line();
    for _ in 0..count {
        let at = cursor.position();
        let line = cursor.rest_of_line();
        let parsed = line.split_once('"').and_then(|(numbers, rest)| {
            let mut numbers = numbers.split_whitespace();
            let dim: usize = numbers.next()?.parse().ok()?;
            let tag: i64 = numbers.next()?.parse().ok()?;
            let (name, _) = rest.rsplit_once('"')?;
            Some((dim, tag, name))
        });
        match parsed {
            Some((dim, tag, name)) if !name.is_empty() => {
                raw.names.insert((dim, tag), name.to_string());
            }
            _ => {
                return Err(cursor
                    .error_at(at, "a physical name should read: dimension tag \"name\"")
                    .help(
                        "check the count at the top of $PhysicalNames, and that no name is empty",
                    ));
            }
        }
    }
    Ok(())
}
