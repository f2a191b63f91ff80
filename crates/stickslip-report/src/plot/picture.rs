//! How a picture of the bodies is wanted.

use super::camera::View;

/// Which of the times are drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum When {
    /// The last.
    Last,
    /// By its place, from 1.
    Number(usize),
    /// Each in a file of its own.
    All,
}

/// How a picture of the bodies is made.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    /// Name of the field in colour; chosen by what there is if not given.
    pub field: Option<String>,
    /// Which times.
    pub when: When,
    /// Factor of the displacements; chosen if not given.
    pub scale: Option<f64>,
    /// From where one looks; chosen if not given.
    pub view: Option<View>,
    /// The bodies to be drawn, by name; all, or those that carry a field of contact, if empty.
    pub bodies: Vec<String>,
    /// Width and height `[pixels]`.
    pub size: [u32; 2],
}

impl Default for Picture {
    fn default() -> Self {
        Picture {
            field: None,
            when: When::Last,
            scale: None,
            view: None,
            bodies: Vec::new(),
            size: [1200, 900],
        }
    }
}
