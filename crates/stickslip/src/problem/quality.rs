//! `[quality]` is the table of limits itself.

pub use crate::model::Limits as Quality;
