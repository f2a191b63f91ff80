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
const GRID_INK: Rgb = [222, 226, 232];

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
    /// Names and values along an axis of their own at the right.
    pub right: Vec<(&'a str, &'a [f64])>,
    /// The status at each value of the axis; empty for none.
    pub statuses: &'a [f64],
}

/// A vertical axis: what its ends stand for, its ticks with their labels, and how wide these are.
struct Side {
    ends: [f64; 2],
    labels: Vec<(f64, String)>,
    wide: f64,
}

/// The ends of an axis for values between these, with room at both in parts of it.
fn spread([low, high]: [f64; 2], room: f64) -> [f64; 2] {
    if high > low {
        return [low - room * (high - low), high + room * (high - low)];
    }
    let half = if low == 0.0 { 1.0 } else { 0.1 * low.abs() };
    [low - half, high + half]
}

impl<'a> Chart<'a> {
    /// The axis of some lines; `None` if they hold no numbers in the part that is shown.
    fn side(&self, lines: &[(&'a str, &'a [f64])], em: f64) -> Option<Side> {
        let inside = |i: usize| (self.from..=self.to).contains(&self.x[i]);
        let all = lines.iter().flat_map(|(_, y)| y.iter().enumerate());
        let all = all.filter(|(i, _)| inside(*i)).map(|(_, y)| *y);
        let ends = spread(crate::field::range(all)?, 0.05);
        let ticks = axis::ticks(ends[0], ends[1], 7);
        let texts = axis::labels(&ticks, 5);
        let labels: Vec<(f64, String)> = ticks.into_iter().zip(texts).collect();
        let wide = labels.iter().map(|(_, text)| text_width(text, em));
        Some(Side {
            ends,
            wide: wide.fold(0.0, f64::max),
            labels,
        })
    }

    /// Draws it; `None` if the lines hold no numbers.
    pub fn draw(&self, size: [u32; 2], canvas: &mut dyn Canvas) -> Option<()> {
        let [width, height] = size.map(f64::from);
        let em = (width.min(height * 1.4) / 62.0).clamp(9.0, 60.0);
        let [x0, x1] = spread([self.from, self.to], 0.0);
        let own = self.side(&self.lines, em)?;
        let other = self.side(&self.right, em);
        let margin = 1.6 * em;
        let top = self.headline(margin, [width, em], canvas);
        let right_names: Vec<String> = (self.right.iter())
            .map(|(name, _)| format!("{name} (right)"))
            .collect();
        let names = self.lines.iter().map(|(name, _)| *name);
        let names: Vec<&str> = names
            .chain(right_names.iter().map(String::as_str))
            .collect();
        let legend_end = legend(&names, [margin, top], width - margin, em, canvas);
        let (left, top) = (margin + own.wide + 0.8 * em, legend_end + 1.2 * em);
        let right = width - margin - other.as_ref().map_or(0.0, |side| side.wide + 0.8 * em);
        let below = if self.statuses.is_empty() { 4.2 } else { 8.6 };
        let bottom = height - below * em;
        let px = |v: f64| left + (v - x0) / (x1 - x0) * (right - left);
        let place = |side: &Side, v: f64| {
            bottom - (v - side.ends[0]) / (side.ends[1] - side.ends[0]) * (bottom - top)
        };
        for (tick, label) in &own.labels {
            let y = place(&own, *tick);
            let pen = Pen::new(if *tick == 0.0 { SOFT } else { GRID_INK }, 0.07 * em);
            canvas.line(&[[left, y], [right, y]], pen);
            let at = [left - 0.6 * em, y + 0.36 * em];
            canvas.text(at, label, em, Anchor::End, SOFT, false);
        }
        for (tick, label) in other.iter().flat_map(|side| &side.labels) {
            let y = other.as_ref().map_or(0.0, |side| place(side, *tick));
            let dash = [[right, y], [right + 0.3 * em, y]];
            canvas.line(&dash, Pen::new(SOFT, 0.1 * em));
            let at = [right + 0.6 * em, y + 0.36 * em];
            canvas.text(at, label, em, Anchor::Start, SOFT, false);
        }
        let ticks = axis::ticks(x0, x1, 8);
        for (tick, text) in ticks.iter().zip(axis::labels(&ticks, 5)) {
            let x = px(*tick);
            canvas.line(&[[x, top], [x, bottom]], Pen::new(GRID_INK, 0.07 * em));
            let at = [x, bottom + 1.5 * em];
            canvas.text(at, &text, em, Anchor::Middle, SOFT, false);
        }
        let mut frame = vec![[left, top], [left, bottom], [right, bottom]];
        frame.extend(other.as_ref().map(|_| [right, top]));
        canvas.line(&frame, Pen::new(SOFT, 0.1 * em));
        let at = [(left + right) / 2.0, bottom + 3.2 * em];
        canvas.text(at, self.along, 1.05 * em, Anchor::Middle, INK, false);
        let lines = self.lines.iter().map(|(_, y)| (*y, Some(&own)));
        let lines = lines.chain(self.right.iter().map(|(_, y)| (*y, other.as_ref())));
        for (i, (y, side)) in lines.enumerate() {
            let Some(side) = side else { continue };
            for run in runs(self.x, y, [self.from, self.to]) {
                let points = run.iter().map(|&[x, y]| [px(x), place(side, y)]);
                curve(&points.collect::<Vec<_>>(), i, em, canvas);
            }
        }
        if !self.statuses.is_empty() {
            self.band([left, right], bottom + 4.4 * em, &px, em, canvas);
        }
        Some(())
    }

    /// Draws title and words; returns where they end.
    fn headline(&self, margin: f64, [width, em]: [f64; 2], canvas: &mut dyn Canvas) -> f64 {
        let size = 1.35 * em;
        let title = shorten(self.title, size, width - 2.0 * margin);
        canvas.text([margin, 2.1 * em], &title, size, Anchor::Start, INK, false);
        if self.words.is_empty() {
            return 3.9 * em;
        }
        let at = [margin, 3.7 * em];
        canvas.text(at, self.words, em, Anchor::Start, SOFT, false);
        5.7 * em
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

/// Draws a line, with a mark at each of its points where they are few.
fn curve(points: &[[f64; 2]], i: usize, em: f64, canvas: &mut dyn Canvas) {
    canvas.line(points, pen(i, em));
    if points.len() <= 60 {
        for [x, y] in points {
            let r = 0.22 * em;
            canvas.rectangle([x - r, y - r], [2.0 * r, 2.0 * r], INKS[i % INKS.len()]);
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
fn legend(names: &[&str], at: [f64; 2], right: f64, em: f64, canvas: &mut dyn Canvas) -> f64 {
    let [left, mut y] = at;
    let mut x = left;
    for (i, name) in names.iter().enumerate() {
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
