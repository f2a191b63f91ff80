//! What a drawing of an interface has around it.

use super::super::picture::{Units, Zoom};

/// What stands around, and how much is shown.
pub struct Page {
    pub title: String,
    pub words: String,
    pub units: Units,
    pub zoom: Zoom,
    pub size: [u32; 2],
}
