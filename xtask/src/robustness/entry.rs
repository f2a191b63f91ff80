//! A problem that was run.

use super::outcome::Outcome;

/// A problem that was run.
pub struct Entry {
    pub name: String,
    pub family: &'static str,
    pub words: String,
    pub outcome: Outcome,
}
