//! Cells that are dealt to the ranks, which make the matrices of theirs themselves: no rank has the whole mesh, and none the whole matrix.

use std::io;
use std::path::Path;

use super::body::Body;
use super::words::WordWriter;
use crate::keep::Keep;
use crate::linear::partition::CellList;
use crate::linear::union::Union;
use crate::linear::{Cells, LinearError};

/// Bytes of a word.
const WORD: usize = size_of::<u64>();

/// In place of the row of a dof that is no unknown.
const NO_ROW: u32 = u32::MAX;

/// Deals the cells out, and writes for each rank a file `PATH.cells.RANK`. Rows of the same cell are joined.
pub fn deal(
    body: &Body,
    cells: &dyn Cells,
    block: usize,
    path: &Path,
    union: &mut Union,
) -> Result<(), LinearError> {
    let mut list = CellList::default();
    let mut wrong = None;
    cells.couplings(&mut |points| {
        let dofs = || points.iter().flat_map(|p| p * block..(p + 1) * block);
        let mut rows = dofs().filter_map(|dof| Some((dof, body.split.position(dof)?)));
        if let Some((dof, first)) = rows.next() {
            rows.for_each(|(_, row)| union.join(first, row));
            let outside = dofs().find(|&other| !body.split.contains(other));
            wrong = wrong.or(outside.map(|other| [dof, other]));
        }
        let origin = body.split.points(block).start;
        list.push(points.iter().map(|p| p.saturating_sub(origin)));
    });
    if let Some(dofs) = wrong {
        return Err(LinearError::NotAnalysed { dofs });
    }
    // Cells that have a face in common have at least as many points in common as there are dimensions.
    for (rank, own) in list.deal(body.options.ranks, block).iter().enumerate() {
        let bytes = portions(body, cells, own, block);
        let path = path.with_extension(format!("cells.{rank}"));
        write(&path, &bytes).map_err(|e| body.job.trouble(&e))?;
        let mut dealt = body.job.dealt();
        dealt.cells.resize(body.options.ranks, 0);
        dealt.bytes.resize(body.options.ranks, 0);
        dealt.cells[rank] += own.len() as u64;
        dealt.bytes[rank] += bytes.len() as u64;
    }
    Ok(())
}

/// What a rank needs: the rows of the dofs of its points, and what computes its cells.
fn portions(body: &Body, cells: &dyn Cells, own: &[u32], block: usize) -> Vec<u8> {
    let row = |dof| body.split.position(dof).map_or(NO_ROW, |row| row as u32);
    let rows = |points: Vec<usize>| -> Vec<u32> {
        let dofs = points.iter().flat_map(|p| p * block..(p + 1) * block);
        dofs.map(row).collect()
    };
    let portions = cells.portions(own).into_iter();
    let all: Vec<(Vec<u32>, Vec<u8>)> = portions
        .map(|(points, bytes)| (rows(points), bytes))
        .collect();
    let mut out = Vec::new();
    all.keep(&mut out);
    out
}

/// Writes bytes as words, the last one filled up.
fn write(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut file = WordWriter::new(path)?;
    for chunk in bytes.chunks(WORD) {
        let mut word = [0; WORD];
        word[..chunk.len()].copy_from_slice(chunk);
        file.word(u64::from_ne_bytes(word))?;
    }
    file.finish()
}
