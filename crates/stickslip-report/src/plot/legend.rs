//! What is around the bodies: the colour bar and the axes.

use super::axis;
use super::camera::Camera;
use super::raster::FINE;
use super::words::{INK, SOFT, wrap};
use crate::colour::{self, Scale};
use crate::draw::{Anchor, Canvas, Pen};
use crate::field::Field;

/// What a colour bar is of.
pub struct Shown<'a> {
    /// The field.
    pub field: &'a Field,
    /// Its unit, as it is written behind the name.
    pub unit: &'a str,
    /// The colours of its values.
    pub colours: &'a Scale,
    /// Its values.
    pub values: &'a [f64],
    /// What is said of them.
    pub words: &'a [String],
    /// How many contact points are open, stick and slip, where that is known.
    pub statuses: Option<[usize; 3]>,
}

/// Draws the colour bar of a field, or the list of the statuses.
pub fn bar(shown: &Shown, at: [f64; 2], size: [f64; 2], em: f64, canvas: &mut dyn Canvas) {
    let Shown {
        field,
        unit,
        colours,
        values,
        words: said,
        statuses,
    } = *shown;
    let [x, mut y] = at;
    let label = field.label();
    let (name, words) = label.split_once(", ").unwrap_or((&label, ""));
    let name = format!("{name}{unit}");
    canvas.text([x, y + em], &name, 1.1 * em, Anchor::Start, INK, false);
    y += 1.4 * em;
    for line in wrap(words, 0.85 * em, size[0]) {
        canvas.text(
            [x, y + 0.9 * em],
            &line,
            0.85 * em,
            Anchor::Start,
            SOFT,
            false,
        );
        y += 1.15 * em;
    }
    y += 0.9 * em;
    let mut key = |colour, words: &str, y: &mut f64| {
        canvas.rectangle([x, *y], [1.1 * em, 1.1 * em], colour);
        let place = [x + 1.6 * em, *y + 0.92 * em];
        canvas.text(place, words, 0.95 * em, Anchor::Start, INK, false);
        *y += 1.7 * em;
    };
    let missing = values.iter().any(|v| v.is_nan());
    if colours.status {
        for (number, (name, colour)) in colour::STATUSES.iter().enumerate() {
            let count = statuses.and_then(|counts| counts.get(number).copied());
            let there = values.contains(&(number as f64));
            if number < colour::TIED || there {
                let count = count.map_or_else(String::new, |n| format!(" ({n})"));
                key(*colour, &format!("{name}{count}"), &mut y);
            }
        }
    }
    if missing {
        key(colour::NOTHING, "no value", &mut y);
    }
    if colours.status {
        return;
    }
    let lines: Vec<String> = (said.iter())
        .flat_map(|words| wrap(words, 0.85 * em, size[0]))
        .collect();
    // Of zero there is nothing to tell apart.
    if colours.range != [0.0; 2] {
        let below = 1.15 * em * lines.len() as f64;
        let height = (size[1] - (y - at[1]) - below - 0.5 * em).clamp(4.0 * em, 24.0 * em);
        scale(colours, [x, y], height, em, canvas);
        y += height;
    }
    y += 1.5 * em;
    for line in lines {
        canvas.text([x, y], &line, 0.85 * em, Anchor::Start, SOFT, false);
        y += 1.15 * em;
    }
}

/// Draws the colours from low to high, with numbers beside them.
fn scale(colours: &Scale, [x, y]: [f64; 2], height: f64, em: f64, canvas: &mut dyn Canvas) {
    let [low, high] = colours.range;
    let bar = [1.5 * em, height].map(|n| (n * FINE as f64) as usize);
    let pixels: Vec<u8> = (0..bar[1])
        .flat_map(|row| {
            let t = 1.0 - (row as f64 + 0.5) / bar[1] as f64;
            let [r, g, b] = colours.colour(low + t * (high - low));
            std::iter::repeat_n([r, g, b, 255], bar[0]).flatten()
        })
        .collect();
    canvas.picture([x, y], bar, FINE, &pixels);
    // A few bands have their ends named, otherwise round numbers are.
    let ticks = match colours.bands {
        _ if high <= low => vec![low],
        Some(n @ 1..=12) => (0..=n)
            .map(|k| low + f64::from(k) / f64::from(n) * (high - low))
            .collect(),
        _ => axis::ticks(low, high, 7),
    };
    for (tick, text) in ticks.iter().zip(axis::labels(&ticks, 3)) {
        let share = if high > low {
            (*tick - low) / (high - low)
        } else {
            0.5
        };
        let place = y + (1.0 - share) * height;
        let pen = Pen::new(INK, 0.07 * em);
        canvas.line(&[[x + 1.5 * em, place], [x + 1.9 * em, place]], pen);
        let place = [x + 2.2 * em, place + 0.34 * em];
        canvas.text(place, &text, 0.92 * em, Anchor::Start, INK, false);
    }
}

/// Draws the axes of space as the camera sees them.
pub fn triad(camera: &Camera, dim: usize, at: [f64; 2], em: f64, canvas: &mut dyn Canvas) {
    let colours = [[209, 73, 91], [47, 158, 99], [59, 125, 216]];
    let mut arms: Vec<(f64, usize, [f64; 2])> = (0..dim)
        .map(|c| {
            let mut d = [0.0; 3];
            d[c] = 1.0;
            let d = camera.see(d);
            (d[2], c, [d[0], -d[1]])
        })
        .collect();
    arms.sort_by(|a, b| a.0.total_cmp(&b.0));
    for (_, c, d) in arms {
        let end = [0, 1].map(|k| at[k] + 1.7 * em * d[k]);
        canvas.line(&[at, end], Pen::new(colours[c], 0.2 * em));
        if d[0].hypot(d[1]) > 0.1 {
            let place = [at[0] + 2.2 * em * d[0], at[1] + 2.2 * em * d[1] + 0.3 * em];
            canvas.text(
                place,
                ["x", "y", "z"][c],
                0.9 * em,
                Anchor::Middle,
                INK,
                false,
            );
        }
    }
}
