//! Lines over an axis, with a legend and a band of statuses below.
//!
//! Drawn by hand, with [`axis`]: charts go to the same canvas as pictures of bodies, PNG or SVG with the letters that are built in. A library of charts
//! would need that canvas wrapped as its own and bring its own choice of letters, for the two hundred lines that it would replace.

use super::axis;
use super::words::{INK, SOFT, shorten};
use crate::colour::{self, Rgb};
use crate::draw::{Anchor, Canvas, Pen, text_width};

/// Colours of lines, told apart by people who are colour-blind (Okabe and Ito).
const INKS: [Rgb; 7] = [
    [0, 114, 178],
    [213, 94, 0],
    [0, 158, 115],
    [204, 121, 167],
    [230, 159, 0],
    [86, 180, 233],
    [110, 110, 110],
];
const GRID: Rgb = [222, 226, 232];

/// What a chart shows.
pub struct Chart<'a> {
    /// Above it.
    pub title: &'a str,
    /// Below the title; may be empty.
    pub words: &'a str,
    /// Values along the axis, and its name.
    pub x: &'a [f64],
    pub along: &'a str,
    /// The part of the axis that is shown.
    pub from: f64,
    pub to: f64,
    /// Names and values.
    pub lines: Vec<(&'a str, &'a [f64])>,
    /// The status at each value of the axis; empty for none.
    pub statuses: &'a [f64],
}

impl Chart<'_> {
    /// Draws it; `None` if the lines hold no numbers.
    pub fn draw(&self, size: [u32; 2], canvas: &mut dyn Canvas) -> Option<()> {
        let (x, lines) = (self.x, &self.lines);
        let [width, height] = size.map(f64::from);
        let em = (width.min(height * 1.4) / 62.0).clamp(9.0, 60.0);
        let spread = |low: f64, high: f64, room: f64| {
            if high > low {
                return [low - room * (high - low), high + room * (high - low)];
            }
            let half = if low == 0.0 { 1.0 } else { 0.1 * low.abs() };
            [low - half, high + half]
        };
        let low = self.from;
        let high = self.to;
        let [x0, x1] = spread(low, high, 0.0);
        let inside = |i: usize| (self.from..=self.to).contains(&self.x[i]);
        let all = lines.iter().flat_map(|(_, y)| y.iter().enumerate());
        let all = all.filter(|(i, _)| inside(*i)).map(|(_, y)| *y);
        let [low, high] = crate::field::range(all)?;
        let [y0, y1] = spread(low, high, 0.05);
        let labels: Vec<(f64, String)> = axis::ticks(y0, y1, 7)
            .into_iter()
            .map(|t| (t, axis::number(t, 5)))
            .collect();
        let widest = labels
            .iter()
            .map(|(_, text)| text_width(text, em))
            .fold(0.0, f64::max);
        // Title, legend, plot, axis.
        let margin = 1.6 * em;
        let title = shorten(self.title, 1.35 * em, width - 2.0 * margin);
        canvas.text(
            [margin, 2.1 * em],
            &title,
            1.35 * em,
            Anchor::Start,
            INK,
            false,
        );
        let mut top = 3.9 * em;
        if !self.words.is_empty() {
            canvas.text(
                [margin, 3.7 * em],
                self.words,
                em,
                Anchor::Start,
                SOFT,
                false,
            );
            top += 1.8 * em;
        }
        let legend_end = legend(lines, [margin, top], width - margin, em, canvas);
        let (left, top) = (margin + widest + 0.8 * em, legend_end + 1.2 * em);
        let (right, bottom) = (
            width - margin,
            height
                - if self.statuses.is_empty() {
                    4.2 * em
                } else {
                    8.6 * em
                },
        );
        let px = |v: f64| left + (v - x0) / (x1 - x0) * (right - left);
        let py = |v: f64| bottom - (v - y0) / (y1 - y0) * (bottom - top);
        for (tick, label) in &labels {
            let y = py(*tick);
            let pen = Pen::new(if *tick == 0.0 { SOFT } else { GRID }, 0.07 * em);
            canvas.line(&[[left, y], [right, y]], pen);
            let at = [left - 0.6 * em, y + 0.36 * em];
            canvas.text(at, label, em, Anchor::End, SOFT, false);
        }
        for tick in axis::ticks(x0, x1, 8) {
            let x = px(tick);
            canvas.line(&[[x, top], [x, bottom]], Pen::new(GRID, 0.07 * em));
            let at = [x, bottom + 1.5 * em];
            canvas.text(at, &axis::number(tick, 5), em, Anchor::Middle, SOFT, false);
        }
        let frame = [[left, top], [left, bottom], [right, bottom]];
        canvas.line(&frame, Pen::new(SOFT, 0.1 * em));
        let at = [(left + right) / 2.0, bottom + 3.2 * em];
        canvas.text(at, self.along, 1.05 * em, Anchor::Middle, INK, false);
        for (i, (_, y)) in lines.iter().enumerate() {
            for run in runs(x, y, [self.from, self.to]) {
                let points: Vec<[f64; 2]> = run.iter().map(|&[x, y]| [px(x), py(y)]).collect();
                canvas.line(&points, pen(i, em));
                if points.len() <= 60 {
                    for [x, y] in points {
                        let r = 0.22 * em;
                        canvas.rectangle([x - r, y - r], [2.0 * r, 2.0 * r], INKS[i % INKS.len()]);
                    }
                }
            }
        }
        if !self.statuses.is_empty() {
            self.band([left, right], bottom + 4.4 * em, &px, em, canvas);
        }
        Some(())
    }

    /// The band of statuses, each point as wide as half the way to its neighbours, and what the colours mean.
    fn band(
        &self,
        [left, right]: [f64; 2],
        y: f64,
        px: &dyn Fn(f64) -> f64,
        em: f64,
        canvas: &mut dyn Canvas,
    ) {
        let count = self.x.len();
        for (i, status) in self
            .statuses
            .iter()
            .enumerate()
            .filter(|(_, s)| s.is_finite())
        {
            let ends = [i.saturating_sub(1), (i + 1).min(count - 1)];
            let ends = ends.map(|k| px((self.x[i] + self.x[k]) / 2.0).clamp(left, right));
            let ink = colour::STATUSES[status.round().clamp(0.0, 2.0) as usize].1;
            if ends[1] > ends[0] {
                canvas.rectangle([ends[0], y], [ends[1] - ends[0], 1.1 * em], ink);
            }
        }
        let mut x = left;
        for &(name, ink) in &colour::STATUSES[..colour::TIED] {
            canvas.rectangle([x, y + 1.9 * em], [em, em], ink);
            canvas.text(
                [x + 1.5 * em, y + 2.75 * em],
                name,
                em,
                Anchor::Start,
                INK,
                false,
            );
            x += 3.0 * em + text_width(name, em);
        }
    }
}

fn pen(i: usize, em: f64) -> Pen {
    Pen {
        colour: INKS[i % INKS.len()],
        width: 0.16 * em,
        // From the eighth on, colours come again with dashes.
        dash: (i >= INKS.len()).then_some([0.6 * em, 0.4 * em]),
    }
}

/// Draws the names; returns where they end.
fn legend(
    lines: &[(&str, &[f64])],
    at: [f64; 2],
    right: f64,
    em: f64,
    canvas: &mut dyn Canvas,
) -> f64 {
    let [left, mut y] = at;
    let mut x = left;
    for (i, (name, _)) in lines.iter().enumerate() {
        let name = shorten(name, em, right - left - 2.2 * em);
        let wide = 2.2 * em + text_width(&name, em);
        if x > left && x + wide > right {
            x = left;
            y += 1.5 * em;
        }
        canvas.line(
            &[[x, y - 0.35 * em], [x + 1.6 * em, y - 0.35 * em]],
            pen(i, em),
        );
        canvas.text([x + 2.2 * em, y], &name, em, Anchor::Start, INK, false);
        x += wide + 1.5 * em;
    }
    y
}

/// Unbroken runs of points where both columns are numbers.
fn runs(x: &[f64], y: &[f64], [from, to]: [f64; 2]) -> Vec<Vec<[f64; 2]>> {
    let mut runs = vec![Vec::new()];
    for (&x, &y) in x.iter().zip(y) {
        match (from..=to).contains(&x) && y.is_finite() {
            true => runs.last_mut().expect("never empty").push([x, y]),
            false => runs.push(Vec::new()),
        }
    }
    runs.retain(|run| !run.is_empty());
    runs
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_missing_value_parts_a_line() {
        let x = [0., 1., 2., 3., 4.];
        let y = [1., f64::NAN, 2., 3., f64::INFINITY];
        assert_eq!(
            runs(&x, &y, [0., 9.]),
            [vec![[0., 1.]], vec![[2., 2.], [3., 3.]]]
        );
    }
}
