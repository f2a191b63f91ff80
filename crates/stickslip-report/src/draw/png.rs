//! A canvas of pixels.

use tiny_skia::{
    Color, FillRule, FilterQuality, LineCap, LineJoin, Paint, PathBuilder, Pixmap, PixmapPaint,
    Stroke, StrokeDash, Transform,
};

use super::font;

use super::canvas::{Anchor, Canvas, Pen};
use crate::colour::Rgb;

/// A picture in pixels.
pub struct Png(Pixmap);

impl Png {
    /// A white picture; `None` if it would be empty or too large.
    pub fn new([width, height]: [u32; 2]) -> Option<Self> {
        let mut map = Pixmap::new(width, height)?;
        map.fill(Color::WHITE);
        Some(Png(map))
    }

    /// Red, green and blue of each pixel.
    pub fn pixels(&self) -> Vec<u8> {
        let all = self.0.pixels().iter();
        all.flat_map(|p| [p.red(), p.green(), p.blue()]).collect()
    }
}

fn paint([r, g, b]: Rgb) -> Paint<'static> {
    let mut paint = Paint::default();
    paint.set_color_rgba8(r, g, b, 255);
    paint
}

fn path(points: &[[f64; 2]], close: bool) -> Option<tiny_skia::Path> {
    let mut builder = PathBuilder::new();
    for (i, [x, y]) in points.iter().enumerate() {
        match i {
            0 => builder.move_to(*x as f32, *y as f32),
            _ => builder.line_to(*x as f32, *y as f32),
        }
    }
    if close {
        builder.close();
    }
    builder.finish()
}

impl Canvas for Png {
    fn fill(&mut self, points: &[[f64; 2]], colour: Rgb) {
        if let Some(path) = path(points, true) {
            let same = Transform::identity();
            self.0
                .fill_path(&path, &paint(colour), FillRule::Winding, same, None);
        }
    }

    fn line(&mut self, points: &[[f64; 2]], pen: Pen) {
        let Some(path) = path(points, false) else {
            return;
        };
        let stroke = Stroke {
            width: pen.width as f32,
            line_cap: LineCap::Butt,
            line_join: LineJoin::Round,
            dash: pen
                .dash
                .and_then(|[on, off]| StrokeDash::new(vec![on as f32, off as f32], 0.0)),
            ..Stroke::default()
        };
        let same = Transform::identity();
        self.0
            .stroke_path(&path, &paint(pen.colour), &stroke, same, None);
    }

    fn text(&mut self, at: [f64; 2], text: &str, size: f64, anchor: Anchor, colour: Rgb, up: bool) {
        let Some(path) = font::outline(text, size) else {
            return;
        };
        let back = match anchor {
            Anchor::Start => 0.0,
            Anchor::Middle => font::width(text, size) / 2.0,
            Anchor::End => font::width(text, size),
        };
        let turned = match up {
            true => Transform::from_row(0.0, -1.0, 1.0, 0.0, at[0] as f32, at[1] as f32),
            false => Transform::from_translate(at[0] as f32, at[1] as f32),
        };
        let place = turned.pre_translate(-back as f32, 0.0);
        self.0
            .fill_path(&path, &paint(colour), FillRule::Winding, place, None);
    }

    fn picture(&mut self, [x, y]: [f64; 2], size: [usize; 2], fine: usize, pixels: &[u8]) {
        if let Some(map) = pixmap(size, pixels) {
            let small = 1.0 / fine as f32;
            let place = Transform::from_translate(x as f32, y as f32).pre_scale(small, small);
            let paint = PixmapPaint {
                quality: FilterQuality::Bilinear,
                ..PixmapPaint::default()
            };
            self.0.draw_pixmap(0, 0, map.as_ref(), &paint, place, None);
        }
    }

    fn finish(self: Box<Self>) -> Vec<u8> {
        encode(&self.0)
    }
}

fn pixmap(size: [usize; 2], pixels: &[u8]) -> Option<Pixmap> {
    let mut map = Pixmap::new(size[0] as u32, size[1] as u32)?;
    for (to, from) in map.pixels_mut().iter_mut().zip(pixels.as_chunks::<4>().0) {
        let [r, g, b, a] = *from;
        *to = tiny_skia::ColorU8::from_rgba(r, g, b, a).premultiply();
    }
    Some(map)
}

fn encode(map: &Pixmap) -> Vec<u8> {
    map.encode_png().expect("writing to memory does not fail")
}

/// A picture as a PNG file.
pub fn file(size: [usize; 2], pixels: &[u8]) -> Option<Vec<u8>> {
    Some(encode(&pixmap(size, pixels)?))
}
