//! A factor as bytes, little endian.
//!
//! Written by hand: numbers go through in bulk, of a symmetric front one triangle only, and what is read is checked as a structure in any case.
//! `postcard`, measured on 160 MB of numbers, took 1.4 to 2.7 times as long to write and up to 1.8 times as long to read, and would save the header alone.

use std::io::{self, Read, Write};
use std::ops::Range;
use std::sync::Arc;

use super::super::ordering::NONE;
use super::numeric::PartialFactor;
use super::symbolic::Fronts;
use super::tree::FrontTree;
use crate::keep::{Keep, Kept};

/// Names the format and its version.
const FORMAT_NAME_AND_VERSION: &[u8; 8] = b"mfllt\0\0\x01";

/// Numbers converted at a time.
const CONVERTED_AT_A_TIME: usize = 8192;

/// Writes the analysis and the factor. No checksum is added.
///
/// # Errors
/// Those of `out`.
pub fn write_factor(factor: &PartialFactor, out: &mut dyn Write) -> io::Result<()> {
    let fronts = &*factor.fronts;
    let mut head = FORMAT_NAME_AND_VERSION.to_vec();
    let header = Header {
        shape: fronts.shape,
        points: (fronts.points.start, fronts.points.end),
        interior: fronts.interior.len(),
        root: fronts.root.len(),
        fronts: fronts.len(),
        rows: fronts.rows.len(),
        smallest_pivot: factor.smallest_pivot,
    };
    header.keep(&mut head);
    out.write_all(&head)?;
    let counts = (0..fronts.len()).map(|front| fronts.sizes(front).1 as u32);
    write_indices(out, fronts.position_of.iter().copied())?;
    write_indices(out, fronts.tree.first[1..].iter().copied())?;
    write_indices(out, fronts.tree.parents.iter().copied())?;
    write_indices(out, counts)?;
    write_indices(out, fronts.rows.iter().copied())?;
    let mut bytes = Vec::new();
    for (piece, panels) in fronts.pieces.iter().zip(&factor.panels) {
        let mut panels = &panels[..];
        for front in piece.fronts.clone() {
            let (columns, rows) = fronts.sizes(front);
            let (panel, rest) = panels.split_at(columns * (columns + rows));
            panels = rest;
            for (j, column) in panel.chunks_exact(columns + rows).enumerate() {
                bytes.clear();
                bytes.extend(column[j..].iter().flat_map(|v| v.to_le_bytes()));
                out.write_all(&bytes)?;
            }
        }
    }
    Ok(())
}

/// Reads what [`write_factor`] wrote. Memory grows with what is read, whatever the counts say.
///
/// # Errors
/// Those of `input`; [`io::ErrorKind::InvalidData`] for anything that is not a factor. Changed numbers of a
/// factor go unnoticed as long as they are finite, its diagonal positive.
pub fn read_factor(input: &mut dyn Read) -> io::Result<PartialFactor> {
    let mut magic = [0; 8];
    input.read_exact(&mut magic)?;
    if &magic != FORMAT_NAME_AND_VERSION {
        return Err(invalid("not a factor"));
    }
    let Header {
        shape,
        points: (start, end),
        interior,
        root,
        fronts,
        rows,
        smallest_pivot,
    } = Header::read(input)?;
    let position_of = read_indices(input, (end - start) * shape.1)?;
    let first = read_indices(input, fronts)?;
    let parents = read_indices(input, fronts)?;
    let row_counts = read_indices(input, fronts)?;
    let rows = read_indices(input, rows)?;
    let mut tree = FrontTree::of(parents).ok_or_else(|| invalid("structure"))?;
    tree.first.extend(first);
    let fronts = Fronts {
        shape,
        points: start..end,
        interior: vec![NONE; interior],
        root: vec![NONE; root],
        position_of,
        tree,
        rows,
        targets: Vec::new(),
        pieces: Vec::new(),
    };
    let fronts = check(fronts, &row_counts).ok_or_else(|| invalid("structure"))?;
    let mut panels = Vec::with_capacity(fronts.pieces.len());
    for piece in &fronts.pieces {
        panels.push(read_panels(input, &fronts, piece.fronts.clone())?);
    }
    Ok(PartialFactor {
        fronts: Arc::new(fronts),
        panels,
        smallest_pivot,
    })
}

/// What stands behind the mark of the format.
#[derive(Keep)]
struct Header {
    /// Points and block size of the matrix.
    shape: (usize, usize),
    /// The first point of the substructure, and the one behind its last.
    points: (usize, usize),
    /// Dofs eliminated, dofs kept, fronts and rows of all fronts.
    interior: usize,
    root: usize,
    fronts: usize,
    rows: usize,
    smallest_pivot: (usize, f64),
}

impl Header {
    /// Its bytes: ten numbers.
    const BYTES: usize = 80;

    fn read(input: &mut dyn Read) -> io::Result<Header> {
        let mut bytes = [0; Header::BYTES];
        input.read_exact(&mut bytes)?;
        let header = Header::back(&mut Kept::new(&bytes)).map_err(|_| invalid("counts"))?;
        let Header {
            shape: (points, block),
            points: (start, end),
            interior,
            root,
            fronts,
            smallest_pivot: (dof, ratio),
            ..
        } = header;
        let dofs = points.checked_mul(block).filter(|&n| n < NONE as usize);
        let sane = dofs.is_some()
            && (2..=3).contains(&block)
            && start <= end
            && end <= points
            && interior <= (end - start) * block
            && root <= (end - start) * block - interior
            && fronts <= interior;
        if !sane {
            return Err(invalid("counts"));
        }
        if dof > points * block || ratio.is_nan() {
            return Err(invalid("pivots"));
        }
        Ok(header)
    }
}

fn invalid(what: &str) -> io::Error {
    io::Error::new(
        io::ErrorKind::InvalidData,
        format!("a factor with wrong {what}"),
    )
}

/// Completes the structure; `None` if it is none.
fn check(mut fronts: Fronts, row_counts: &[u32]) -> Option<Fronts> {
    let interior = fronts.interior.len();
    let n = interior + fronts.root.len();
    let origin = fronts.points.start * fronts.shape.1;
    for (local, &position) in fronts.position_of.iter().enumerate() {
        if position == NONE {
            continue;
        }
        let position = position as usize;
        let slot = match position.checked_sub(interior) {
            None => &mut fronts.interior[position],
            Some(at) => fronts.root.get_mut(at)?,
        };
        if *slot != NONE {
            return None;
        }
        *slot = (origin + local) as u32;
    }
    let complete = !fronts.interior.contains(&NONE) && fronts.root.is_sorted_by(|a, b| a < b);
    let ordered = fronts.tree.first.is_sorted_by(|a, b| a < b);
    if !(complete && !fronts.root.contains(&NONE) && ordered) {
        return None;
    }
    if fronts.tree.first.last() != Some(&(interior as u32)) {
        return None;
    }
    let mut start = 0usize;
    for (front, &count) in row_counts.iter().enumerate() {
        let end = start.checked_add(count as usize)?;
        let rows = fronts.rows.get(start..end)?;
        let behind = rows
            .first()
            .is_none_or(|&row| row >= fronts.tree.first[front + 1]);
        let inside = rows.last().is_none_or(|&row| (row as usize) < n);
        if !(behind && inside && rows.is_sorted_by(|a, b| a < b)) {
            return None;
        }
        fronts.tree.row_starts.push(end);
        start = end;
    }
    (start == fronts.rows.len()).then_some(())?;
    fronts.link()?;
    Some(fronts)
}

fn write_indices(out: &mut dyn Write, indices: impl Iterator<Item = u32>) -> io::Result<()> {
    let mut bytes = Vec::with_capacity(4 * CONVERTED_AT_A_TIME);
    for index in indices {
        bytes.extend(index.to_le_bytes());
        if bytes.len() == 4 * CONVERTED_AT_A_TIME {
            out.write_all(&bytes)?;
            bytes.clear();
        }
    }
    out.write_all(&bytes)
}

fn read_indices(input: &mut dyn Read, count: usize) -> io::Result<Vec<u32>> {
    let mut indices = Vec::new();
    let mut bytes = [0; 4 * CONVERTED_AT_A_TIME];
    while indices.len() < count {
        let bytes = &mut bytes[..4 * CONVERTED_AT_A_TIME.min(count - indices.len())];
        input.read_exact(bytes)?;
        let words = bytes.chunks_exact(4);
        indices.extend(words.map(|w| u32::from_le_bytes([w[0], w[1], w[2], w[3]])));
    }
    Ok(indices)
}

/// The panels of some fronts, zero above the diagonal.
fn read_panels(input: &mut dyn Read, fronts: &Fronts, range: Range<usize>) -> io::Result<Vec<f64>> {
    let mut panels: Vec<f64> = Vec::new();
    let mut bytes = vec![0; 8 * CONVERTED_AT_A_TIME];
    for front in range {
        let (columns, rows) = fronts.sizes(front);
        for j in 0..columns {
            let diagonal = panels.len() + j;
            panels.resize(diagonal, 0.0);
            let mut left = columns + rows - j;
            while left > 0 {
                let bytes = &mut bytes[..8 * CONVERTED_AT_A_TIME.min(left)];
                input.read_exact(bytes)?;
                left -= bytes.len() / 8;
                panels.extend(
                    bytes.chunks_exact(8).map(|w| {
                        f64::from_le_bytes([w[0], w[1], w[2], w[3], w[4], w[5], w[6], w[7]])
                    }),
                );
            }
            let sound = panels[diagonal] > 0.0 && panels[diagonal..].iter().all(|v| v.is_finite());
            if !sound {
                return Err(invalid("numbers"));
            }
        }
    }
    Ok(panels)
}

#[cfg(test)]
mod tests {
    use super::super::Workspace;
    use super::super::tests::{cube, factor};
    use super::*;
    use crate::linear::multifrontal::sweep;
    use crate::linear::testing::{grid, noise};

    #[test]
    fn a_decoded_factor_is_the_same() {
        let (a, fixed, kept) = cube(11);
        let (factor, schur) = factor(&a, 0..a.points(), &fixed, &kept).unwrap();
        let mut bytes = Vec::new();
        write_factor(&factor, &mut bytes).unwrap();
        let decoded = read_factor(&mut &bytes[..]).unwrap();
        assert!(decoded.fronts == factor.fronts);
        assert_eq!(decoded.smallest_pivot, factor.smallest_pivot);
        let mut bytes_again = Vec::new();
        write_factor(&decoded, &mut bytes_again).unwrap();
        assert!(bytes == bytes_again);
        let (again, schur_again) =
            PartialFactor::new(decoded.fronts(), &a, &Workspace::default()).unwrap();
        assert!(*schur_again == *schur);
        for columns in [1, 4] {
            let sweep = |factor: &PartialFactor| {
                let mut x = noise(&mut 1, factor.fronts().interior().len() * columns);
                let mut w = noise(&mut 2, factor.fronts().root().len() * columns);
                sweep::forward(factor, &mut x, &mut w, columns);
                sweep::backward(factor, &mut x, &w, columns);
                (x, w)
            };
            assert!(sweep(&decoded) == sweep(&factor) && sweep(&again) == sweep(&factor));
        }
    }

    #[test]
    fn damaged_bytes_do_no_harm() {
        for (counts, block) in [([4, 3, 1], 2), ([5, 4, 4], 3)] {
            let a = grid(counts, block);
            let fixed: Vec<bool> = (0..a.rows()).map(|dof| dof < 8 || dof == 15).collect();
            let kept: Vec<bool> = (0..a.points()).map(|p| p % 7 == 6).collect();
            let (factor, _) = factor(&a, 0..a.points(), &fixed, &kept).unwrap();
            let mut bytes = Vec::new();
            write_factor(&factor, &mut bytes).unwrap();
            // All of the structure, and some of the numbers.
            let structure = bytes.len() - 8 * factor.fronts().nonzeros();
            let places = (0..structure).chain((structure..bytes.len()).step_by(97));
            for at in places {
                assert!(read_factor(&mut &bytes[..at]).is_err(), "cut at {at}");
                for change in [0x01, 0x80, 0xff] {
                    let mut wrong = bytes.clone();
                    wrong[at] ^= change;
                    // Whatever is accepted can be used.
                    if let Ok(factor) = read_factor(&mut &wrong[..]) {
                        let fronts = Arc::clone(factor.fronts());
                        let mut x = vec![1.0; fronts.interior().len()];
                        let mut w = vec![1.0; fronts.root().len()];
                        sweep::forward(&factor, &mut x, &mut w, 1);
                        sweep::backward(&factor, &mut x, &w, 1);
                        if fronts.shape == (a.points(), block) {
                            let _ = PartialFactor::new(&fronts, &a, &Workspace::default());
                        }
                    }
                }
            }
        }
    }
}
