//! What can be drawn on.

use crate::colour::Rgb;

/// Where a text has its anchor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Anchor {
    /// At its beginning.
    Start,
    /// In its middle.
    Middle,
    /// At its end.
    End,
}

/// A stroke.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pen {
    /// Its colour.
    pub colour: Rgb,
    /// Its width `[pixels]`.
    pub width: f64,
    /// Length of dashes and of the gaps between them `[pixels]`; none for a whole line.
    pub dash: Option<[f64; 2]>,
}

impl Pen {
    /// A whole line.
    pub fn new(colour: Rgb, width: f64) -> Self {
        Pen {
            colour,
            width,
            dash: None,
        }
    }
}

/// Something to draw on. Coordinates are pixels from the upper left corner.
pub trait Canvas {
    /// Fills a polygon.
    fn fill(&mut self, points: &[[f64; 2]], colour: Rgb);
    /// Draws a line through points.
    fn line(&mut self, points: &[[f64; 2]], pen: Pen);
    /// Writes a text, upright or turned to run upwards, its base line at `at`.
    fn text(&mut self, at: [f64; 2], text: &str, size: f64, anchor: Anchor, colour: Rgb, up: bool);
    /// Puts a picture at `at`: width and height, and red, green, blue, opacity of each of its pixels, which are `1 / fine` wide.
    fn picture(&mut self, at: [f64; 2], size: [usize; 2], fine: usize, pixels: &[u8]);
    /// The file.
    fn finish(self: Box<Self>) -> Vec<u8>;

    /// Fills a rectangle.
    fn rectangle(&mut self, [x, y]: [f64; 2], [w, h]: [f64; 2], colour: Rgb) {
        self.fill(&[[x, y], [x + w, y], [x + w, y + h], [x, y + h]], colour);
    }
}
