//! What becomes of a motion that began along a mode: its growth beside that of the eigenvalue, and in the end its spectrum. Made from the rows of the history.

use std::f64::consts::{PI, TAU};

use super::history::{AMPLITUDE, PHASE, REST};
use crate::io::csv::Table;
use crate::model::kick::Growth;

/// Highest frequency of a spectrum, relative to that of the mode: a triangle, which sticking makes of a swing, has a hundredth of its amplitude there. It
/// decides what is written, and no result.
const HARMONICS: f64 = 10.0;

/// Most rows of a spectrum.
const MOST_SPECTRUM_ROWS: usize = 2000;

/// Fewest and most cycles of each spectrum of a waterfall, and most of these.
const CYCLES_A_SPECTRUM: [f64; 2] = [6.0, 40.0];
const SPANS: usize = 60;

/// Columns of the history over the rows of a step.
struct Rows {
    time: Vec<f64>,
    amplitude: Vec<f64>,
    phase: Vec<f64>,
    rest: Vec<f64>,
    /// Points that are open, stick and slip.
    points: [Vec<f64>; 3],
    dissipated: Vec<f64>,
}

impl Rows {
    fn of(history: &Table, growth: &Growth) -> Option<Self> {
        let steps = history.column("STEP")?;
        let own: Vec<usize> = (0..steps.len())
            .filter(|&i| steps[i] == growth.number as f64)
            .collect();
        let take = |name: &str| -> Option<Vec<f64>> {
            let column = history.column(name)?;
            Some(own.iter().map(|&i| column[i]).collect())
        };
        let times = take("TIME")?;
        Some(Rows {
            time: times.iter().map(|t| t - growth.start).collect(),
            amplitude: take(AMPLITUDE)?,
            phase: unwrapped(take(PHASE)?),
            rest: take(REST)?,
            points: [take("OPEN")?, take("STICK")?, take("SLIP")?],
            dissipated: take("ALLFD")?,
        })
    }

    /// Rows that are at least so far apart in time, and the last one, where the step ends.
    fn thinned(mut self, gap: f64) -> Self {
        let mut last = f64::NEG_INFINITY;
        let end = self.time.last().copied();
        let far = self.time.iter().map(|&t| {
            let far = t >= last + gap || Some(t) == end;
            last = if far { t } else { last };
            far
        });
        let kept: Vec<bool> = far.collect();
        let [open, stick, slip] = &mut self.points;
        for column in [
            &mut self.time,
            &mut self.amplitude,
            &mut self.phase,
            &mut self.rest,
            open,
            stick,
            slip,
            &mut self.dissipated,
        ] {
            let mut kept = kept.iter();
            column.retain(|_| kept.next() == Some(&true));
        }
        self
    }

    /// The first and the last row within half a cycle of a row.
    fn around(&self, i: usize, frequency: f64) -> [usize; 2] {
        let half = if frequency > 0.0 {
            0.5 / frequency
        } else {
            0.0
        };
        let last = self.time.len() - 1;
        let t = self.time[i];
        let from = self.time.partition_point(|s| *s < t - half);
        let to = self.time.partition_point(|s| *s <= t + half);
        [
            from.min(i.saturating_sub(1)),
            to.saturating_sub(1).max(i + 1).min(last),
        ]
    }
}

/// Phases without jumps, from increments shorter than half a cycle.
fn unwrapped(mut phase: Vec<f64>) -> Vec<f64> {
    for i in 1..phase.len() {
        let turned = phase[i] - phase[i - 1];
        phase[i] -= TAU * ((turned + PI) / TAU).floor();
    }
    phase
}

/// A row for each of the history: amplitude, the one that the eigenvalue says, growth and frequency over the cycle around it, what touches how, and what friction
/// takes. `None` where the history has no such columns.
pub(super) fn table(history: &Table, growth: &Growth) -> Option<Table> {
    let rows = Rows::of(history, growth)?;
    let n = rows.time.len();
    let mut table = Table::default();
    let mut column = |name: &str, of: &dyn Fn(usize) -> f64| {
        table.names.push(name.into());
        table.columns.push((0..n).map(of).collect());
    };
    let slope = |values: &[f64], i: usize| -> f64 {
        let [from, to] = rows.around(i, growth.frequency);
        let passed = rows.time[to] - rows.time[from];
        if passed > 0.0 {
            (values[to] - values[from]) / passed
        } else {
            0.0
        }
    };
    let logs: Vec<f64> = rows.amplitude.iter().map(|a| a.ln()).collect();
    let all = |i: usize| rows.points.iter().map(|p| p[i]).sum::<f64>().max(1.0);
    column("time", &|i| rows.time[i]);
    column("amplitude", &|i| rows.amplitude[i]);
    column("eigenvalue", &|i| {
        growth.amplitudes[0] * (growth.growth * rows.time[i]).exp()
    });
    column("growth", &|i| slope(&logs, i));
    column("frequency", &|i| slope(&rows.phase, i) / TAU);
    column("rest", &|i| rows.rest[i]);
    for (name, points) in ["open", "stick", "slip"].iter().zip(&rows.points) {
        column(name, &|i| points[i] / all(i));
    }
    column("power", &|i| slope(&rows.dissipated, i));
    Some(table)
}

/// Amplitudes at frequencies of the mode over the rows from the first to the last, weighted by a window of Hann.
fn amplitudes(rows: &Rows, [first, last]: [usize; 2], frequencies: &[f64]) -> Vec<f64> {
    let span = rows.time[last] - rows.time[first];
    let window = |t: f64| (PI * (t - rows.time[first]) / span).sin().powi(2);
    // Weights of the trapezoidal rule.
    let weights: Vec<f64> = (first..=last)
        .map(|i| {
            let before = rows.time[i.saturating_sub(1).max(first)];
            let after = rows.time[(i + 1).min(last)];
            0.5 * (after - before) * window(rows.time[i])
        })
        .collect();
    let whole: f64 = weights.iter().sum();
    let amplitude = |f: &f64| {
        let mut sum = [0.0; 2];
        for (i, w) in (first..).zip(&weights) {
            let x = w * rows.amplitude[i] * rows.phase[i].cos();
            let (s, c) = (TAU * f * rows.time[i]).sin_cos();
            sum[0] += x * c;
            sum[1] -= x * s;
        }
        2.0 * sum[0].hypot(sum[1]) / whole.max(f64::MIN_POSITIVE)
    };
    frequencies.iter().map(amplitude).collect()
}

/// Frequencies up to some harmonics of the mode, as near to each other as a span of time tells them apart, but not more than so many.
fn lines(frequency: f64, span: f64, most: usize) -> Vec<f64> {
    let lines = ((HARMONICS * frequency * span).ceil() as usize).min(most);
    let step = HARMONICS * frequency / lines as f64;
    (0..=lines).map(|k| k as f64 * step).collect()
}

/// Amplitudes by frequency of the mode over the second half of the step.
pub(super) fn spectrum(history: &Table, growth: &Growth) -> Option<Table> {
    let rows = Rows::of(history, growth)?;
    let end = *rows.time.last()?;
    let first = rows.time.partition_point(|t| *t < 0.5 * end);
    let span = end - rows.time[first];
    if span <= 0.0 || growth.frequency <= 0.0 {
        return None;
    }
    let frequencies = lines(growth.frequency, span, MOST_SPECTRUM_ROWS);
    let found = amplitudes(&rows, [first, rows.time.len() - 1], &frequencies);
    Some(Table {
        names: vec!["frequency".into(), "amplitude".into()],
        columns: vec![frequencies, found],
    })
}

/// The same over spans of some cycles, one after the other, by the middle of each. `None` where the step is shorter than two.
pub(super) fn waterfall(history: &Table, growth: &Growth) -> Option<Table> {
    let frequency = growth.frequency;
    // A waterfall looks at 64 rows of the history for a cycle at most: several for the highest harmonic.
    let rows = Rows::of(history, growth)?.thinned(1.0 / (64.0 * frequency));
    let end = *rows.time.last()?;
    // Half of each is in the next.
    let fit = (2.0 * end * frequency / CYCLES_A_SPECTRUM[0]).floor();
    if fit < 3.0 {
        return None;
    }
    let count = (fit as usize - 1).min(SPANS);
    let span = (2.0 * end / (count + 1) as f64).min(CYCLES_A_SPECTRUM[1] / frequency);
    let frequencies = lines(frequency, span, MOST_SPECTRUM_ROWS);
    let mut columns = vec![Vec::new(); 3];
    for k in 0..count {
        let from = (end - span) * k as f64 / (count - 1) as f64;
        let first = rows.time.partition_point(|t| *t < from);
        let last = rows.time.partition_point(|t| *t <= from + span);
        let last = last.saturating_sub(1);
        if last < first + 2 {
            continue;
        }
        for (f, a) in frequencies
            .iter()
            .zip(amplitudes(&rows, [first, last], &frequencies))
        {
            let row = [from + 0.5 * span, *f, a];
            columns.iter_mut().zip(row).for_each(|(c, v)| c.push(v));
        }
    }
    let names = ["time", "frequency", "amplitude"].map(String::from);
    Some(Table {
        names: names.to_vec(),
        columns,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The history of a step in which a mode grows, and what is known of it.
    fn growing(growth: f64, frequency: f64, n: i32) -> (Table, Growth) {
        let times: Vec<f64> = (0..n).map(|i| 5.0 + 1e-3 * f64::from(i)).collect();
        let column = |of: &dyn Fn(f64) -> f64| times.iter().map(|t| of(t - 5.0)).collect();
        let wrapped = |t: f64| {
            let phase = TAU * frequency * t;
            phase - TAU * ((phase + PI) / TAU).floor()
        };
        let names = [
            "STEP", "TIME", AMPLITUDE, PHASE, REST, "OPEN", "STICK", "SLIP", "ALLFD",
        ];
        let history = Table {
            names: names.map(String::from).to_vec(),
            columns: vec![
                column(&|_| 3.0),
                times.clone(),
                column(&|t| 1e-3 * (growth * t).exp()),
                column(&wrapped),
                column(&|_| 0.0),
                column(&|_| 1.0),
                column(&|_| 1.0),
                column(&|_| 2.0),
                column(&|t| 7.0 * t),
            ],
        };
        let told = Growth {
            number: 3,
            start: 5.0,
            amplitudes: [1e-3, 0.0],
            growth,
            frequency,
            ..Growth::default()
        };
        (history, told)
    }

    /// Each spectrum has its peak at the frequency of the mode, of the amplitude in its middle; harmonics have none.
    #[test]
    fn a_waterfall_follows_an_oscillation_that_grows() {
        let (growth, frequency) = (0.1_f64, 3.0);
        let (history, told) = growing(growth, frequency, 8001);
        let found = waterfall(&history, &told).unwrap();
        let [time, at, amplitude] = [0, 1, 2].map(|k| &found.columns[k]);
        let mut middles = time.clone();
        middles.dedup();
        // 24 cycles, in spans of six that overlap by half.
        assert_eq!(middles.len(), 7);
        for (k, middle) in middles.iter().enumerate() {
            assert!((middle - (k + 1) as f64).abs() < 1e-9, "{middles:?}");
            let own: Vec<usize> = (0..time.len()).filter(|&i| time[i] == *middle).collect();
            let peak = own.iter().copied();
            let peak = peak.max_by(|&a, &b| amplitude[a].total_cmp(&amplitude[b]));
            let peak = peak.unwrap();
            assert!((at[peak] - frequency).abs() < 1e-9, "{}", at[peak]);
            let there = 1e-3 * (growth * middle).exp();
            assert!((amplitude[peak] / there - 1.0).abs() < 5e-3);
            let twice = own.iter().find(|&&i| (at[i] - 6.0).abs() < 1e-9).unwrap();
            assert!(amplitude[*twice] < 1e-3 * there);
        }
        let (short, told) = growing(growth, frequency, 3101);
        assert!(waterfall(&short, &told).is_some());
        let (short, told) = growing(growth, frequency, 2001);
        assert!(waterfall(&short, &told).is_none());
    }

    #[test]
    fn a_growing_oscillation_is_read_off_its_history() {
        let (growth, frequency) = (0.5_f64, 3.0);
        let (history, told) = growing(growth, frequency, 2001);
        let table = table(&history, &told).unwrap();
        for (name, value) in [
            ("growth", growth),
            ("frequency", frequency),
            ("slip", 0.5),
            ("power", 7.0),
        ] {
            let column = table.column(name).unwrap();
            assert!(column.iter().all(|v| (v - value).abs() < 1e-9), "{name}");
        }
        let spectrum = spectrum(&history, &told).unwrap();
        let (at, amplitude) = (&spectrum.columns[0], &spectrum.columns[1]);
        let peak = (0..at.len())
            .max_by(|&a, &b| amplitude[a].total_cmp(&amplitude[b]))
            .unwrap();
        assert!((at[peak] - frequency).abs() < 0.51, "{}", at[peak]);
        // That in the middle of the second half, or so.
        assert!((amplitude[peak] / (1e-3 * (growth * 1.5_f64).exp()) - 1.0).abs() < 0.02);
    }
}
