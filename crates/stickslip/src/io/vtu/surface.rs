//! Surfaces with data on their points: PolyData (`.vtp`), written, and read back as a grid.

use std::path::Path;

use super::read::{KINDS, SURFACE, outline};
use super::whole::{Grid, cells, values};
use super::write::{Array, Writer};
use crate::error::{Error, IoError};
use crate::io::write_atomically;
use crate::math::Vec3;
use crate::shape::ElementKind;
use crate::system::Fields;

/// A surface: lines in a plane, triangles and quadrilaterals in space; points alone where it has no faces.
#[derive(Debug, Clone, Copy)]
pub struct Surface<'a> {
    /// Coordinates, shape `(n, 3)` `[length]`.
    pub points: &'a [Vec3],
    /// Number of the node at each point.
    pub nodes: &'a [u64],
    /// Its faces. Quadratic ones are written as what they are made of between their nodes, since PolyData are linear.
    pub faces: &'a [(ElementKind, Vec<usize>)],
    /// Number of the cell beneath each face.
    pub cells: &'a [u64],
    /// Fields at the points.
    pub fields: &'a Fields,
}

/// The linear pieces of a face, as positions among its nodes.
fn pieces(kind: ElementKind) -> &'static [&'static [usize]] {
    match kind {
        ElementKind::Line2 => &[&[0, 1]],
        ElementKind::Line3 => &[&[0, 2], &[2, 1]],
        ElementKind::Tri3 => &[&[0, 1, 2]],
        ElementKind::Tri6 => &[&[0, 3, 5], &[3, 1, 4], &[5, 4, 2], &[3, 4, 5]],
        ElementKind::Quad8 => &[
            &[0, 4, 7],
            &[4, 1, 5],
            &[5, 2, 6],
            &[6, 3, 7],
            &[4, 5, 6, 7],
        ],
        _ => &[&[0, 1, 2, 3]],
    }
}

/// Cells of one of the three kinds: all their points, where each ends, and the number of the face each is of.
#[derive(Default)]
struct Cells {
    connectivity: Vec<i64>,
    offsets: Vec<i64>,
    of: Vec<i64>,
}

impl Cells {
    fn push(&mut self, points: impl Iterator<Item = usize>, of: i64) {
        self.connectivity.extend(points.map(|p| p as i64));
        self.offsets.push(self.connectivity.len() as i64);
        self.of.push(of);
    }
}

/// Writes a surface: at the points `NODE_ID` and the fields, on the faces `ELEMENT_ID`, the number of the cell beneath.
///
/// # Errors
/// [`Error::Io`] if the file cannot be written or the length of a field does not fit the points.
pub fn write_surface(path: &Path, surface: &Surface) -> Result<(), Error> {
    let count = surface.points.len();
    let fields = &surface.fields.all;
    if let Some(field) = (fields.iter()).find(|f| f.values.len() != count * f.components) {
        return Err(Error::Io(IoError {
            file: path.to_path_buf(),
            message: format!(
                "field {} has {} values where the surface has {count} points",
                field.name,
                field.values.len()
            ),
        }));
    }
    let (mut points, mut lines, mut faces) = (Cells::default(), Cells::default(), Cells::default());
    if surface.faces.is_empty() {
        (0..count).for_each(|p| points.push(std::iter::once(p), 0));
    }
    for ((kind, nodes), &cell) in surface.faces.iter().zip(surface.cells) {
        let to = if kind.dim() == 1 {
            &mut lines
        } else {
            &mut faces
        };
        for piece in pieces(*kind) {
            to.push(piece.iter().map(|&i| nodes[i]), cell as i64);
        }
    }
    let kinds = [("Verts", points), ("Lines", lines), ("Polys", faces)];
    let mut file = Writer::default();
    let counts = kinds.each_ref().map(|(_, cells)| cells.of.len());
    file.begin_surface(count, counts);
    file.text += "<PointData>\n";
    file.add(&Array::integers(
        "NODE_ID",
        surface.nodes.iter().map(|&id| id as i64),
    ));
    for field in fields {
        file.add(&Array::floats(&field.name, field.components, &field.values));
    }
    file.text += "</PointData>\n<CellData>\n";
    let of = kinds.iter().flat_map(|(_, cells)| cells.of.iter().copied());
    file.add(&Array::integers("ELEMENT_ID", of));
    file.text += "</CellData>\n<Points>\n";
    file.add(&Array::floats("Points", 3, surface.points.as_flattened()));
    file.text += "</Points>\n";
    for (name, cells) in kinds {
        file.text += &format!("<{name}>\n");
        file.add(&Array::integers(
            "connectivity",
            cells.connectivity.into_iter(),
        ));
        file.add(&Array::integers("offsets", cells.offsets.into_iter()));
        file.text += &format!("</{name}>\n");
    }
    write_atomically(path, &file.end_surface())
}

/// Reads a surface that [`write_surface`] wrote, as a grid of vertices, lines, triangles and quadrilaterals.
///
/// # Errors
/// As [`read()`](super::read()).
pub fn read_surface(path: &Path) -> Result<Grid, Error> {
    let bytes = crate::io::input::read(path, u64::MAX).map_err(|e| Error::io(path, e))?;
    parse_surface(&bytes).map_err(|message| {
        Error::Io(IoError {
            file: path.to_path_buf(),
            message,
        })
    })
}

pub(super) fn parse_surface(bytes: &[u8]) -> Result<Grid, String> {
    let outline = outline(bytes, SURFACE)?;
    let [piece] = outline.pieces.as_slice() else {
        return Err(format!(
            "the surface has {} pieces; only one is read",
            outline.pieces.len()
        ));
    };
    let mut grid = Grid {
        points: outline.read(piece)?,
        ..Grid::default()
    };
    for (kind, count) in KINDS.iter().zip(piece.faces) {
        let (offsets, connectivity) = cells(&outline, piece, &format!("{kind}/"), count)?;
        let mut start = 0;
        for &end in &offsets {
            grid.types.push(match end - start {
                1 => 1,
                2 => 3,
                3 => 5,
                4 => 9,
                n => {
                    return Err(format!(
                        "a face has {n} corners; those of three and four are read"
                    ));
                }
            });
            start = end;
        }
        let before = grid.connectivity.len();
        grid.offsets.extend(offsets.iter().map(|end| end + before));
        grid.connectivity.extend(connectivity);
    }
    for array in &piece.cell_data {
        let values = values(&outline, array, grid.types.len())?;
        grid.cell_arrays.insert(array.name.clone(), values);
    }
    Ok(grid)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::system::{Field, Location};

    #[test]
    fn a_surface_reads_back_as_it_was_written() {
        let points: Vec<Vec3> = (0..9)
            .map(|i| [f64::from(i), 0.5, 1e-9 * f64::from(i)])
            .collect();
        let fields = Fields {
            all: vec![
                Field {
                    name: "CPRESS".into(),
                    location: Location::Point,
                    components: 1,
                    values: (0..9).map(|i| 0.1 * f64::from(i)).collect(),
                },
                Field {
                    name: "CTRACTION".into(),
                    location: Location::Point,
                    components: 3,
                    values: (0..27)
                        .map(|i| if i == 4 { f64::NAN } else { f64::from(i) })
                        .collect(),
                },
            ],
        };
        let quad8 = (ElementKind::Quad8, (0..8).collect());
        let (line3, tri) = (
            (ElementKind::Line3, vec![0, 2, 1]),
            (ElementKind::Tri3, vec![8, 1, 0]),
        );
        for (faces, types, corners) in [
            (
                vec![quad8, tri.clone()],
                vec![5, 5, 5, 5, 9, 5],
                vec![8, 1, 0],
            ),
            (vec![line3], vec![3, 3], vec![1, 2]),
            (vec![], vec![1; 9], vec![8]),
        ] {
            let name = format!("stickslip-{}-{}.vtp", std::process::id(), types.len());
            let path = std::env::temp_dir().join(name);
            let surface = Surface {
                points: &points,
                nodes: &[7; 9],
                faces: &faces,
                cells: &vec![3; faces.len()],
                fields: &fields,
            };
            write_surface(&path, &surface).unwrap();
            let bytes = std::fs::read(&path).unwrap();
            std::fs::remove_file(&path).unwrap();
            let grid = parse_surface(&bytes).unwrap();
            assert_eq!(grid.points.points, points);
            assert_eq!(grid.types, types);
            let last = grid.types.len() - 1;
            if types[0] == 3 {
                // The second half ends at the second node.
                assert_eq!(grid.cell(0), [0, 1]);
                assert_eq!(grid.cell(last), [1, 2]);
            } else {
                assert_eq!(grid.cell(last), corners);
            }
            let array = &grid.points.arrays["CTRACTION"];
            assert_eq!(array.components, 3);
            let bits = |v: &[f64]| v.iter().map(|v| v.to_bits()).collect::<Vec<u64>>();
            assert_eq!(bits(&array.values), bits(&fields.all[1].values));
            assert_eq!(grid.points.arrays["NODE_ID"].values, [7.0; 9]);
            let grid_only = super::super::whole::parse_grid(&bytes).unwrap_err();
            assert!(grid_only.contains("holds a PolyData"), "{grid_only}");
        }
    }
}
