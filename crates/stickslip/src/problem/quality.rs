//! `[quality]` is the table of limits itself.

pub use crate::simulation::Limits as Quality;
