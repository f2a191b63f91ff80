use super::Amplitude;

/// The factor of a load, support or interface over the whole analysis: one piece a step.
///
/// A step owns the times after its start up to and including its end.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Schedule {
    /// In order of time.
    pub pieces: Vec<Piece>,
}

/// The course of a factor over one step.
#[derive(Debug, Clone, PartialEq)]
pub struct Piece {
    /// Start of the step.
    pub start: f64,
    /// End of the step.
    pub end: f64,
    /// What happens in between.
    pub course: Course,
}

/// How a factor moves over a step.
#[derive(Debug, Clone, PartialEq)]
pub enum Course {
    /// Not active.
    Off,
    /// Linear from one factor to another.
    Ramp(f64, f64),
    /// A table over the time of the analysis.
    Table(Amplitude),
}

impl Schedule {
    /// Constantly `1`.
    pub fn always() -> Self {
        Schedule {
            pieces: vec![Piece {
                start: f64::NEG_INFINITY,
                end: f64::INFINITY,
                course: Course::Ramp(1.0, 1.0),
            }],
        }
    }

    fn piece(&self, t: f64) -> Option<&Piece> {
        let i = self.pieces.partition_point(|p| p.end < t);
        self.pieces.get(i).or(self.pieces.last())
    }

    /// Whether it is on at time `t`.
    pub fn active(&self, t: f64) -> bool {
        self.piece(t).is_some_and(|p| p.course != Course::Off)
    }

    /// The factor at time `t`; zero where off.
    pub fn at(&self, t: f64) -> f64 {
        let Some(piece) = self.piece(t) else {
            return 0.0;
        };
        match &piece.course {
            Course::Off => 0.0,
            Course::Ramp(from, to) if from == to => *to,
            Course::Ramp(from, to) => {
                let s = ((t - piece.start) / (piece.end - piece.start)).clamp(0.0, 1.0);
                from * (1.0 - s) + to * s
            }
            Course::Table(amplitude) => amplitude.at(t),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_own_their_end() {
        let schedule = Schedule {
            pieces: vec![
                Piece {
                    start: 0.0,
                    end: 1.0,
                    course: Course::Ramp(0.0, 1.0),
                },
                Piece {
                    start: 1.0,
                    end: 3.0,
                    course: Course::Off,
                },
            ],
        };
        assert_eq!(schedule.at(0.25), 0.25);
        assert_eq!(schedule.at(1.0), 1.0);
        assert!(schedule.active(1.0));
        assert!(!schedule.active(1.0 + 1e-9));
        assert_eq!(schedule.at(2.0), 0.0);
    }
}
