//! What is drawn over the bodies: tractions as arrows, and where the pressure is largest.

use super::axis;
use super::raster::FINE;
use super::words::INK;
use crate::colour::{self, Rgb};
use crate::draw::{Anchor, Canvas, Pen, text_width};
use crate::sheet::Sheet;
use crate::units::Units;

/// The drawing of the bodies, as far as it has to be known.
pub struct Drawn<'a> {
    /// From space to the raster.
    pub see: &'a dyn Fn([f64; 3]) -> [f64; 3],
    /// Whether something is drawn in front of a place on the raster.
    pub hides: &'a dyn Fn([f64; 3]) -> bool,
    /// Where a point of contact is drawn, on either side.
    pub places: &'a dyn Fn(&Sheet, usize) -> Vec<[f64; 3]>,
    /// Where it is on the canvas, and how large.
    pub at: [f64; 2],
    pub area: [f64; 2],
    pub em: f64,
}

impl Drawn<'_> {
    /// Where a point of space is on the canvas; `None` beside the drawing, or behind something.
    pub fn place(&self, x: [f64; 3]) -> Option<[f64; 2]> {
        let seen = (self.see)(x);
        let p = [0, 1].map(|c| seen[c] / FINE as f64);
        let within = (0..2).all(|c| (0.0..=self.area[c]).contains(&p[c]));
        (within && !(self.hides)(seen)).then(|| [0, 1].map(|c| self.at[c] + p[c]))
    }

    /// Where a point of contact is on the canvas, on a side that is seen.
    fn contact(&self, sheet: &Sheet, point: usize) -> Option<[f64; 2]> {
        let places = (self.places)(sheet, point);
        places.into_iter().find_map(|x| self.place(x))
    }

    /// The direction of a vector of space on the canvas, as long as it is seen there with length one a unit.
    pub fn towards(&self, v: [f64; 3]) -> [f64; 2] {
        let (a, b) = ((self.see)([0.0; 3]), (self.see)(v));
        let size = v.iter().map(|x| x * x).sum::<f64>().sqrt();
        let [dx, dy] = [b[0] - a[0], b[1] - a[1]];
        let length = dx.hypot(dy);
        match length > 0.0 {
            true => [dx, dy].map(|d| d / length * size),
            false => [0.0; 2],
        }
    }
}

/// The colour of the status of a point, dark enough for a thin line.
pub fn ink(sheet: &Sheet, point: usize) -> Rgb {
    match sheet.numbers("CSTATUS").get(point) {
        Some(status) if *status >= 0.5 => colour::STATUSES[status.round().min(2.0) as usize].1,
        _ => INK,
    }
}

/// Draws an arrow with its head at `to`.
pub fn arrow(from: [f64; 2], to: [f64; 2], ink: Rgb, em: f64, canvas: &mut dyn Canvas) {
    let d = [to[0] - from[0], to[1] - from[1]];
    let length = d[0].hypot(d[1]);
    if length < 0.15 * em {
        return;
    }
    let head = (0.7 * em).min(0.6 * length);
    let [tx, ty] = d.map(|x| x / length);
    let neck = [to[0] - head * tx, to[1] - head * ty];
    let wide = 0.34 * head;
    canvas.line(&[from, neck], Pen::new(ink, 0.13 * em));
    let sides = [1.0, -1.0].map(|s| [neck[0] - s * wide * ty, neck[1] + s * wide * tx]);
    canvas.fill(&[to, sides[0], sides[1]], ink);
}

/// Draws the tractions of contact on the secondary, the longest a tenth of the drawing, in the colour of stick and slip. In a plane they end at the surface that they
/// press on; in space, where pressure would stand on the eye, they are the shear tractions and begin at their points.
pub fn arrows(sheets: &[Sheet], drawn: &Drawn, dim: usize, canvas: &mut dyn Canvas) {
    let name = if dim == 2 { "CTRACTION" } else { "CSHEAR" };
    let size = |v: [f64; 3]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
    let points = |sheet: &Sheet| 0..sheet.grid.points.points.len();
    let all = sheets
        .iter()
        .flat_map(|s| points(s).map(move |i| (s, i, s.vector(name, i))));
    let mut all: Vec<(&Sheet, usize, [f64; 3])> = all.filter(|v| size(v.2).is_finite()).collect();
    // Where points are too close for an arrow each the largest traction has it.
    all.sort_by(|a, b| size(b.2).total_cmp(&size(a.2)));
    let most = all.first().map_or(0.0, |v| size(v.2));
    if most <= 0.0 {
        return;
    }
    let longest = 0.11 * drawn.area[0].min(drawn.area[1]);
    let mut taken: Vec<[f64; 2]> = Vec::new();
    let apart = if dim == 2 { 0.75 } else { 1.4 } * drawn.em;
    for (sheet, i, t) in all {
        let Some(p) = drawn.contact(sheet, i) else {
            continue;
        };
        let near = |q: &[f64; 2]| (q[0] - p[0]).hypot(q[1] - p[1]) < apart;
        if size(t) < 0.01 * most || taken.iter().any(near) {
            continue;
        }
        taken.push(p);
        let d = drawn.towards(t).map(|x| x / most * longest);
        let (from, to) = match dim {
            2 => ([p[0] - d[0], p[1] - d[1]], p),
            _ => (p, [p[0] + d[0], p[1] + d[1]]),
        };
        let ink = ink(sheet, i);
        // On a surface that has the same colour.
        let dark = ink.map(|c| (f64::from(c) * 0.45) as u8);
        let ink = if dim == 2 { ink } else { dark };
        arrow(from, to, ink, drawn.em, canvas);
    }
}

/// Marks the point with the largest pressure, where nothing hides it.
pub fn peak(
    sheet: &Sheet,
    point: usize,
    most: f64,
    drawn: &Drawn,
    units: &Units,
    canvas: &mut dyn Canvas,
) {
    let traction = sheet.vector("CTRACTION", point);
    let Some([x, y]) = drawn.contact(sheet, point) else {
        return;
    };
    let em = drawn.em;
    let text = format!("peak {} {}", axis::number(most, 3), units.stress);
    let text = text.trim_end();
    let wide = text_width(text, em);
    // Away from where arrows come from.
    let t = drawn.towards(traction);
    let size = t[0].hypot(t[1]);
    let side = if size > 0.0 && t[0] < -0.05 * size {
        -1.0
    } else {
        1.0
    };
    let side = match x + 3.0 * em + wide < drawn.at[0] + drawn.area[0]
        && x - 3.0 * em - wide > drawn.at[0]
    {
        true => side,
        false if x + 3.0 * em + wide < drawn.at[0] + drawn.area[0] => 1.0,
        false => -1.0,
    };
    let right = side > 0.0;
    let rise = if size > 0.0 && t[1] > 0.05 * size {
        3.0
    } else {
        -3.0
    } * em;
    let up = (y + rise).clamp(drawn.at[1] + 1.5 * em, drawn.at[1] + drawn.area[1] - em);
    let end = [x + side * 2.2 * em, up];
    let ring: Vec<[f64; 2]> = (0..=24)
        .map(|k| {
            let (sin, cos) = (std::f64::consts::TAU * f64::from(k) / 24.0).sin_cos();
            [x + 0.55 * em * cos, y + 0.55 * em * sin]
        })
        .collect();
    canvas.line(&ring, Pen::new([255; 3], 0.34 * em));
    canvas.line(&ring, Pen::new(INK, 0.16 * em));
    // The line ends at the box around the text.
    let start = match right {
        true => end[0] + 0.3 * em,
        false => end[0] - wide - 0.3 * em,
    };
    canvas.rectangle(
        [start - 0.3 * em, up - 0.95 * em],
        [wide + 0.6 * em, 1.4 * em],
        [255; 3],
    );
    canvas.line(
        &[[x + side * 0.4 * em, y - 0.5 * em], end],
        Pen::new(INK, 0.1 * em),
    );
    canvas.text([start, up + 0.15 * em], text, em, Anchor::Start, INK, false);
}
