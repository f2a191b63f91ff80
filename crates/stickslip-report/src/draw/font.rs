//! The letters that are built in: a part of DejaVu Sans (`assets/vendor/LICENSE-DejaVu.txt`).

use tiny_skia::{Path, PathBuilder};
use ttf_parser::{Face, OutlineBuilder};

const FONT_FILE: &[u8] = include_bytes!("../../assets/vendor/DejaVuSans-subset.ttf");

fn face() -> Option<Face<'static>> {
    Face::parse(FONT_FILE, 0).ok()
}

/// Width of a text of this size `[pixels]`.
pub fn width(text: &str, size: f64) -> f64 {
    let Some(face) = face() else {
        return 0.6 * size * text.chars().count() as f64;
    };
    let units = f64::from(face.units_per_em());
    let advance = |c| {
        let glyph = face.glyph_index(c).unwrap_or_default();
        f64::from(face.glyph_hor_advance(glyph).unwrap_or(0))
    };
    text.chars().map(advance).sum::<f64>() * size / units
}

/// Takes an outline to its place on the picture.
struct Pencil {
    path: PathBuilder,
    scale: f32,
    pen: f32,
}

impl Pencil {
    fn at(&self, x: f32, y: f32) -> (f32, f32) {
        (self.pen + self.scale * x, -self.scale * y)
    }
}

impl OutlineBuilder for Pencil {
    fn move_to(&mut self, x: f32, y: f32) {
        let (x, y) = self.at(x, y);
        self.path.move_to(x, y);
    }
    fn line_to(&mut self, x: f32, y: f32) {
        let (x, y) = self.at(x, y);
        self.path.line_to(x, y);
    }
    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        let ((x1, y1), (x, y)) = (self.at(x1, y1), self.at(x, y));
        self.path.quad_to(x1, y1, x, y);
    }
    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        let ((x1, y1), (x2, y2), (x, y)) = (self.at(x1, y1), self.at(x2, y2), self.at(x, y));
        self.path.cubic_to(x1, y1, x2, y2, x, y);
    }
    fn close(&mut self) {
        self.path.close();
    }
}

/// The outline of a text whose base line begins at the origin. A letter that is not there is an empty box.
pub fn outline(text: &str, size: f64) -> Option<Path> {
    let face = face()?;
    let scale = (size / f64::from(face.units_per_em())) as f32;
    let mut pencil = Pencil {
        path: PathBuilder::new(),
        scale,
        pen: 0.0,
    };
    for c in text.chars() {
        let glyph = face.glyph_index(c).unwrap_or_default();
        face.outline_glyph(glyph, &mut pencil);
        pencil.pen += scale * f32::from(face.glyph_hor_advance(glyph).unwrap_or(0));
    }
    pencil.path.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_of_numbers_and_formulas_are_there() {
        let face = face().unwrap();
        for c in "0123456789.,+-−eE×·µμσταβγδΔ°²³±≤≥→ÄÖÜäöüßéŁ".chars()
        {
            assert!(face.glyph_index(c).is_some(), "{c}");
        }
        assert!(width("MM", 10.0) > width("ii", 10.0));
        assert!((width("abc", 20.0) - 2.0 * width("abc", 10.0)).abs() < 1e-9);
        let outline = outline("H", 100.0).unwrap().bounds();
        assert!((outline.height() - 73.0).abs() < 2.0, "{outline:?}");
    }
}
