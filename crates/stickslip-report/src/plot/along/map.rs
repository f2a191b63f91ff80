//! Maps of a surface in space: its pressure, and beside it stick and slip with the shear as arrows; of a tie the normal and the shear traction.

use super::super::camera::Frame;
use super::super::marks::{Drawn, arrow, ink};
use super::super::picture::Zoom;
use super::super::raster::{Corner, FINE, Raster};
use super::super::words::{INK, SOFT, shorten};
use super::super::zoom::{self, Box2};
use super::super::{axis, legend};
use super::page::Page;
use super::unroll;
use crate::colour::Scale;
use crate::draw::{Anchor, Canvas, Pen};
use crate::field::{Field, Part, STATUS};
use crate::sheet::Sheet;
use crate::units::behind;

/// Widths in heights of letters: the margin, the numbers at the left of a map, the colour bar at its right.
const MARGIN: f64 = 1.6;
const NUMBERS: f64 = 3.0;
const BAR: f64 = 9.5;

/// The room for each of two maps, and the way from the first to the second: side by side, or one above the other, whichever leaves them larger.
fn layout(seen: Box2, [width, height]: [f64; 2], em: f64) -> ([f64; 2], [f64; 2]) {
    let (tall, wide) = (seen[1][1] - seen[0][1], seen[1][0] - seen[0][0]);
    let around = (NUMBERS + BAR) * em;
    let beside = [
        (width - 3.0 * MARGIN * em) / 2.0 - around,
        height - 8.4 * em,
    ];
    let above = [
        width - 2.0 * MARGIN * em - around,
        (height - 12.0 * em) / 2.0,
    ];
    let fit = |room: [f64; 2]| (room[0] / wide.max(1e-300)).min(room[1] / tall.max(1e-300));
    match fit(beside) >= fit(above) {
        // As near as the first leaves room.
        true => {
            let step = fit(beside) * wide + around + MARGIN * em;
            (beside, [step, 0.0])
        }
        false => (above, [0.0, above[1] + 4.0 * em]),
    }
}

/// Draws both maps.
pub fn draw(sheet: &Sheet, page: &Page, canvas: &mut dyn Canvas) -> Result<(), String> {
    let plan = unroll::plan(sheet);
    let mut whole = zoom::EMPTY_BOX;
    let mut patch = zoom::EMPTY_BOX;
    for p in &plan {
        zoom::include(&mut whole, [p[0], p[1], 0.0]);
    }
    for i in sheet.pressing() {
        zoom::include(&mut patch, [plan[i][0], plan[i][1], 0.0]);
    }
    let seen = match page.zoom {
        // The part beyond what presses tells nothing.
        Zoom::Auto if patch[0][0] <= patch[1][0] => zoom::seen(whole, patch, Zoom::Contact, None),
        Zoom::Auto => Ok(whole),
        other => zoom::seen(whole, patch, other, None),
    }?;
    let seen = [0, 1].map(|end| {
        // Nothing is beyond the surface.
        [0, 1].map(|c| {
            if end == 0 {
                seen[0][c].max(whole[0][c])
            } else {
                seen[1][c].min(whole[1][c])
            }
        })
    });
    let [width, height] = page.size.map(f64::from);
    let em = (width.min(height * 1.4) / 62.0).clamp(9.0, 60.0);
    let margin = MARGIN * em;
    let title = shorten(&page.title, 1.35 * em, width - 2.0 * margin);
    canvas.text(
        [margin, 2.1 * em],
        &title,
        1.35 * em,
        Anchor::Start,
        INK,
        false,
    );
    let length = behind(&page.units.length);
    let words = format!("{}; along the surface{length}", page.words);
    canvas.text(
        [margin, 3.7 * em],
        &shorten(&words, em, width - 2.0 * margin),
        em,
        Anchor::Start,
        SOFT,
        false,
    );
    let (room, step) = layout(seen, [width, height], em);
    let names = match sheet.tied() {
        true => ["TNORMAL", "TSHEAR"],
        false => ["CPRESS", STATUS],
    };
    for (k, name) in names.into_iter().enumerate() {
        let at = [0, 1].map(|c| [margin + NUMBERS * em, 5.6 * em][c] + k as f64 * step[c]);
        let one = Panel {
            sheet,
            plan: &plan,
            seen,
            at,
            room,
            em,
        };
        one.draw(name, k == 1, page, canvas);
    }
    Ok(())
}

/// One map.
struct Panel<'a> {
    sheet: &'a Sheet,
    plan: &'a [[f64; 2]],
    seen: Box2,
    at: [f64; 2],
    room: [f64; 2],
    em: f64,
}

impl Panel<'_> {
    /// Draws a field, a vector by its magnitude, and arrows of the shear if they are wanted.
    fn draw(&self, name: &str, arrows: bool, page: &Page, canvas: &mut dyn Canvas) {
        let em = self.em;
        let fine = FINE as f64;
        let span = [0, 1].map(|c| (self.seen[1][c] - self.seen[0][c]).max(1e-300));
        let zoom = (self.room[0] / span[0]).min(self.room[1] / span[1]);
        let area = span.map(|s| (s * zoom).max(2.0 * em));
        let frame = Frame::fit(self.seen[0], self.seen[1], [0.0; 2], area.map(|a| a * fine));
        let array = self.sheet.grid.points.arrays.get(name);
        let field = Field {
            name: name.into(),
            array: name.into(),
            part: match array {
                Some(array) if array.components > 1 => Part::Magnitude,
                _ => Part::Component(0),
            },
        };
        let count = self.plan.len();
        let values: Vec<f64> = match array {
            Some(array) => (0..count).map(|i| field.value(array, i)).collect(),
            None => vec![f64::NAN; count],
        };
        let [low, high] = crate::field::range(values.iter().copied()).unwrap_or([0.0; 2]);
        let signed = low < 0.0;
        let most = high.max(-low);
        let colours = Scale {
            range: [if signed { -most } else { 0.0 }, most],
            signed,
            status: name == STATUS,
            carried: !signed,
            ..Scale::default()
        };
        let mut raster = Raster::new(area.map(|a| (a * fine) as usize));
        self.paint(&values, &colours, &frame, &mut raster);
        canvas.picture(
            self.at,
            area.map(|a| (a * fine) as usize),
            FINE,
            &raster.pixels,
        );
        self.axes(area, &frame, canvas);
        let unit = behind(page.units.of_field(&field));
        let place = [self.at[0] + area[0] + 1.2 * em, self.at[1]];
        let shown = legend::Shown {
            field: &field,
            unit: &unit,
            colours: &colours,
            values: &values,
            words: &[axis::between([low, high])],
            // Those of this interface alone.
            statuses: Some([0.0, 1.0, 2.0].map(|s| values.iter().filter(|v| **v == s).count())),
        };
        let size = [(BAR - 1.2) * em, area[1].max(12.0 * em)];
        legend::bar(&shown, place, size, em, canvas);
        if arrows {
            self.arrows(area, &frame, canvas);
        }
    }

    fn paint(&self, values: &[f64], colours: &Scale, frame: &Frame, raster: &mut Raster) {
        let grid = &self.sheet.grid;
        let at = |p: usize| frame.place([self.plan[p][0], self.plan[p][1], 0.0]);
        let half = {
            let [low, high] =
                crate::field::range(self.plan.iter().map(|p| p[0])).unwrap_or([0.0; 2]);
            0.5 * (high - low)
        };
        for i in 0..grid.types.len() {
            let cell = grid.cell(i);
            // A face that was cut by unrolling would lie over all others.
            let spread = crate::field::range(cell.iter().map(|&p| self.plan[p][0]));
            if cell.len() < 3 || (grid.types.len() > 8 && spread.is_some_and(|[a, b]| b - a > half))
            {
                continue;
            }
            for k in 1..cell.len() - 1 {
                let corners = [cell[0], cell[k], cell[k + 1]].map(|p| Corner {
                    at: at(p),
                    value: values.get(p).copied().unwrap_or(f64::NAN),
                });
                raster.triangle(corners, colours, 1.0);
            }
            for k in 0..cell.len() {
                let ends = [at(cell[k]), at(cell[(k + 1) % cell.len()])];
                raster.line(ends, 0.5 * FINE as f64, 1.0, INK, 0.12);
            }
        }
    }

    /// A frame with numbers along its sides.
    fn axes(&self, area: [f64; 2], frame: &Frame, canvas: &mut dyn Canvas) {
        let (em, at) = (self.em, self.at);
        let [x, y] = [at[0], at[1] + area[1]];
        let rim = [
            at,
            [at[0] + area[0], at[1]],
            [at[0] + area[0], y],
            [x, y],
            at,
        ];
        canvas.line(&rim, Pen::new(SOFT, 0.08 * em));
        let place = |p: [f64; 2]| frame.place([p[0], p[1], 0.0]).map(|v| v / FINE as f64);
        let count = |c: usize| ((area[c] / (6.0 * em)) as usize).clamp(1, 6);
        for tick in axis::ticks(self.seen[0][0], self.seen[1][0], count(0)) {
            let px = x + place([tick, 0.0])[0];
            canvas.line(&[[px, y], [px, y + 0.4 * em]], Pen::new(SOFT, 0.08 * em));
            canvas.text(
                [px, y + 1.5 * em],
                &axis::number(tick, 3),
                0.85 * em,
                Anchor::Middle,
                SOFT,
                false,
            );
        }
        for tick in axis::ticks(self.seen[0][1], self.seen[1][1], count(1)) {
            let py = at[1] + place([0.0, tick])[1];
            canvas.line(&[[x - 0.4 * em, py], [x, py]], Pen::new(SOFT, 0.08 * em));
            canvas.text(
                [x - 0.6 * em, py + 0.3 * em],
                &axis::number(tick, 3),
                0.85 * em,
                Anchor::End,
                SOFT,
                false,
            );
        }
    }

    /// Shear tractions, thinned out; a vector is laid into the map by where its end would be.
    fn arrows(&self, area: [f64; 2], frame: &Frame, canvas: &mut dyn Canvas) {
        let em = self.em;
        let count = self.plan.len();
        let size = |t: [f64; 3]| t.iter().map(|v| v * v).sum::<f64>().sqrt();
        let sizes = (0..count).map(|i| size(self.sheet.shear(i)));
        let most = sizes.filter(|v| v.is_finite()).fold(0.0, f64::max);
        if most <= 0.0 {
            return;
        }
        let base = unroll::base(self.sheet);
        let drawn = Drawn {
            see: &|x| frame.place(x),
            hides: &|_| false,
            places: &|_, _| Vec::new(),
            at: self.at,
            area,
            em,
        };
        let mut taken: Vec<[f64; 2]> = Vec::new();
        for i in 0..count {
            let Some(p) = drawn.place([self.plan[i][0], self.plan[i][1], 0.0]) else {
                continue;
            };
            let t = self.sheet.shear(i);
            let size = size(t);
            let near = |q: &[f64; 2]| (q[0] - p[0]).hypot(q[1] - p[1]) < 1.9 * em;
            if size.is_nan() || size <= 0.03 * most || taken.iter().any(near) {
                continue;
            }
            taken.push(p);
            let [right, up] = base(self.sheet.grid.points.points[i]);
            let along = |e: [f64; 3]| (0..3).map(|c| e[c] * t[c]).sum::<f64>() / most * 2.4 * em;
            let end = [p[0] + along(right), p[1] - along(up)];
            let dark = ink(self.sheet, i).map(|c| (f64::from(c) * 0.45) as u8);
            arrow(p, end, dark, em, canvas);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Maps with their numbers and legends stay on the page, whatever their shape; of long ones the second is below the first.
    #[test]
    fn both_maps_fit_on_the_page() {
        for [width, height] in [[1200.0, 900.0], [1000.0, 520.0], [1000.0, 420.0]] {
            for wide in [0.2, 1.0, 3.0, 20.0] {
                let em = f64::min(width, height * 1.4) / 62.0;
                let (room, step) = layout([[0.0; 2], [wide, 1.0]], [width, height], em);
                let zoom = f64::min(room[0] / wide, room[1]);
                let right = (MARGIN + NUMBERS + BAR) * em + step[0] + zoom * wide;
                let below = 5.6 * em + step[1] + zoom;
                assert!(right <= width - 0.5 * MARGIN * em, "{right} {width} {wide}");
                assert!(below <= height - em, "{below} {height} {wide}");
                assert!(wide != 0.2 || step[0] > 0.0, "tall maps stand side by side");
                assert!(
                    wide != 20.0 || step[1] > 0.0,
                    "long maps lie one below the other"
                );
            }
        }
    }
}
