use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::path::Path;

use crate::error::{Error, IoError};
use crate::math::Vec3;

use super::array::{Appended, Array, attribute, count};
use super::stream::Packing;
use super::xml::{Event, Scanner};

/// The points of a result file and the data on them.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct PointFields {
    /// Coordinates, shape `(n, 3)` `[length]`.
    pub points: Vec<Vec3>,
    /// The arrays by name.
    pub arrays: BTreeMap<String, PointArray>,
}

/// Values on the points of a file.
#[derive(Debug, Clone, PartialEq)]
pub struct PointArray {
    /// Numbers a point.
    pub components: usize,
    /// Values, shape `(n, components)`, in the unit they were written in. Integers of more than 53 bits are rounded.
    pub values: Vec<f64>,
}

/// Reads the points of a file and the data on them; the formats are those of [the module](super).
///
/// # Errors
/// [`Error::Io`] if the file cannot be opened, is truncated or malformed, does not hold what its headers say, or is written
/// in a way that is not read.
pub fn read(path: &Path) -> Result<PointFields, Error> {
    let bytes = std::fs::read(path).map_err(|e| Error::io(path, e))?;
    parse(&bytes).map_err(|message| {
        Error::Io(IoError {
            file: path.to_path_buf(),
            message,
        })
    })
}

/// What the tags of a file say.
pub(super) struct Outline<'a> {
    pub packing: Packing,
    pub pieces: Vec<Piece<'a>>,
    pub appended: Appended<'a>,
}

/// A piece of a grid.
pub(super) struct Piece<'a> {
    pub points: usize,
    coordinates: Option<Array<'a>>,
    data: Vec<Array<'a>>,
    /// Its cells: how many, their arrays and the data on them.
    pub cells: Cells<'a>,
}

/// The cells of a piece; empty where they were not asked for.
#[derive(Default)]
pub(super) struct Cells<'a> {
    pub count: usize,
    pub topology: Vec<Array<'a>>,
    pub data: Vec<Array<'a>>,
}

pub(super) fn parse(bytes: &[u8]) -> Result<PointFields, String> {
    let outline = outline(bytes, false)?;
    let mut all = PointFields::default();
    for piece in &outline.pieces {
        let next = outline.read(piece)?;
        if all.points.is_empty() {
            all = next;
        } else if !next.points.is_empty() {
            all.join(next)?;
        }
    }
    Ok(all)
}

const FOREIGN: &str = "this is no VTK file: it does not begin with <VTKFile>";

const TRUNCATED: &str = "the file is truncated: it does not end with </VTKFile>";

/// The tags of a file. Arrays of cells are looked at only where they are asked for.
pub(super) fn outline(bytes: &[u8], cells: bool) -> Result<Outline<'_>, String> {
    if !bytes.trim_ascii_end().ends_with(b"</VTKFile>") {
        let begun = bytes.windows(8).any(|w| w == b"<VTKFile");
        return Err(if begun { TRUNCATED } else { FOREIGN }.into());
    }
    let mut scanner = Scanner::new(bytes);
    let mut root = None;
    let mut pieces: Vec<Piece> = Vec::new();
    let mut appended = Appended::None;
    while let Some(event) = scanner.next()? {
        let fault = |message: String| scanner.fault(message);
        match (event, scanner.path()) {
            (Event::Open(attributes), ["VTKFile"]) => {
                root = Some(packing(&attributes).map_err(fault)?);
            }
            (Event::Open(_), [_]) | (Event::Text(_), []) => return Err(FOREIGN.into()),
            (Event::Open(attributes), ["VTKFile", "UnstructuredGrid", "Piece"]) => {
                pieces.push(Piece {
                    points: count(&attributes, "NumberOfPoints", None).map_err(fault)?,
                    coordinates: None,
                    data: Vec::new(),
                    cells: Cells {
                        count: match cells {
                            true => count(&attributes, "NumberOfCells", None).map_err(fault)?,
                            false => 0,
                        },
                        ..Cells::default()
                    },
                });
            }
            (
                event,
                [
                    "VTKFile",
                    "UnstructuredGrid",
                    "Piece",
                    section @ ("PointData" | "Points"),
                    "DataArray" | "Array",
                ],
            ) => {
                let Some(piece) = pieces.last_mut() else {
                    continue;
                };
                let coordinates = *section == "Points";
                match event {
                    Event::Open(attributes) => {
                        let array = Array::new(&attributes).map_err(fault)?;
                        if !coordinates {
                            piece.data.push(array);
                        } else if piece.coordinates.replace(array).is_some() {
                            return Err(fault("a second array of points".into()));
                        }
                    }
                    Event::Text(text) => {
                        let array = match coordinates {
                            true => piece.coordinates.as_mut(),
                            false => piece.data.last_mut(),
                        };
                        // Text may be parted by elements that describe the array; the values are in the first part.
                        if let Some(array) = array.filter(|array| array.text.is_empty()) {
                            array.text = text;
                        }
                    }
                    Event::Close => {}
                }
            }
            (
                event,
                [
                    "VTKFile",
                    "UnstructuredGrid",
                    "Piece",
                    section @ ("CellData" | "Cells"),
                    "DataArray",
                ],
            ) if cells => {
                let Some(piece) = pieces.last_mut() else {
                    continue;
                };
                let list = match *section {
                    "Cells" => &mut piece.cells.topology,
                    _ => &mut piece.cells.data,
                };
                match event {
                    Event::Open(attributes) => list.push(Array::new(&attributes).map_err(fault)?),
                    Event::Text(text) => {
                        if let Some(array) = list.last_mut().filter(|a| a.text.is_empty()) {
                            array.text = text;
                        }
                    }
                    Event::Close => {}
                }
            }
            (Event::Open(attributes), ["VTKFile", "AppendedData"]) => {
                appended = append(scanner.rest(), &attributes).map_err(fault)?;
                break;
            }
            _ => {}
        }
    }
    let packing = root.ok_or(FOREIGN)?;
    Ok(Outline {
        packing,
        pieces,
        appended,
    })
}

/// What the root says, if all of it can be read.
fn packing(attributes: &[(&str, String)]) -> Result<Packing, String> {
    match attribute(attributes, "type") {
        Some("UnstructuredGrid") => {}
        other => {
            let kind = other.unwrap_or("data set without a type");
            return Err(format!(
                "the file holds a {kind}; only an UnstructuredGrid is read"
            ));
        }
    }
    match attribute(attributes, "byte_order") {
        None | Some("LittleEndian") => {}
        Some(other) => {
            return Err(format!(
                "the byte order is {other}; only LittleEndian is read"
            ));
        }
    }
    let word = match attribute(attributes, "header_type") {
        None | Some("UInt32") => 4,
        Some("UInt64") => 8,
        Some(other) => {
            return Err(format!(
                "headers of type {other} are not read, only UInt32 and UInt64"
            ));
        }
    };
    Ok(Packing {
        word,
        compressor: attribute(attributes, "compressor").map(str::to_string),
    })
}

/// The appended data at the front of the rest of a file.
fn append<'a>(rest: &'a [u8], attributes: &[(&str, String)]) -> Result<Appended<'a>, String> {
    const END: &[u8] = b"</AppendedData";
    let Some(data) = rest.trim_ascii_start().strip_prefix(b"_") else {
        return Err("the appended data do not begin with `_`".into());
    };
    // From the back: the bytes may be anything.
    let end = data.windows(END.len()).rposition(|w| w == END);
    let data = &data[..end.ok_or("the appended data have no end")?];
    match attribute(attributes, "encoding") {
        Some("raw") => Ok(Appended::Raw(data)),
        None | Some("base64") => Ok(Appended::Base64(data)),
        Some(other) => Err(format!(
            "appended data in the encoding {other} are not read, only raw and base64"
        )),
    }
}

impl Outline<'_> {
    /// The points of a piece and the data on them.
    pub fn read(&self, piece: &Piece) -> Result<PointFields, String> {
        let values = |array: &Array| array.values(piece.points, &self.packing, self.appended);
        let points = match &piece.coordinates {
            Some(array) if array.components == 3 => values(array)?.as_chunks().0.to_vec(),
            Some(array) => {
                return Err(format!(
                    "the points have {} components, not 3",
                    array.components
                ));
            }
            None if piece.points == 0 => Vec::new(),
            None => return Err("a piece has no array of points".into()),
        };
        let mut arrays = BTreeMap::new();
        for array in &piece.data {
            let Entry::Vacant(place) = arrays.entry(array.name.clone()) else {
                return Err(format!("a second array `{}`", array.name));
            };
            place.insert(PointArray {
                components: array.components,
                values: values(array)?,
            });
        }
        Ok(PointFields { points, arrays })
    }
}

impl PointFields {
    /// Appends the points of another piece, which has to have the same arrays.
    pub(super) fn join(&mut self, mut other: PointFields) -> Result<(), String> {
        self.points.append(&mut other.points);
        for (name, array) in &mut self.arrays {
            let mut more = other
                .arrays
                .remove(name)
                .filter(|more| more.components == array.components)
                .ok_or_else(|| format!("array `{name}` is not the same in all pieces"))?;
            array.values.append(&mut more.values);
        }
        match other.arrays.keys().next() {
            Some(name) => Err(format!("array `{name}` is not in all pieces")),
            None => Ok(()),
        }
    }
}
