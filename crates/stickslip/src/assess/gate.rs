//! The outcome of the quality gate: figures, their worst and their limits.

use serde::Serialize;

use super::doctor::Finding;
use super::figures::{self, Kind, Track};
use crate::model::limits::GateMode;
use crate::number::digits;

/// The outcome of the quality gate.
#[derive(Debug, Clone, Default, Serialize, crate::keep::Keep)]
#[serde(rename_all = "kebab-case")]
pub struct Gate {
    /// Action on a figure above its limit.
    pub gate: GateMode,
    /// Whether all figures kept their limits.
    pub met: bool,
    /// The worst of each figure at each place.
    pub figures: Vec<Figure>,
    /// What the figures are made of, in their order.
    #[serde(skip)]
    tracks: Vec<Track>,
}

/// A figure at its worst.
#[derive(Debug, Clone, Serialize, crate::keep::Keep)]
#[serde(rename_all = "kebab-case")]
pub struct Figure {
    /// Its name: the key of its limit in `[quality]`.
    pub figure: &'static str,
    /// Where: `interface NAME`, `body NAME`, `reference point NAME` or `model`.
    pub place: String,
    /// Its largest value `[-]`.
    pub value: f64,
    /// The limit; `null` where it is not judged.
    pub limit: Option<f64>,
    /// Whether the value does not exceed it.
    pub met: bool,
    /// Time of the increment that it comes from `[s]`.
    pub time: f64,
    #[serde(skip)]
    kind: &'static Kind,
}

impl Figure {
    /// Its value and its limit with as many digits as it takes to tell one from the other.
    pub fn compared(&self) -> [String; 2] {
        let limit = self.limit.unwrap_or(f64::INFINITY);
        told_apart(self.value, limit)
    }

    /// Where, which, how much and how much too much.
    pub fn brief(&self) -> String {
        let [value, limit] = self.compared();
        format!(
            "{}: {} is {value}, above its limit {limit}",
            self.place, self.figure
        )
    }

    /// What is wrong and what may help, for a figure above its limit, in a run with these findings.
    pub fn sentence(&self, findings: &[Finding]) -> String {
        let (what, help) = (self.kind.what, figures::advice(self.kind.help, findings));
        format!(
            "{} (at time {}): {what}; {help}",
            self.brief(),
            digits(self.time, 5)
        )
    }
}

impl Figure {
    /// What it means that a figure is above its limit, and what may help in a run with these findings, by its name; `None` of one that is not known.
    pub fn meaning(figure: &str, findings: &[Finding]) -> Option<(&'static str, String)> {
        let kind = figures::ALL.iter().find(|kind| kind.name == figure)?;
        Some((kind.what, figures::advice(kind.help, findings)))
    }
}

impl Gate {
    /// The figures above their limits.
    pub fn violations(&self) -> impl Iterator<Item = &Figure> {
        self.figures.iter().filter(|f| !f.met)
    }

    /// Whether the run has to end with an error.
    pub fn failed(&self) -> bool {
        self.gate == GateMode::Error && !self.met
    }

    /// Notes a figure after an increment: how much is wrong, and what there is to compare it with. What it comes to is found by
    /// [`settle`](Self::settle), when the largest of the run is known.
    pub(crate) fn note(
        &mut self,
        kind: &'static Kind,
        place: &str,
        [amount, scale]: [f64; 2],
        limit: f64,
        time: f64,
    ) {
        self.track(kind, place, limit).add(amount, scale, time);
    }

    /// The same for a figure in motion, where what it is relative to comes and goes: the largest amount of the run is compared with the largest
    /// scale of the run.
    pub(crate) fn note_in_motion(
        &mut self,
        kind: &'static Kind,
        place: &str,
        [amount, scale]: [f64; 2],
        limit: f64,
        time: f64,
    ) {
        (self.track(kind, place, limit)).add_in_motion(amount, scale, time);
    }

    fn track(&mut self, kind: &'static Kind, place: &str, limit: f64) -> &mut Track {
        let mut known = self.figures.iter();
        let known = known.position(|f| f.figure == kind.name && f.place == place);
        let i = known.unwrap_or_else(|| {
            self.tracks.push(Track::default());
            self.figures.push(Figure {
                figure: kind.name,
                place: place.to_string(),
                value: 0.0,
                // An infinite limit is none, and JSON has no infinity.
                limit: limit.is_finite().then_some(limit),
                met: true,
                time: 0.0,
                kind,
            });
            self.figures.len() - 1
        });
        &mut self.tracks[i]
    }

    /// The largest scale of a figure so far, anywhere or at one place.
    pub(crate) fn largest(&self, kind: &Kind, place: Option<&str>) -> f64 {
        let both = self.figures.iter().zip(&self.tracks);
        let same = both.filter(|(f, _)| f.figure == kind.name);
        let there = same.filter(|(f, _)| place.is_none_or(|place| f.place == place));
        there.map(|(_, t)| t.largest).fold(0.0, f64::max)
    }

    /// What `scale` is at least, at a place.
    pub(crate) fn floor(&self, kind: &Kind, place: &str) -> f64 {
        let own = kind.own * self.largest(kind, Some(place));
        own.max(kind.model * self.largest(kind, None))
    }

    /// Works out all figures with the largest scales of the run so far: what looked bad beside small forces may be nothing beside those that came
    /// later.
    pub(crate) fn settle(&mut self) {
        for i in 0..self.figures.len() {
            let figure = &self.figures[i];
            let floor = self.floor(figure.kind, &figure.place);
            let (value, time) = self.tracks[i].worst(floor);
            let figure = &mut self.figures[i];
            figure.value = value;
            if value > 0.0 {
                figure.time = time;
            }
            // What is not a number is above every limit.
            figure.met = figure.limit.is_none_or(|limit| value <= limit);
        }
        self.met = self.figures.iter().all(|f| f.met);
    }
}

/// Digits behind the point of a value and of its limit, where these tell them apart.
const DIGITS: [usize; 2] = [2, 1];

/// Two numbers with as many digits as it takes to tell one from the other.
pub fn told_apart(value: f64, limit: f64) -> [String; 2] {
    let [few, fewer] = DIGITS;
    let said = |x: f64, places: usize| digits(x, places + 1);
    let usual = |places: usize| said(value, places) == said(limit, places);
    let places = (few..=17).find(|&places| !usual(places)).unwrap_or(17);
    match places == few {
        true => [said(value, few), said(limit, fewer)],
        false => [said(value, places), said(limit, places)],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::keep::{Keep, Kept};

    #[test]
    fn a_value_just_above_its_limit_is_told_from_it() {
        assert_eq!(told_apart(0.4, 1e-4), ["0.4", "100e-6"]);
        assert_eq!(told_apart(0.151, 0.15), ["0.151", "0.15"]);
        assert_eq!(told_apart(0.150004, 0.15), ["0.150004", "0.15"]);
        assert_eq!(told_apart(f64::INFINITY, 0.15), ["inf", "0.15"]);
    }

    #[test]
    fn every_figure_comes_back_as_what_it_was() {
        let mut gate = Gate::default();
        for kind in figures::ALL {
            gate.note(kind, "model", [2.0, 1.0], 0.5, 0.25);
        }
        gate.settle();
        let mut bytes = Vec::new();
        gate.keep(&mut bytes);
        let back = Gate::back(&mut Kept::new(&bytes)).expect("its bytes");
        let known = |gate: &Gate| format!("{:?}", gate.figures);
        assert_eq!(known(&back), known(&gate));
        for (a, b) in back.figures.iter().zip(&gate.figures) {
            assert!(std::ptr::eq(a.kind, b.kind), "{}", a.figure);
        }
    }
}
