//! What the ranks make the matrix of a body of: cells where they can compute them, entries for all else.

use std::io;
use std::path::Path;

use rayon::prelude::*;

use super::body::Body;
use super::cells;
use super::words::WordWriter;
use crate::linear::union::Union;
use crate::linear::{LinearError, Matrix, Summands};

/// Entries that are added up before they are written: enough for the cells of a body that are near each other to meet.
const ENTRIES_TOGETHER: usize = 1 << 20;

/// A matrix that was written: its file, whether ranks compute cells for it, and a number for each kept dof that those which hang together have in common.
pub(super) struct Written {
    pub file: String,
    pub by_ranks: bool,
    pub pieces: Vec<u32>,
}

/// Writes what the ranks make the matrix of: the cells of each where they can be computed there, and what else it is a sum of, its lower triangle entry by entry. What
/// is in several shares MUMPS adds up.
pub fn write(body: &Body, matrix: &dyn Matrix) -> Result<Written, LinearError> {
    let (file, path) = body.job.new_file();
    let mut union = Union::new(body.split.len());
    let b = matrix.block_size();
    let cells = matrix.cells(body.split.points(b));
    match &cells {
        Some(cells) => {
            cells::deal(body, &**cells, b, &path, &mut union)?;
            deal_entries(body, &path, &mut union, true, &mut |visit| {
                cells.others(visit)
            })?;
        }
        None => {
            let (points, unkept) = (body.split.points(b), matrix.kept().is_err());
            deal_entries(body, &path, &mut union, unkept, &mut |visit| {
                matrix.summands(points.clone(), visit);
            })?;
        }
    }
    let kept = body.split.interior.len()..body.split.len();
    Ok(Written {
        file,
        by_ranks: cells.is_some(),
        pieces: kept.map(|i| union.top(i) as u32).collect(),
    })
}

/// Writes the lower triangle of what is handed out as it is made, some entries for each rank. Where `unchecked`, it has not been checked yet whether another body is coupled.
fn deal_entries(
    body: &Body,
    path: &Path,
    union: &mut Union,
    unchecked: bool,
    summands: &mut dyn FnMut(&mut Summands),
) -> Result<(), LinearError> {
    let split = &body.split;
    let create = |rank: usize| WordWriter::new(&path.with_extension(rank.to_string()));
    let shares: io::Result<Vec<WordWriter>> = (0..body.options.ranks).map(create).collect();
    let mut shares = shares.map_err(|e| body.job.trouble(&e))?;
    let mut entries: Vec<(u64, f64)> = Vec::new();
    let (mut wrong, mut unwritten, mut count) = (None, None, 0);
    summands(&mut |row, column, value| {
        let Some(i) = split.position(row).filter(|_| unwritten.is_none()) else {
            return;
        };
        if unchecked && !split.contains(column) {
            wrong.get_or_insert(LinearError::NotAnalysed {
                dofs: [row, column],
            });
        }
        let Some(j) = split.position(column).filter(|&j| j <= i) else {
            return;
        };
        if !value.is_finite() {
            wrong.get_or_insert(LinearError::NotFinite { dof: row });
        }
        union.join(i, j);
        count += 1;
        entries.push(((i as u64) << 32 | j as u64, value));
        if entries.len() == ENTRIES_TOGETHER {
            unwritten = deal(&mut entries, &mut shares).err();
        }
    });
    if let Some(wrong) = wrong {
        return Err(wrong);
    }
    let written = match unwritten {
        Some(error) => Err(error),
        None => deal(&mut entries, &mut shares)
            .and_then(|()| shares.into_iter().try_for_each(WordWriter::finish)),
    };
    written.map_err(|e| body.job.trouble(&e))?;
    body.job.dealt().entries += count;
    Ok(())
}

/// Adds entries up, and deals them out to the ranks.
fn deal(entries: &mut Vec<(u64, f64)>, shares: &mut [WordWriter]) -> io::Result<()> {
    // The order within equal places stays, so that sums have the same bits.
    entries.par_sort_by_key(|entry| entry.0);
    entries.dedup_by(|next, sum| {
        let same = next.0 == sum.0;
        sum.1 += if same { next.1 } else { 0.0 };
        same
    });
    let share = entries.len().div_ceil(shares.len()).max(1);
    for (entries, file) in entries.chunks(share).zip(shares) {
        for &(place, value) in entries {
            file.word(place.rotate_left(32))?;
            file.word(value.to_bits())?;
        }
    }
    entries.clear();
    Ok(())
}
