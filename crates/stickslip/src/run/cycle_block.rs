//! Blocks of cycles that may be taken back.

use super::checkpoint::Checkpoint;
use crate::results::history::Row;

/// The block at hand, or two that are judged together: where they began, and what is to be told when they are over.
pub(super) struct CycleBlock {
    pub start: Checkpoint,
    pub rows: Vec<Row>,
    pub cycles: Vec<Row>,
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

    /// Keeps what came of an increment.
    pub fn hold(&mut self, row: Row, fields: bool) {
        self.rows.push(row);
        self.fields |= fields;
    }

    /// Keeps what came of a cycle.
    pub fn hold_cycle(&mut self, row: Row) {
        self.cycles.push(row);
    }
}
