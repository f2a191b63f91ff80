//! Pairing: which place of which facet belongs to a point.

mod anchor;
mod closest;

pub use anchor::Anchor;
pub use closest::{Choice, Previous};
