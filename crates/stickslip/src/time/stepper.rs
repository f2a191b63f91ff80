//! The size of increments: halved on failure, grown when easy, landing on the times that matter.

use crate::tolerance::SAME;

/// Increments of one step, as times.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Increments {
    /// First increment.
    pub initial: f64,
    /// Below this the analysis gives up.
    pub smallest: f64,
    /// Largest increment.
    pub largest: f64,
}

/// An increment to try.
#[derive(Debug, Clone, Copy, PartialEq, crate::keep::Keep)]
pub struct Trial {
    /// Start.
    pub from: f64,
    /// End.
    pub to: f64,
}

/// Controls the increments of one step.
#[derive(Debug, Clone)]
pub struct Stepper {
    increments: Increments,
    milestones: Vec<f64>,
    now: f64,
    wish: f64,
    easy: usize,
    growth: f64,
}

/// Newton iterations up to which an increment counts as easy.
const EASY_ITERATIONS: usize = 8;

impl Stepper {
    /// From `start` to the last of the `milestones`, none of which is stepped over. They are sorted; those not after
    /// `start` are dropped, as are those an instant after another.
    pub fn new(start: f64, mut milestones: Vec<f64>, increments: Increments) -> Self {
        milestones.retain(|&t| t > start);
        milestones.sort_by(f64::total_cmp);
        milestones.dedup();
        // A table that jumps has two rows an instant apart: one landing is enough, and none right after the start.
        let end = milestones.last().copied().unwrap_or(start);
        // Milestones that are nearer are one.
        let instant = SAME * (end - start);
        let mut last = start;
        milestones.retain(|&t| {
            let kept = t - last > instant && end - t > instant || t == end;
            if kept {
                last = t;
            }
            kept
        });
        Stepper {
            increments,
            milestones,
            now: start,
            wish: increments.initial,
            easy: 0,
            // Growth after two easy increments in a row.
            growth: 1.5,
        }
    }

    /// Doubles increments when they grow, so that halving and growing lead to the same few lengths and the matrices made for them serve
    /// again.
    pub fn doubling(self) -> Self {
        Stepper {
            growth: 2.0,
            ..self
        }
    }

    /// Sets the increment that is wanted next, for schemes that know it.
    pub fn bound(&mut self, wish: f64) {
        self.wish = wish.min(self.increments.largest);
    }

    /// The same where an attempt has failed: what that one has left is not made longer.
    pub fn bound_again(&mut self, wish: f64) {
        self.wish = self.wish.min(wish);
    }

    /// Goes back, or stays, where an increment was tried from, and proposes it again as if nothing had failed.
    pub fn again(&mut self, from: f64, length: f64) {
        self.now = from;
        self.wish = length;
        self.easy = 0;
    }

    /// Goes on from a later time; that, or a milestone an instant from it.
    pub fn leap(&mut self, to: f64) -> f64 {
        let instant = SAME * self.milestones.last().copied().unwrap_or(to).abs();
        let near = self.milestones.partition_point(|&t| t < to - instant);
        let near = self.milestones.get(near).filter(|&&t| t <= to + instant);
        self.now = near.copied().unwrap_or(to);
        self.easy = 0;
        self.now
    }

    /// The increment that a step begins with.
    pub fn initial(&self) -> f64 {
        self.increments.initial
    }

    /// The next increment to try; `None` at the end.
    pub fn next(&self) -> Option<Trial> {
        let next = self.milestones.partition_point(|&t| t <= self.now);
        let target = *self.milestones.get(next)?;
        let left = target - self.now;
        // Equal parts up to the milestone, so that no sliver is left before it.
        let parts = (left / self.wish - 1e-6).ceil().max(1.0);
        let to = if self.growth == 2.0 && parts > 2.0 {
            // Lengths stay on the ladder of halves and doubles until the last two.
            self.now + self.wish
        } else if parts == 1.0 {
            target
        } else {
            self.now + left / parts
        };
        Some(Trial { from: self.now, to })
    }

    /// The increment was accepted after `iterations`.
    pub fn accept(&mut self, trial: Trial, iterations: usize) {
        self.now = trial.to;
        self.easy = if iterations <= EASY_ITERATIONS {
            self.easy + 1
        } else {
            0
        };
        if self.easy >= 2 {
            self.wish = (self.wish * self.growth).min(self.increments.largest);
            self.easy = 0;
        }
    }

    /// The increment failed: halves it. `false` if it is as small as it may be.
    pub fn reject(&mut self, trial: Trial) -> bool {
        self.wish = 0.5 * (trial.to - trial.from);
        self.easy = 0;
        self.wish >= self.increments.smallest
    }
}

/// Where the increments of a step stand: all that a [`Stepper`] knows beyond the step.
#[derive(Debug, Clone, Copy, PartialEq, crate::keep::Keep)]
pub struct Pace {
    now: f64,
    wish: f64,
    easy: usize,
}

impl Stepper {
    /// Where it stands.
    pub fn pace(&self) -> Pace {
        Pace {
            now: self.now,
            wish: self.wish,
            easy: self.easy,
        }
    }

    /// Goes on from there.
    pub fn at(self, pace: Pace) -> Self {
        let Pace { now, wish, easy } = pace;
        Stepper {
            now,
            wish,
            easy,
            ..self
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn increments(initial: f64, largest: f64) -> Increments {
        Increments {
            initial,
            smallest: 1e-3,
            largest,
        }
    }

    #[test]
    fn a_bound_does_not_undo_what_a_failure_has_halved() {
        let mut s = Stepper::new(0.0, vec![1.0], increments(1.0, 1.0));
        s.bound(0.25);
        let failed = s.next().unwrap_or(Trial { from: 0.0, to: 0.0 });
        assert!(s.reject(failed));
        s.bound_again(0.25);
        let next = s.next().map_or(f64::NAN, |t| t.to);
        assert!((next - 0.125).abs() < 1e-12, "{next}");
    }

    #[test]
    fn lands_on_milestones_and_grows() {
        let mut s = Stepper::new(1.0, vec![2.0, 1.25, 0.5], increments(0.1, 0.4));
        let mut ends = Vec::new();
        while let Some(trial) = s.next() {
            s.accept(trial, 3);
            ends.push(trial.to);
        }
        assert!(ends.contains(&1.25));
        assert_eq!(ends.last(), Some(&2.0));
        let steps: Vec<f64> = ends.windows(2).map(|w| w[1] - w[0]).collect();
        assert!(steps.iter().all(|&d| d < 0.4 + 1e-12));
        assert!(steps.iter().any(|&d| d > 0.2));
    }

    #[test]
    fn jumps_are_landed_on_once() {
        let milestones = vec![
            1.0f64.next_up(),
            1.5,
            1.5f64.next_up(),
            2.0f64.next_down(),
            2.0,
        ];
        let mut s = Stepper::new(1.0, milestones, increments(1.0, 1.0));
        let mut ends = Vec::new();
        while let Some(trial) = s.next() {
            s.accept(trial, 3);
            ends.push(trial.to);
        }
        assert_eq!(ends, [1.5, 2.0]);
    }

    #[test]
    fn doubling_keeps_to_few_lengths() {
        let mut s = Stepper::new(0.0, vec![1.0], increments(0.1, 0.1)).doubling();
        let mut lengths = Vec::new();
        let mut count = 0;
        while let Some(trial) = s.next() {
            count += 1;
            if count == 4 {
                s.reject(trial);
                continue;
            }
            lengths.push(((trial.to - trial.from) / 0.1 * 1e6).round() / 1e6);
            s.accept(trial, 2);
        }
        assert_eq!(s.next(), None);
        let odd: Vec<_> = lengths.iter().filter(|&&l| l != 1.0 && l != 0.5).collect();
        assert!(odd.len() <= 2, "{lengths:?}");
    }

    #[test]
    fn fixed_increments_stay_equal() {
        let mut s = Stepper::new(0.0, vec![1.0], increments(0.1, 0.1));
        let mut count = 0;
        while let Some(trial) = s.next() {
            s.accept(trial, 2);
            count += 1;
            assert!((trial.to - 0.1 * count as f64).abs() < 1e-12);
        }
        assert_eq!(count, 10);
    }

    #[test]
    fn gives_up_below_the_smallest() {
        let mut s = Stepper::new(0.0, vec![1.0], increments(0.01, 0.1));
        let mut halvings = 0;
        while let Some(trial) = s.next() {
            if !s.reject(trial) {
                break;
            }
            halvings += 1;
        }
        assert_eq!(halvings, 3);
    }
}
