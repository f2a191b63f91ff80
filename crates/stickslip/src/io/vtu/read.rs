use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::path::Path;

use crate::error::{Error, IoError};
use crate::math::Vec3;

use super::array::{Appended, Array, attribute, count};
use super::stream::Packing;
use super::xml::{Event, Scanner, line};

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
    let bytes = crate::io::input::read(path, u64::MAX).map_err(|e| Error::io(path, e))?;
    parse(&bytes, path)
}

/// Reads points and data from the bytes of a file; `path` is for messages only.
///
/// # Errors
/// As [`read()`], but for those of the file system.
pub fn parse(bytes: &[u8], path: &Path) -> Result<PointFields, Error> {
    point_fields(bytes).map_err(|message| {
        Error::Io(IoError {
            file: path.to_path_buf(),
            message,
        })
    })
}

/// What the tags of a file say.
pub(super) struct Outline<'a> {
    /// The whole file.
    bytes: &'a [u8],
    packing: Packing,
    /// The pieces of the grid.
    pub pieces: Vec<Piece<'a>>,
    appended: Appended<'a>,
}

/// A piece of a grid.
pub(super) struct Piece<'a> {
    /// The line of its tag.
    pub line: usize,
    /// Number of points.
    pub points: usize,
    /// Number of cells.
    pub cells: usize,
    /// Number of cells of a surface, by [`KINDS`].
    pub faces: [usize; 3],
    /// Coordinates.
    pub coordinates: Option<Array<'a>>,
    /// Point data.
    pub data: Vec<Array<'a>>,
    /// The arrays that make the cells, or why one cannot be read: it may not be needed.
    pub topology: Vec<Result<Array<'a>, String>>,
    /// Cell data, as far as they can be read.
    pub cell_data: Vec<Array<'a>>,
}

pub(super) fn point_fields(bytes: &[u8]) -> Result<PointFields, String> {
    let outline = outline(bytes, GRID)?;
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

/// The type of data set that a `.vtu` file holds, and that of a `.vtp` file.
pub(super) const GRID: &str = "UnstructuredGrid";
pub(super) const SURFACE: &str = "PolyData";

/// The cells of a surface by their kinds.
pub(super) const KINDS: [&str; 3] = ["Verts", "Lines", "Polys"];

/// The tags of a file that holds this type of data set.
pub(super) fn outline<'a>(bytes: &'a [u8], kind: &str) -> Result<Outline<'a>, String> {
    if !bytes.trim_ascii_end().ends_with(b"</VTKFile>") {
        let begun = bytes.windows(8).any(|w| w == b"<VTKFile");
        return Err(match begun {
            true => format!(
                "the file is truncated: it ends at byte {} without </VTKFile>",
                bytes.len()
            ),
            false => FOREIGN.into(),
        });
    }
    let mut scanner = Scanner::new(bytes);
    let mut root = None;
    let mut pieces: Vec<Piece> = Vec::new();
    let mut appended = Appended::None;
    while let Some(event) = scanner.next()? {
        let fault = |message: String| scanner.fault(message);
        match (event, scanner.path()) {
            (Event::Open(attributes), ["VTKFile"]) => {
                root = Some(packing(&attributes, kind).map_err(fault)?);
            }
            (Event::Open(_), [_]) | (Event::Text(_), []) => return Err(FOREIGN.into()),
            (Event::Open(attributes), ["VTKFile", of, "Piece"]) if *of == kind => {
                let line = line(bytes, scanner.position());
                pieces.push(Piece::new(line, &attributes).map_err(fault)?);
            }
            (
                event,
                [
                    "VTKFile",
                    of,
                    "Piece",
                    section @ ("PointData" | "Points" | "Cells" | "CellData" | "Verts" | "Lines"
                    | "Polys"),
                    "DataArray" | "Array",
                ],
            ) if *of == kind => {
                if let Some(piece) = pieces.last_mut() {
                    piece.take(section, event, &scanner)?;
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
        bytes,
        packing,
        pieces,
        appended,
    })
}

impl<'a> Piece<'a> {
    fn new(line: usize, attributes: &[(&str, String)]) -> Result<Piece<'a>, String> {
        Ok(Piece {
            line,
            points: count(attributes, "NumberOfPoints", None)?,
            cells: count(attributes, "NumberOfCells", Some(0))?,
            faces: [
                count(attributes, "NumberOfVerts", Some(0))?,
                count(attributes, "NumberOfLines", Some(0))?,
                count(attributes, "NumberOfPolys", Some(0))?,
            ],
            coordinates: None,
            data: Vec::new(),
            topology: Vec::new(),
            cell_data: Vec::new(),
        })
    }

    /// Takes up the tag or the text of an array in one of its sections.
    fn take(
        &mut self,
        section: &str,
        event: Event<'a>,
        scanner: &Scanner<'a>,
    ) -> Result<(), String> {
        match event {
            Event::Open(attributes) => {
                let array = Array::new(&attributes, scanner.position());
                let array = array.map_err(|message| scanner.fault(message));
                match section {
                    "Points" if self.coordinates.is_some() => {
                        return Err(scanner.fault("a second array of points"));
                    }
                    "Points" => {
                        let mut array = array?;
                        if array.name.is_empty() {
                            array.name = "Points".into();
                        }
                        self.coordinates = Some(array);
                    }
                    "PointData" => self.data.push(array?),
                    "Cells" => self.topology.push(array),
                    // Each kind of cells of a surface has arrays of these names.
                    kind if KINDS.contains(&kind) => self.topology.push(array.map(|mut array| {
                        array.name = format!("{kind}/{}", array.name);
                        array
                    })),
                    // Texts, for one, are no values that a cell could have.
                    _ => self.cell_data.extend(array),
                }
                Ok(())
            }
            Event::Text(text) => {
                let array = match section {
                    "Points" => self.coordinates.as_mut(),
                    "PointData" => self.data.last_mut(),
                    "CellData" => self.cell_data.last_mut(),
                    _ => self.topology.last_mut().and_then(|a| a.as_mut().ok()),
                };
                // Text may be parted by elements that describe the array; the values are in the first part.
                if let Some(array) = array.filter(|array| array.text.is_empty()) {
                    array.text = text;
                }
                Ok(())
            }
            Event::Close => Ok(()),
        }
    }
}

/// What the root says, if all of it can be read.
fn packing(attributes: &[(&str, String)], wanted: &str) -> Result<Packing, String> {
    match attribute(attributes, "type") {
        Some(kind) if kind == wanted => {}
        other => {
            let kind = other.unwrap_or("data set without a type");
            let article = if wanted == GRID { "an" } else { "a" };
            return Err(format!(
                "the file holds a {kind}; only {article} {wanted} is read"
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
    const END_OF_APPENDED: &[u8] = b"</AppendedData";
    let Some(data) = rest.trim_ascii_start().strip_prefix(b"_") else {
        return Err("the appended data do not begin with `_`".into());
    };
    // From the back: the bytes may be anything.
    let end = data
        .windows(END_OF_APPENDED.len())
        .rposition(|w| w == END_OF_APPENDED);
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
    /// The values of an array on so many points or cells.
    pub fn values(&self, array: &Array, count: usize) -> Result<Vec<f64>, String> {
        let values = array.values(count, &self.packing, self.appended);
        values.map_err(|message| format!("line {}: {message}", self.line(array)))
    }

    /// The line of the tag of an array.
    pub fn line(&self, array: &Array) -> usize {
        line(self.bytes, array.at)
    }

    /// The coordinates of a piece.
    pub fn points(&self, piece: &Piece) -> Result<Vec<Vec3>, String> {
        match &piece.coordinates {
            Some(array) if array.components == 3 => {
                Ok(self.values(array, piece.points)?.as_chunks().0.to_vec())
            }
            Some(array) => Err(format!(
                "line {}: the points have {} components, not 3",
                self.line(array),
                array.components
            )),
            None if piece.points == 0 => Ok(Vec::new()),
            None => Err(format!(
                "line {}: the piece has no array of points",
                piece.line
            )),
        }
    }

    /// The points of a piece and the data on them.
    pub fn read(&self, piece: &Piece) -> Result<PointFields, String> {
        let points = self.points(piece)?;
        let mut arrays = BTreeMap::new();
        for array in &piece.data {
            let Entry::Vacant(place) = arrays.entry(array.name.clone()) else {
                return Err(format!(
                    "line {}: a second array `{}`",
                    self.line(array),
                    array.name
                ));
            };
            place.insert(PointArray {
                components: array.components,
                values: self.values(array, piece.points)?,
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
