//! Fields from a `.vtu` file as the program writes it: appended raw data in compressed blocks (VTK file formats, section "XML").

use std::collections::BTreeMap;
use std::io::Read;
use std::path::Path;

use crate::vec3::Vec3;

/// The mesh and the fields of a file.
#[derive(Debug, Clone, Default)]
pub struct Grid {
    /// Coordinates of the points.
    pub points: Vec<Vec3>,
    /// VTK's type of every cell.
    pub types: Vec<u8>,
    /// Points of every cell, in VTK's order.
    pub cells: Vec<Vec<usize>>,
    /// Fields by name, points and cells alike; components of an entry follow each other.
    pub fields: BTreeMap<String, Vec<f64>>,
}

impl Grid {
    /// The scalar field of that name, or NaN everywhere.
    pub fn scalar(&self, name: &str) -> Vec<f64> {
        let none = || vec![f64::NAN; self.points.len()];
        self.fields.get(name).cloned().unwrap_or_else(none)
    }

    /// The vector field of that name, or zero everywhere.
    pub fn vector(&self, name: &str) -> Vec<Vec3> {
        match self.fields.get(name) {
            Some(values) => values.chunks_exact(3).map(|v| [v[0], v[1], v[2]]).collect(),
            None => vec![[0.0; 3]; self.points.len()],
        }
    }
}

/// Reads a file.
pub fn read(path: &Path) -> Result<Grid, String> {
    let say = |what: &str| format!("{}: {what}", path.display());
    let bytes = std::fs::read(path).map_err(|e| say(&e.to_string()))?;
    let mark = b"<AppendedData encoding=\"raw\">";
    let at = bytes.windows(mark.len()).position(|w| w == mark);
    let at = at.ok_or_else(|| say("no appended data"))? + mark.len();
    let start = bytes[at..].iter().position(|b| *b == b'_');
    let data = &bytes[at + start.ok_or_else(|| say("no appended data"))? + 1..];
    let head = String::from_utf8_lossy(&bytes[..at]);
    let mut grid = Grid::default();
    let (mut flat, mut ends) = (Vec::new(), Vec::new());
    for tag in head.split('<').filter(|t| t.starts_with("DataArray")) {
        let of = |key: &str| {
            let from = tag.find(&format!(" {key}=\""))? + key.len() + 3;
            tag[from..].split('"').next()
        };
        let (Some(name), Some(kind), Some(offset)) = (of("Name"), of("type"), of("offset")) else {
            return Err(say("an array without name, type or offset"));
        };
        let offset: usize = offset.parse().map_err(|_| say("a bad offset"))?;
        let values = numbers(data.get(offset..).unwrap_or_default(), kind)
            .map_err(|e| say(&format!("{name}: {e}")))?;
        match name {
            "Points" => grid.points = values.chunks_exact(3).map(|v| [v[0], v[1], v[2]]).collect(),
            "connectivity" => flat = values,
            "offsets" => ends = values,
            "types" => grid.types = values.iter().map(|v| *v as u8).collect(),
            _ => {
                grid.fields.insert(name.to_string(), values);
            }
        }
    }
    let mut from = 0;
    for end in ends {
        let cell = flat
            .get(from..end as usize)
            .ok_or_else(|| say("short connectivity"))?;
        grid.cells.push(cell.iter().map(|v| *v as usize).collect());
        from = end as usize;
    }
    Ok(grid)
}

/// One array: the number of blocks, their size, the size of the last, the compressed sizes, and the blocks.
fn numbers(data: &[u8], kind: &str) -> Result<Vec<f64>, String> {
    let word = |i: usize| -> Result<usize, String> {
        let eight = data.get(8 * i..8 * i + 8).ok_or("the file ends early")?;
        let eight: [u8; 8] = eight.try_into().map_err(|_| "the file ends early")?;
        Ok(u64::from_le_bytes(eight) as usize)
    };
    let blocks = word(0)?;
    let mut at = 8 * (3 + blocks);
    let mut raw = Vec::new();
    for block in 0..blocks {
        let size = word(3 + block)?;
        let packed = data.get(at..at + size).ok_or("the file ends early")?;
        let mut plain = flate2::read::ZlibDecoder::new(packed);
        plain.read_to_end(&mut raw).map_err(|e| e.to_string())?;
        at += size;
    }
    let wide = |make: fn([u8; 8]) -> f64| -> Vec<f64> {
        let eights = raw.chunks_exact(8);
        eights
            .map(|b| make([b[0], b[1], b[2], b[3], b[4], b[5], b[6], b[7]]))
            .collect()
    };
    Ok(match kind {
        "Float64" => wide(f64::from_le_bytes),
        "Int64" => wide(|b| i64::from_le_bytes(b) as f64),
        "UInt8" => raw.iter().map(|b| f64::from(*b)).collect(),
        _ => return Err(format!("the type {kind} is not read")),
    })
}
