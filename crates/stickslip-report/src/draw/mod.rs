//! Drawing without a browser and without fonts of the system: shapes and text into a PNG or an SVG file.

mod canvas;
mod font;
mod motion;
mod png;
mod svg;

pub use canvas::{Anchor, Canvas, Pen};
pub use font::width as text_width;
pub use motion::{Format, Motion};
pub use png::Png;
pub use svg::Svg;

/// A canvas for a file, by the ending of its name: PNG or SVG.
pub fn canvas(file: &std::path::Path, size: [u32; 2]) -> Option<Box<dyn Canvas>> {
    let ending = file.extension()?.to_str()?.to_ascii_lowercase();
    match ending.as_str() {
        "png" => Some(Box::new(Png::new(size)?)),
        "svg" => Some(Box::new(Svg::new(size))),
        _ => None,
    }
}
