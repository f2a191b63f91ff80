//! Maps over two values: what the runs of a sweep do, whether all sticks, part of it slips, all slides, or whether sliding is stable, flutters, diverges; and how strong a
//! vibration is over time and frequency.

use std::path::Path;

use stickslip::Error;
use stickslip::io::csv::{self, Table};
use stickslip::results::compare::near;

use super::axis;
use super::words::{INK, SOFT, shorten};
use crate::colour::{self, NOTHING, Rgb};
use crate::draw::{Anchor, Canvas, Pen, text_width};
use crate::results::fault;

/// What is told apart in a map.
pub struct Kind {
    /// The two columns of the table that tell.
    columns: [&'static str; 2],
    /// What there is, and its colour. That of the second lies between those of the first and its own.
    regimes: &'static [(&'static str, Rgb)],
    /// The regime of a run by the two columns; `None` where it is not known.
    of: fn(f64, f64) -> Option<Regime>,
    /// How far the colour of the second is from that of the first, by the size of what is told of it, and the largest of all.
    part: fn(f64, f64) -> f64,
    /// Whether cells are runs that are counted: those of a sweep.
    runs: bool,
    /// Whether critical values that the sweep has found are drawn over it.
    critical: bool,
}

/// What the points that touch do.
pub const STICKING: Kind = Kind {
    columns: ["STICK", "SLIP"],
    regimes: &REGIMES,
    of: regime,
    part: |slips, _| slips,
    runs: true,
    critical: false,
};

/// What steady sliding does after a small disturbance.
pub const STABILITY: Kind = Kind {
    columns: ["MODES.GROWTH", "MODES.FREQUENCY"],
    regimes: &[
        ("stable", [214, 226, 238]),
        ("flutter, the redder the faster it grows", [213, 94, 0]),
        ("divergence", [92, 40, 110]),
        ("", NOTHING),
    ],
    of: stability,
    // What hardly grows is told apart from what does not.
    part: |growth, most| 0.3 + 0.7 * growth / most,
    runs: true,
    critical: true,
};

/// How strong a vibration is, over time and frequency: the waterfall of its spectra.
pub const WATERFALL: Kind = Kind {
    columns: ["amplitude", "amplitude"],
    regimes: &[
        ("a thousandth of the largest amplitude", [240, 244, 248]),
        ("the largest", [8, 48, 107]),
    ],
    of: |amplitude, _| amplitude.is_finite().then_some((1, amplitude)),
    part: |amplitude, most| 1.0 + (amplitude / most).log10() / 3.0,
    runs: false,
    critical: false,
};

const REGIMES: [(&str, Rgb); 4] = [
    ("all sticks", colour::STATUSES[1].1),
    ("part slips, the yellower the more", [240, 228, 66]),
    ("all slides", colour::STATUSES[2].1),
    ("open", [222, 226, 232]),
];

/// The number of a regime, and its size: the part of the points that touch which slip, or the growth.
type Regime = (usize, f64);

/// The regime of a run by how many points stick and slip; `None` where that is not known.
fn regime(stick: f64, slip: f64) -> Option<Regime> {
    if !(stick.is_finite() && slip.is_finite()) {
        return None;
    }
    Some(match (stick > 0.0, slip > 0.0) {
        (true, false) => (0, 0.0),
        (true, true) => (1, slip / (stick + slip)),
        (false, true) => (2, 1.0),
        (false, false) => (3, 0.0),
    })
}

/// What the mode that grows fastest does: it swings with a growing amplitude, or runs away without a swing.
fn stability(growth: f64, frequency: f64) -> Option<Regime> {
    if !(growth.is_finite() && frequency.is_finite()) {
        return None;
    }
    Some(match (growth > 0.0, frequency > 0.0) {
        (false, _) => (0, 0.0),
        (true, true) => (1, growth),
        (true, false) => (2, growth),
    })
}

impl Kind {
    /// The colour of a regime: that of the second, from that of the first on, the more there is of it.
    fn shade(&self, regime: Option<Regime>, most: f64) -> Rgb {
        let all = self.regimes;
        match regime {
            None => NOTHING,
            Some((1, size)) => colour::along(&[all[0].1, all[1].1], (self.part)(size, most)),
            Some((number, _)) => all[number].1,
        }
    }
}

/// Values of an axis in increasing order, and where the cell of each begins and ends.
struct Axis {
    values: Vec<f64>,
    edges: Vec<f64>,
}

impl Axis {
    fn of(column: &[f64]) -> Option<Self> {
        let mut values: Vec<f64> = column.iter().copied().filter(|v| v.is_finite()).collect();
        values.sort_by(f64::total_cmp);
        values.dedup();
        let (&first, &last) = (values.first()?, values.last()?);
        let between = values.windows(2).map(|w| 0.5 * (w[0] + w[1]));
        let mut edges = vec![first];
        edges.extend(between);
        edges.push(last);
        let n = edges.len();
        // The outermost cells are as wide as to the other side; a single value has a cell of any width.
        let half = |a: f64, b: f64| if b > a { b - a } else { 0.5 * a.abs().max(1.0) };
        let ends = [half(first, edges[1]), half(edges[n - 2], last)];
        edges[0] -= ends[0];
        edges[n - 1] += ends[1];
        Some(Axis { values, edges })
    }

    fn cell(&self, value: f64) -> Option<[f64; 2]> {
        let i = self.values.iter().position(|v| *v == value)?;
        Some([self.edges[i], self.edges[i + 1]])
    }

    fn ends(&self) -> [f64; 2] {
        [self.edges[0], self.edges[self.edges.len() - 1]]
    }
}

/// A column of the table of a sweep, by its name or the end of it.
pub fn column<'t>(
    file: &Path,
    table: &'t Table,
    name: &str,
) -> Result<(&'t str, &'t [f64]), Error> {
    let ends = |n: &&String| *n == name || n.ends_with(&format!(".{name}"));
    let exact = table.names.iter().find(|n| *n == name);
    let found = exact.or_else(|| table.names.iter().find(ends));
    let values = found.and_then(|n| Some((n.as_str(), table.column(n)?)));
    values.ok_or_else(|| {
        let names = table.names.iter().map(String::as_str);
        let message = format!("there is no column `{name}`{}", near(name, names));
        fault(file, message)
    })
}

/// Draws the map of a table with the columns of its kind over two other columns.
///
/// # Errors
/// [`Error::Io`] if the table cannot be read, lacks a column, or has no numbers in those of the axes.
pub fn draw(
    file: &Path,
    kind: &Kind,
    [across, up]: [&str; 2],
    size: [u32; 2],
    canvas: &mut dyn Canvas,
) -> Result<(), Error> {
    let table = csv::read(file)?;
    let of = |name: &str| column(file, &table, name);
    let ((x_name, x), (y_name, y)) = (of(across)?, of(up)?);
    let [(_, first), (_, second)] = [of(kind.columns[0])?, of(kind.columns[1])?];
    let axis = |name: &str, values: &[f64]| {
        Axis::of(values).ok_or_else(|| fault(file, format!("the column `{name}` holds no numbers")))
    };
    let axes = [axis(x_name, x)?, axis(y_name, y)?];
    let rows = x.iter().zip(y).zip(first.iter().zip(second));
    let cells: Vec<Cell> = rows
        .map(|((&x, &y), (&first, &second))| ([x, y], (kind.of)(first, second)))
        .collect();
    let found = file.with_extension("critical.csv");
    let mut critical = Vec::new();
    if kind.critical && found.is_file() {
        let table = csv::read(&found)?;
        let ((_, x), (_, y)) = (
            column(&found, &table, x_name)?,
            column(&found, &table, y_name)?,
        );
        critical = x.iter().zip(y).map(|(&x, &y)| [x, y]).collect();
    }
    let stem = file.file_stem().unwrap_or_default().to_string_lossy();
    let map = Map {
        kind,
        axes,
        cells,
        critical,
    };
    map.picture(&stem, [x_name, y_name], size, canvas);
    Ok(())
}

/// A place on the axes, and what the run there does.
type Cell = ([f64; 2], Option<Regime>);

/// What is drawn.
struct Map<'a> {
    kind: &'a Kind,
    axes: [Axis; 2],
    cells: Vec<Cell>,
    /// Places on the boundary.
    critical: Vec<[f64; 2]>,
}

impl Map<'_> {
    fn picture(&self, title: &str, names: [&str; 2], size: [u32; 2], canvas: &mut dyn Canvas) {
        let axes = &self.axes;
        let [width, height] = size.map(f64::from);
        let em = (width.min(height * 1.4) / 62.0).clamp(9.0, 60.0);
        let margin = 1.6 * em;
        let title = shorten(title, 1.35 * em, width - 2.0 * margin);
        let at = [margin, 2.1 * em];
        canvas.text(at, &title, 1.35 * em, Anchor::Start, INK, false);
        self.legend([margin, 3.2 * em], em, canvas);
        let [[x0, x1], [y0, y1]] = [axes[0].ends(), axes[1].ends()];
        let labels = axis::ticks(y0, y1, 8)
            .into_iter()
            .map(|t| (t, axis::number(t, 4)));
        let labels: Vec<(f64, String)> = labels.collect();
        let widest = labels.iter().map(|(_, text)| text_width(text, em));
        let left = margin + 2.0 * em + widest.fold(0.0, f64::max);
        let (top, right, bottom) = (5.6 * em, width - margin, height - 4.2 * em);
        let px = |v: f64| left + (v - x0) / (x1 - x0) * (right - left);
        let py = |v: f64| bottom - (v - y0) / (y1 - y0) * (bottom - top);
        self.fill(&|[x, y]| [px(x), py(y)], canvas);
        for &[x, y] in &self.critical {
            for (r, ink) in [(0.5 * em, [255, 255, 255]), (0.35 * em, INK)] {
                canvas.rectangle([px(x) - r, py(y) - r], [2.0 * r, 2.0 * r], ink);
            }
        }
        for (tick, label) in &labels {
            let at = [left - 0.6 * em, py(*tick) + 0.36 * em];
            canvas.text(at, label, em, Anchor::End, SOFT, false);
        }
        for tick in axis::ticks(x0, x1, 8) {
            let at = [px(tick), bottom + 1.5 * em];
            canvas.text(at, &axis::number(tick, 4), em, Anchor::Middle, SOFT, false);
        }
        canvas.line(
            &[[left, top], [left, bottom], [right, bottom]],
            Pen::new(SOFT, 0.1 * em),
        );
        let at = [(left + right) / 2.0, bottom + 3.2 * em];
        canvas.text(at, names[0], 1.05 * em, Anchor::Middle, INK, false);
        let at = [margin + 0.4 * em, (top + bottom) / 2.0];
        canvas.text(at, names[1], 1.05 * em, Anchor::Middle, INK, true);
    }

    /// Draws the cells.
    fn fill(&self, at: &dyn Fn([f64; 2]) -> [f64; 2], canvas: &mut dyn Canvas) {
        let [across, up] = &self.axes;
        let sizes = self.cells.iter().filter_map(|(_, regime)| *regime);
        let sizes = sizes.filter(|(number, _)| *number == 1);
        let most = sizes.fold(f64::MIN_POSITIVE, |m, (_, size)| m.max(size));
        let mut cell = |[x0, x1]: [f64; 2], [y0, y1]: [f64; 2], hair: f64, colour: Rgb| {
            let (from, to) = (at([x0, y1]), at([x1, y0]));
            let size = [0, 1].map(|c| to[c] - from[c] - hair);
            canvas.rectangle(from, size, colour);
        };
        // A hair of white between runs, so that they can be counted; what is weakest has no cell of its own.
        let hair = if self.kind.runs { 1.0 } else { -0.3 };
        if !self.kind.runs {
            cell(across.ends(), up.ends(), 0.0, self.kind.regimes[0].1);
        }
        for ([x, y], regime) in &self.cells {
            let faint = |(_, size): Regime| (self.kind.part)(size, most) <= 0.0;
            if !self.kind.runs && regime.is_none_or(faint) {
                continue;
            }
            if let Some((x, y)) = across.cell(*x).zip(up.cell(*y)) {
                cell(x, y, hair, self.kind.shade(*regime, most));
            }
        }
    }

    /// What the colours mean, and how many runs have each.
    fn legend(&self, at: [f64; 2], em: f64, canvas: &mut dyn Canvas) {
        let cells = &self.cells;
        let number = |r: &Option<Regime>| r.map(|(number, _)| number);
        let count = |wanted| cells.iter().filter(|(_, r)| number(r) == wanted).count();
        let regimes = self.kind.regimes.iter().enumerate();
        let all = regimes.map(|(i, (name, colour))| (*name, *colour, count(Some(i))));
        let mut x = at[0];
        for (name, colour, count) in all.chain([("not known", NOTHING, count(None))]) {
            let text = match (self.kind.runs, count) {
                (true, 0) => continue,
                (true, _) => format!("{name} ({count})"),
                (false, _) if name == "not known" => continue,
                (false, _) => name.to_string(),
            };
            canvas.rectangle([x, at[1]], [em, em], colour);
            let place = [x + 1.5 * em, at[1] + 0.85 * em];
            canvas.text(place, &text, em, Anchor::Start, INK, false);
            x += 3.0 * em + text_width(&text, em);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_meet_half_way_between_values() {
        let axis = Axis::of(&[2.0, 1.0, 4.0, 2.0, f64::NAN]).expect("numbers");
        assert_eq!(axis.cell(1.0), Some([0.5, 1.5]));
        assert_eq!(axis.cell(2.0), Some([1.5, 3.0]));
        assert_eq!(axis.ends(), [0.5, 5.0]);
        assert!(Axis::of(&[f64::NAN]).is_none());
        assert!(Axis::of(&[3.0]).is_some_and(|a| a.ends()[0] < 3.0));
    }

    #[test]
    fn what_grows_flutters_or_diverges() {
        let found = [
            (-1.0, 5.0),
            (0.0, 0.0),
            (0.1, 5.0),
            (0.1, 0.0),
            (f64::NAN, 1.0),
        ];
        let found = found.map(|(growth, frequency)| Some(stability(growth, frequency)?.0));
        assert_eq!(found, [Some(0), Some(0), Some(1), Some(2), None]);
    }

    #[test]
    fn what_grows_faster_is_redder_and_what_is_weak_is_pale() {
        let red = |growth: f64| i32::from(STABILITY.shade(stability(growth, 5.0), 8.0)[2]);
        assert!(red(8.0) < red(2.0) && red(2.0) < red(1e-9) && red(1e-9) < red(-1.0));
        let dark = |amplitude: f64| WATERFALL.shade((WATERFALL.of)(amplitude, 0.0), 2.0);
        assert_eq!(dark(2.0), WATERFALL.regimes[1].1);
        assert_eq!(dark(1e-9), WATERFALL.regimes[0].1);
        assert_eq!(STICKING.shade(regime(0.0, 2.0), 1.0), REGIMES[2].1);
    }

    #[test]
    fn runs_are_told_apart_by_what_their_points_do() {
        let found = [
            (3.0, 0.0),
            (3.0, 1.0),
            (0.0, 2.0),
            (0.0, 0.0),
            (f64::NAN, 0.0),
        ];
        let found = found.map(|(stick, slip)| Some(regime(stick, slip)?.0));
        assert_eq!(found, [Some(0), Some(1), Some(2), Some(3), None]);
    }
}
