use std::io;
use std::sync::Arc;

use rayon::prelude::*;

use super::job::Job;
use super::options::MumpsOptions;
use super::words::WordWriter;
use crate::linear::engine::split::Split;
use crate::linear::union::Union;
use crate::linear::{LinearError, Matrix};
use crate::machine;

/// Bytes of a compliance, its copy in single precision and the work space, an entry.
const COMPLIANCE: u64 = 28;

/// Entries that are added up before they are written: enough for the cells of a body that are near each other to meet.
const TOGETHER: usize = 1 << 20;

/// A body before it is factored.
#[derive(Debug)]
pub(super) struct Body {
    pub job: Arc<Job>,
    pub options: MumpsOptions,
    pub split: Split,
    /// Whether the compliance stays with the ranks, and why if nobody has asked for it.
    pub spread: bool,
    pub note: Option<String>,
}

/// A matrix that was written: its file, and a number for each kept dof that those which hang together have in common.
pub(super) struct Written {
    pub file: String,
    pub pieces: Vec<u32>,
}

impl Body {
    pub fn new(job: Arc<Job>, options: MumpsOptions, split: Split) -> Body {
        let c = split.root.len() as u64;
        let bytes = COMPLIANCE * c * c;
        let limit = machine::available_memory().map(|free| free / 2);
        let too_large = limit.filter(|&limit| bytes > limit);
        let note = too_large.filter(|_| options.spread.is_none()).map(|limit| {
            format!(
                "the compliance of {c} contact candidates stays with the ranks: in the first process it would take {}, and half of what is free there is {}",
                machine::bytes(bytes),
                machine::bytes(limit)
            )
        });
        Body {
            spread: c > 0 && options.spread.unwrap_or(note.is_some()),
            job,
            options,
            split,
            note,
        }
    }

    /// Writes the lower triangle as it is made, some entries for each rank: what is added up in several shares MUMPS adds up.
    pub fn write(&self, matrix: &dyn Matrix) -> Result<Written, LinearError> {
        let (file, path) = self.job.new_file();
        let split = &self.split;
        let create = |rank: usize| WordWriter::new(&path.with_extension(rank.to_string()));
        let shares: io::Result<Vec<WordWriter>> = (0..self.options.ranks).map(create).collect();
        let mut shares = shares.map_err(|e| self.job.trouble(&e))?;
        let mut union = Union::new(split.len());
        let mut entries: Vec<(u64, f64)> = Vec::new();
        let (mut wrong, mut unwritten) = (None, None);
        let (b, unkept) = (matrix.block_size(), matrix.kept().is_err());
        matrix.summands(split.points(b), &mut |row, column, value| {
            let Some(i) = split.position(row).filter(|_| unwritten.is_none()) else {
                return;
            };
            if unkept && !split.contains(column) {
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
            entries.push(((i as u64) << 32 | j as u64, value));
            if entries.len() == TOGETHER {
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
        written.map_err(|e| self.job.trouble(&e))?;
        let kept = split.interior.len()..split.len();
        Ok(Written {
            file,
            pieces: kept.map(|i| union.top(i) as u32).collect(),
        })
    }
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
