use std::sync::Arc;

use super::job::Job;
use super::options::MumpsOptions;
use crate::linear::engine::split::Split;
use crate::machine;

/// Bytes of a compliance, its copy in single precision and the work space, an entry.
const COMPLIANCE: u64 = 28;

/// A body before it is factored.
#[derive(Debug)]
pub(super) struct Body {
    pub job: Arc<Job>,
    pub options: MumpsOptions,
    pub split: Split,
    /// Whether the compliance stays with the ranks, and why if it has not been asked for.
    pub spread: bool,
    pub note: Option<String>,
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
}
