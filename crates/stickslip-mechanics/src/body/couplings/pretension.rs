//! The cut of a pretension: both sides tied across, and drawn together along a normal, by a force or by a length.

use super::Row;
use crate::error::Diagnostic;
use crate::math::{Vec3, add_scaled, cross, dot, normalize};
use crate::system::Amplitude;

/// A cut whose two sides have one displacement along its normal between them, the shortening, and none across.
///
/// Its rows are those across the normal, one for every pair of points and direction; then those along it, whose sums are the shortening; then
/// those that keep the shortening of all pairs the same. While a force draws the sides together the last hold, and the rows along the normal are loaded by
/// their share of the force. While the length is given each row along the normal holds by itself, so that no point has rows with all others.
#[derive(Debug, Clone, PartialEq)]
pub struct Pretension {
    /// What part of a force acts between each pair of points; with sum one.
    pub shares: Vec<f64>,
    /// Area of the section across the normal `[m²]`.
    pub area: f64,
    /// What is done with it, step by step: start and end of the step `[s]`, and what.
    pub steps: Vec<(f64, f64, Draw)>,
}

/// What is done with a pretension in a step.
#[derive(Debug, Clone, PartialEq)]
pub enum Draw {
    /// The sides are drawn together with a force.
    Force(Course),
    /// The shortening is prescribed.
    Shortening(Course),
    /// The shortening stays what it is.
    Hold,
}

/// A value that is led to over a step from what it is, or follows a table.
#[derive(Debug, Clone, PartialEq)]
pub struct Course {
    /// Force `[N]` or shortening `[m]`.
    pub value: f64,
    /// By what it is multiplied, over the time of the analysis.
    pub table: Option<Amplitude>,
}

impl Course {
    /// A share of the value at a time, where that share was `start` when the step began.
    fn at(&self, t: f64, share: f64, start: f64, from: f64, to: f64) -> f64 {
        match &self.table {
            Some(table) => share * table.at(t) * self.value,
            None => {
                let s = ((t - from) / (to - from)).clamp(0.0, 1.0);
                start * (1.0 - s) + share * self.value * s
            }
        }
    }
}

/// What a row of a pretension is for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Part {
    /// It keeps the sides together across the normal.
    Across,
    /// Its sum is the shortening; it has this share of the force.
    Along(f64),
    /// It keeps the shortening of a pair that of the first.
    Equal,
}

/// What the rows along the normal do at a time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Drawn {
    /// They have this part of the force `[N]`.
    Force(f64),
    /// They have a sum `[m]`.
    Length(f64),
}

impl Pretension {
    /// The rows of a cut with these pairs of points, the second on the side that the normal points to.
    ///
    /// # Errors
    /// A normal that is none, or has a component along z in the plane.
    pub fn rows(pairs: &[[usize; 2]], normal: Vec3, dim: usize) -> Result<Vec<Row>, Diagnostic> {
        let n = normalize(normal).ok_or_else(|| Diagnostic::new("", "the normal is zero"))?;
        if dim == 2 && n[2] != 0.0 {
            return Err(Diagnostic::new("", "the normal has a component along z"));
        }
        let between = |[p, q]: [usize; 2], d: Vec3, sign: f64| {
            (0..dim).flat_map(move |c| [(p, c, sign * d[c]), (q, c, -sign * d[c])])
        };
        let mut rows = Vec::new();
        for &pair in pairs {
            for d in &across(n)[..dim - 1] {
                rows.push(Row::new(between(pair, *d, 1.0), dim)?);
            }
        }
        for &pair in pairs {
            rows.push(Row::new(between(pair, n, 1.0), dim)?);
        }
        for &pair in pairs.iter().skip(1) {
            let terms = between(pair, n, 1.0).chain(between(pairs[0], n, -1.0));
            rows.push(Row::new(terms, dim)?);
        }
        Ok(rows)
    }

    /// How many of these rows, the first, keep its sides from sliding over each other.
    pub fn across(&self, rows: usize) -> usize {
        rows + 1 - 2 * self.shares.len()
    }

    /// What each of its rows is for.
    pub(super) fn parts(&self, rows: usize) -> impl Iterator<Item = Part> + '_ {
        (std::iter::repeat_n(Part::Across, self.across(rows)))
            .chain(self.shares.iter().map(|share| Part::Along(*share)))
            .chain(std::iter::repeat_n(Part::Equal, self.shares.len() - 1))
    }

    /// Whether anything draws the sides together in some step.
    pub fn draws(&self) -> bool {
        let acts = |draw: &Draw| match draw {
            Draw::Force(c) | Draw::Shortening(c) => c.value != 0.0,
            Draw::Hold => false,
        };
        self.steps.iter().any(|(.., draw)| acts(draw))
    }

    fn step(&self, t: f64) -> Option<&(f64, f64, Draw)> {
        let i = self.steps.partition_point(|(_, end, _)| *end < t);
        self.steps.get(i).or(self.steps.last())
    }

    /// Whether a force draws the sides together at a time, rather than that their distance is given.
    pub(super) fn pulled(&self, t: f64) -> bool {
        matches!(self.step(t), Some((.., Draw::Force(_))))
    }

    /// What a row along the normal with this share does at a time; `start` is what it did when the step began, its part of the force or its sum.
    pub(super) fn drawn(&self, t: f64, share: f64, start: f64) -> Drawn {
        match self.step(t) {
            Some((from, to, Draw::Force(course))) => {
                Drawn::Force(course.at(t, share, start, *from, *to))
            }
            Some((from, to, Draw::Shortening(course))) => {
                Drawn::Length(course.at(t, 1.0, start, *from, *to))
            }
            Some((.., Draw::Hold)) | None => Drawn::Length(start),
        }
    }
}

/// Two unit vectors across a unit vector, with axes of the model among them where it is one.
fn across(n: Vec3) -> [Vec3; 2] {
    if n[2] == 0.0 {
        // in the plane the first lies in it
        return [[-n[1], n[0], 0.0], [0.0, 0.0, 1.0]];
    }
    let least = (0..3).fold(0, |b, i| if n[i].abs() < n[b].abs() { i } else { b });
    let mut e = [0.0; 3];
    e[least] = 1.0;
    let t = normalize(add_scaled(e, -dot(e, n), n)).unwrap_or(e);
    [t, cross(n, t)]
}
