//! Temperatures that are given at points, and how they move.

use crate::system::{Course, Piece, Schedule};

/// Temperatures at the points of a mesh over the analysis.
///
/// Each point has one at the start. Fields take its place: what a field gives at its points, times its factor, and in exchange for it a share of the
/// temperature at the start. A field that grows from the start to what it gives has factor and share alike; one with an amplitude has the whole
/// share as long as it acts.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Temperatures {
    /// At the start, by point of the mesh.
    pub start: Vec<f64>,
    /// Whether that of every point of the fields is given; one that is not is zero.
    pub said: bool,
    /// What takes its place.
    pub fields: Vec<TemperatureField>,
}

/// Temperatures that some points take on.
#[derive(Debug, Clone, PartialEq)]
pub struct TemperatureField {
    /// Name in the problem file.
    pub name: String,
    /// Temperatures at points, ascending, each once.
    pub entries: Vec<(usize, f64)>,
    /// What they are multiplied by.
    pub factor: Schedule,
    /// The share of the temperature at the start that is gone.
    pub share: Schedule,
}

impl TemperatureField {
    /// Factor and share at a time.
    pub fn weights(&self, t: f64) -> [f64; 2] {
        [self.factor.at(t), self.share.at(t)]
    }
}

/// By how much a point is warmer than at the start.
fn rise([factor, share]: [f64; 2], value: f64, start: f64) -> f64 {
    match factor == share {
        true => factor * (value - start),
        false => factor * value - share * start,
    }
}

impl Temperatures {
    /// By how much each point is warmer than at the start.
    pub fn rises(&self, t: f64) -> Vec<f64> {
        let weights: Vec<[f64; 2]> = self.fields.iter().map(|f| f.weights(t)).collect();
        self.weighted(&weights)
    }

    /// The same with these factors and shares of the fields.
    pub fn weighted(&self, weights: &[[f64; 2]]) -> Vec<f64> {
        let mut rises = vec![0.0; self.start.len()];
        for (field, weights) in self.fields.iter().zip(weights) {
            if *weights != [0.0; 2] {
                for &(p, value) in &field.entries {
                    rises[p] += rise(*weights, value, self.start[p]);
                }
            }
        }
        rises
    }

    /// The temperature of each point.
    pub fn at(&self, t: f64) -> Vec<f64> {
        let both = self.start.iter().zip(self.rises(t));
        both.map(|(start, rise)| start + rise).collect()
    }

    /// The lowest and the highest rise that each point has in the course of the analysis, and none.
    pub fn extremes(&self) -> Vec<[f64; 2]> {
        let mut out = vec![[0.0, 0.0]; self.start.len()];
        let mut times: Vec<f64> = Vec::new();
        for piece in self.fields.iter().flat_map(|f| &f.factor.pieces) {
            times.extend(turns(piece));
        }
        times.sort_by(f64::total_cmp);
        times.dedup();
        for t in times {
            for (e, rise) in out.iter_mut().zip(self.rises(t)) {
                *e = [f64::min(e[0], rise), f64::max(e[1], rise)];
            }
        }
        out
    }

    /// Those of some points, which are numbered in this order.
    pub fn extract(&self, points: &[usize]) -> Temperatures {
        let place = |p: &usize| points.iter().position(|q| q == p);
        Temperatures {
            start: points.iter().map(|&p| self.start[p]).collect(),
            said: self.said,
            fields: (self.fields.iter())
                .map(|field| TemperatureField {
                    entries: (field.entries.iter())
                        .filter_map(|(p, value)| Some((place(p)?, *value)))
                        .collect(),
                    ..field.clone()
                })
                .collect(),
        }
    }
}

/// The times at which a course may turn: between them it is linear.
fn turns(piece: &Piece) -> Vec<f64> {
    let mut times = vec![piece.start.next_up(), piece.end];
    if let Course::Table(amplitude) = &piece.course {
        times.extend(
            amplitude
                .times()
                .filter(|t| (piece.start..piece.end).contains(t)),
        );
    }
    times
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::system::Amplitude;

    fn schedule(courses: [Course; 2]) -> Schedule {
        let pieces = courses.into_iter().enumerate().map(|(i, course)| Piece {
            start: i as f64,
            end: i as f64 + 1.0,
            course,
        });
        Schedule {
            pieces: pieces.collect(),
        }
    }

    /// One field after another at point 1, which is at 20 at first; an amplitude at point 2.
    fn example() -> Temperatures {
        let first = schedule([Course::Ramp(0.0, 1.0), Course::Ramp(1.0, 0.0)]);
        let second = schedule([Course::Off, Course::Ramp(0.0, 1.0)]);
        let rows = vec![[0.0, 1.0], [0.5, 3.0], [2.0, 0.0]];
        let table = Course::Table(Amplitude::new(rows).expect("a table"));
        let field = |name: &str, p, value, factor: Schedule, share: Schedule| TemperatureField {
            name: name.into(),
            entries: vec![(p, value)],
            factor,
            share,
        };
        Temperatures {
            start: vec![20.0; 3],
            said: true,
            fields: vec![
                field("warm", 1, 100.0, first.clone(), first),
                field("hot", 1, 300.0, second.clone(), second),
                field(
                    "swing",
                    2,
                    50.0,
                    schedule([table.clone(), table]),
                    Schedule::always(),
                ),
            ],
        }
    }

    #[test]
    fn a_field_takes_the_place_of_the_one_before() {
        let all = example();
        assert_eq!(all.at(0.5), [20.0, 60.0, 150.0]);
        assert_eq!(all.at(1.0)[1], 100.0);
        assert!((all.at(1.25)[1] - 150.0).abs() < 1e-12);
        assert_eq!(all.at(2.0), [20.0, 300.0, 0.0]);
    }

    #[test]
    fn the_extremes_are_those_of_all_turns() {
        let all = example().extremes();
        assert_eq!(all[0], [0.0, 0.0]);
        assert_eq!(all[1], [0.0, 280.0]);
        assert_eq!(all[2], [-20.0, 130.0]);
        let some = example().extract(&[2, 1]);
        assert_eq!(some.at(0.5), [150.0, 60.0]);
    }
}
