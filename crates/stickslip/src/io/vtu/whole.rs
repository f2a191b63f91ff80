//! Whole grids as they are: cells of any type, and all data.

use std::collections::BTreeMap;
use std::path::Path;

use crate::error::{Error, IoError};
use crate::shape::ElementKind;

use super::array::Array;
use super::kinds;
use super::read::{GRID, Outline, Piece, PointArray, PointFields, outline};

/// A whole unstructured grid: points, cells, and the data on both.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Grid {
    /// The points and their data.
    pub points: PointFields,
    /// The type of each cell, as VTK numbers them: 5 a triangle, 12 a hexahedron.
    pub types: Vec<u8>,
    /// Where the points of each cell end in `connectivity`, non-decreasing, shape `(cells,)`.
    pub offsets: Vec<usize>,
    /// The points of the cells, one cell after the other; each is less than the number of points.
    pub connectivity: Vec<usize>,
    /// The arrays on cells by name.
    pub cell_arrays: BTreeMap<String, PointArray>,
}

impl Grid {
    /// The points of a cell.
    pub fn cell(&self, i: usize) -> &[usize] {
        let start = if i == 0 { 0 } else { self.offsets[i - 1] };
        &self.connectivity[start..self.offsets[i]]
    }

    /// The element that a cell is, and its points in the order of the element; `None` of one outside of the family.
    pub fn element(&self, i: usize) -> Option<(ElementKind, Vec<usize>)> {
        let points = self.cell(i);
        match kinds::cell(f64::from(self.types[i])) {
            kinds::Cell::Solid(kind, _) if points.len() != kind.reference().nodes().len() => None,
            kinds::Cell::Solid(kind, []) => Some((kind, points.to_vec())),
            kinds::Cell::Solid(kind, order) => {
                Some((kind, order.iter().map(|&k| points[k]).collect()))
            }
            _ => None,
        }
    }
}

/// Reads points, cells and the data on both; the formats are those of [the module](super).
///
/// # Errors
/// As [`read()`](super::read()); also if a cell refers to a point that is not there.
pub fn read_grid(path: &Path) -> Result<Grid, Error> {
    let bytes = crate::io::input::read(path, u64::MAX).map_err(|e| Error::io(path, e))?;
    parse_grid(&bytes).map_err(|message| {
        Error::Io(IoError {
            file: path.to_path_buf(),
            message,
        })
    })
}

pub(super) fn parse_grid(bytes: &[u8]) -> Result<Grid, String> {
    let outline = outline(bytes, GRID)?;
    let mut all = Grid::default();
    for (i, piece) in outline.pieces.iter().enumerate() {
        let next = read_piece(&outline, piece)?;
        if i == 0 {
            all = next;
        } else {
            all.join(next)?;
        }
    }
    Ok(all)
}

fn read_piece(outline: &Outline, piece: &Piece) -> Result<Grid, String> {
    let points = outline.read(piece)?;
    let (offsets, connectivity) = cells(outline, piece, "", piece.cells)?;
    let types = indices(outline, piece, "types", piece.cells)?;
    let types = types
        .into_iter()
        .map(|t| u8::try_from(t).map_err(|_| format!("VTK has no cells of type {t}")))
        .collect::<Result<_, _>>()?;
    let mut cell_arrays = BTreeMap::new();
    for array in &piece.cell_data {
        let values = values(outline, array, piece.cells)?;
        if cell_arrays.insert(array.name.clone(), values).is_some() {
            return Err(format!("a second array `{}`", array.name));
        }
    }
    Ok(Grid {
        points,
        types,
        offsets,
        connectivity,
        cell_arrays,
    })
}

/// The array of indices of this name in the topology of a piece.
fn indices(
    outline: &Outline,
    piece: &Piece,
    name: &str,
    count: usize,
) -> Result<Vec<usize>, String> {
    if count == 0 {
        return Ok(Vec::new());
    }
    let mut known = piece.topology.iter().filter_map(|a| a.as_ref().ok());
    let array = known
        .find(|a| a.name == name)
        .ok_or_else(|| format!("a piece has no array `{name}`"))?;
    if array.components != 1 {
        return Err(format!(
            "array `{name}` has {} components, not 1",
            array.components
        ));
    }
    let values = outline.values(array, count)?;
    values
        .into_iter()
        .map(|v| match v >= 0.0 && v.fract() == 0.0 && v < 9e15 {
            true => Ok(v as usize),
            false => Err(format!(
                "array `{name}` has the value {v}, which is no index"
            )),
        })
        .collect()
}

/// Where the points of each of so many cells end, and these points; `kind` stands before the names of the arrays.
pub(super) fn cells(
    outline: &Outline,
    piece: &Piece,
    kind: &str,
    count: usize,
) -> Result<(Vec<usize>, Vec<usize>), String> {
    let offsets = indices(outline, piece, &format!("{kind}offsets"), count)?;
    if !offsets.is_sorted() {
        return Err(format!("array `{kind}offsets` decreases"));
    }
    let total = offsets.last().copied().unwrap_or(0);
    let connectivity = indices(outline, piece, &format!("{kind}connectivity"), total)?;
    if let Some(wrong) = connectivity.iter().find(|&&p| p >= piece.points) {
        return Err(format!(
            "a cell refers to point {wrong}, and there are {}",
            piece.points
        ));
    }
    Ok((offsets, connectivity))
}

pub(super) fn values(outline: &Outline, array: &Array, count: usize) -> Result<PointArray, String> {
    Ok(PointArray {
        components: array.components,
        values: outline.values(array, count)?,
    })
}

impl Grid {
    /// Appends another piece, which has to have the same arrays.
    fn join(&mut self, mut other: Grid) -> Result<(), String> {
        let (points, entries) = (self.points.points.len(), self.connectivity.len());
        self.connectivity
            .extend(other.connectivity.iter().map(|p| p + points));
        self.offsets
            .extend(other.offsets.iter().map(|end| end + entries));
        self.types.append(&mut other.types);
        for (name, array) in &mut self.cell_arrays {
            let more = other.cell_arrays.remove(name);
            let mut more = more
                .filter(|more| more.components == array.components)
                .ok_or_else(|| format!("array `{name}` is not the same in all pieces"))?;
            array.values.append(&mut more.values);
        }
        if let Some(name) = other.cell_arrays.keys().next() {
            return Err(format!("array `{name}` is not in all pieces"));
        }
        if points == 0 {
            self.points = other.points;
            return Ok(());
        }
        if other.points.points.is_empty() {
            return Ok(());
        }
        self.points.join(other.points)
    }
}
