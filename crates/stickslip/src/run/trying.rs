//! A block of cycles that may be taken back.

use super::checkpoint::Checkpoint;
use crate::results::history::Row;

/// The block at hand: where it began, and what is to be told when it is over.
pub(super) struct Trying {
    pub start: Checkpoint,
    pub rows: Vec<Row>,
    pub cycle: Option<Row>,
    pub fields: bool,
}

impl Trying {
    /// A block that begins.
    pub fn from(start: Checkpoint) -> Self {
        Trying {
            start,
            rows: Vec::new(),
            cycle: None,
            fields: false,
        }
    }

    /// Keeps what came of an increment.
    pub fn hold(&mut self, row: Row, fields: bool) {
        self.rows.push(row);
        self.fields |= fields;
    }

    /// Keeps what came of the cycle.
    pub fn hold_cycle(&mut self, row: Row) {
        self.cycle = Some(row);
    }
}
