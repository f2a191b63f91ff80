//! Blocks of cycles that may be taken back.

use super::checkpoint::Checkpoint;
use crate::results::history::Row;

/// The block at hand, or two that are judged together: where they began, and what is to be told when they are over.
pub(super) struct CycleBlock {
    pub start: Checkpoint,
    /// Rows of the history, and those of cycles.
    pub rows: Vec<Row>,
    pub cycles: Vec<Row>,
    /// Whether fields are due.
    pub fields: bool,
}

impl CycleBlock {
    /// A block that begins.
    pub fn from(start: Checkpoint) -> Self {
        CycleBlock {
            start,
            rows: Vec::new(),
            cycles: Vec::new(),
            fields: false,
        }
    }
}
