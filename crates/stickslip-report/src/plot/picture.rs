//! How a picture of the bodies is wanted.

use std::str::FromStr;

use super::camera::View;
pub use crate::units::Units;

/// Which of the times are drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum When {
    /// That of interest: of pressure and status that at which contact presses most, or the last where nothing presses; of what only grows, as wear, the last; of other fields that at
    /// which they are largest.
    Peak,
    /// The last.
    Last,
    /// By its place, from 1.
    Number(usize),
    /// Each in a file of its own.
    All,
}

/// Which part of the bodies is seen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Zoom {
    /// The patch that presses, if a field of contact is shown and the patch is small; all otherwise.
    Auto,
    /// All.
    Whole,
    /// The patch that presses.
    Contact,
    /// So many times nearer than all.
    Times(f64),
}

impl FromStr for Zoom {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "auto" => Ok(Zoom::Auto),
            "whole" => Ok(Zoom::Whole),
            "contact" => Ok(Zoom::Contact),
            _ => match text.parse::<f64>() {
                Ok(x) if x.is_finite() && (0.01..=1e6).contains(&x) => Ok(Zoom::Times(x)),
                _ => Err("`contact`, `whole`, `auto`, or how many times nearer".into()),
            },
        }
    }
}

/// A plane across an axis, where it is said.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plane {
    /// The axis: 0, 1, 2.
    pub axis: usize,
    /// Where it crosses the axis `[length]`; chosen if not given.
    pub at: Option<f64>,
}

impl FromStr for Plane {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || {
            "x, y or z, with `=` and a place behind it if that is not to be chosen: x=0.5"
                .to_string()
        };
        let (axis, at) = match text.split_once('=') {
            Some((axis, at)) => {
                let at = at.trim().parse::<f64>().ok().filter(|v| v.is_finite());
                (axis.trim(), Some(at.ok_or_else(wrong)?))
            }
            None => (text, None),
        };
        let axis = ["x", "y", "z"].iter().position(|a| *a == axis);
        Ok(Plane {
            axis: axis.ok_or_else(wrong)?,
            at,
        })
    }
}

/// How values become colours.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Colours {
    /// What the ends of the colours stand for; chosen by the values if not given.
    pub range: Option<[f64; 2]>,
    /// How many colours there are; as many as there are values if not given.
    pub bands: Option<u32>,
    /// What is below is drawn as nothing.
    pub threshold: Option<f64>,
}

/// By how much bodies that touch are drawn apart, so that their surfaces are seen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Apart {
    /// As far as the surfaces of contact need, where a field of them is drawn in space.
    Auto,
    /// So far `[length]`.
    By(f64),
}

impl FromStr for Apart {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "auto" => Ok(Apart::Auto),
            _ => match text.parse::<f64>() {
                Ok(x) if x.is_finite() && x >= 0.0 => Ok(Apart::By(x)),
                _ => Err("`auto`, or a length from 0".into()),
            },
        }
    }
}

/// How a picture of the bodies is made.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    /// Name of the field in colour; chosen by what there is if not given.
    pub field: Option<String>,
    /// Which times.
    pub when: When,
    /// The mode whose shape is drawn in place of the fields: its number in the last step with modes, or `STEP:MODE`.
    pub mode: Option<String>,
    /// Factor of the displacements; chosen if not given.
    pub scale: Option<f64>,
    /// From where one looks; chosen if not given.
    pub view: Option<View>,
    /// The bodies to be drawn, by name; all, or those that carry a field of contact, if empty.
    pub bodies: Vec<String>,
    /// Width and height `[pixels]`.
    pub size: [u32; 2],
    /// Which part is seen.
    pub zoom: Zoom,
    /// What is in the middle `[length]`; chosen if not given.
    pub at: Option<[f64; 3]>,
    /// Whether tractions are drawn as arrows; in contact views of plane problems if not given.
    pub arrows: Option<bool>,
    /// Only cells in front of this plane, whose middle is below it, are drawn.
    pub cut: Option<Plane>,
    /// Planes of symmetry, beyond which the other half is drawn too.
    pub mirrors: Vec<Plane>,
    /// How values become colours.
    pub colours: Colours,
    /// By how much bodies that touch are drawn apart.
    pub apart: Apart,
    /// Whether supports and loads are drawn as symbols, and the outline of the bodies before any displacement.
    pub loads: bool,
    /// Units for the legend; those that the problem gives if not given.
    pub units: Option<Units>,
}

impl Default for Picture {
    fn default() -> Self {
        Picture {
            field: None,
            when: When::Peak,
            mode: None,
            scale: None,
            view: None,
            bodies: Vec::new(),
            size: [1200, 900],
            zoom: Zoom::Auto,
            at: None,
            arrows: None,
            cut: None,
            mirrors: Vec::new(),
            colours: Colours::default(),
            apart: Apart::Auto,
            loads: false,
            units: None,
        }
    }
}
