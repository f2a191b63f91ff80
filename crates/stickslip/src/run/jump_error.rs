//! What the error of jumps over cycles comes to, place by place.
//!
//! A cycle that stands for `N` wears as much as its last one, where `N` cycles wear `Σ r(j)`. As long as the rate `r` of a place changes by `c` a cycle it is off by
//!
//! ```text
//! e(N) = c N (N - 1) / 2
//! ```
//!
//! which is nothing for a cycle that stands for itself. A jump is made as a whole and, from the same state, as two halves `N = h + k`. What they wear off differs by
//! `e(N) - e(h) - e(k) = c h k`, and so the halves, which are kept, are off by
//!
//! ```text
//! e = |whole - halves| (h (h - 1) + k (k - 1)) / 2 h k
//! ```
//!
//! Nothing is concluded from how little the last two cycles differ. Where points come into contact or leave it within a jump the error falls more slowly than the square: with the power
//! 3/2 the halves are off by `1 / (√2 - 1)` times the difference, 2.4 times as much as this says. [`UNCERTAINTY_OF_HALVES`] covers that. Errors of all jumps add up without sign: wear makes differences of depth smaller
//! with time, and not larger.

/// By how much the error of halves may be larger than a rate that changes evenly makes it: `1 / (√2 - 1)`.
const UNCERTAINTY_OF_HALVES: f64 = 2.414_213_562_373_095;

/// A place that wears: whether it is on the primary, and its area `[m²]`.
pub(super) type Place = (bool, f64);

/// What has been worn off in a step, and by how much jumps have made it wrong, by interface and place `[m³]`.
#[derive(Debug, Clone, Default, crate::keep::Keep)]
pub(super) struct JumpError {
    worn: Vec<Vec<f64>>,
    off: Vec<Vec<f64>>,
    /// By how much what a cycle wears off changes from one to the next.
    change: Vec<Vec<f64>>,
}

/// By how much jumps are off, relative to the volume that is worn off and to the greatest depth, the worst of all surfaces `[-]`.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Off {
    pub volume: f64,
    pub depth: f64,
}

impl Off {
    pub fn worst(self) -> f64 {
        self.volume.max(self.depth)
    }
}

impl JumpError {
    /// Enters cycles of which each was computed, and by how much those of the last block changed, if that is known.
    pub fn enter(&mut self, amounts: &[Vec<f64>], change: Option<Vec<Vec<f64>>>) {
        add(&mut self.worn, 1.0, amounts);
        if let Some(change) = change {
            self.change = change;
        }
    }

    /// The same with a jump in two halves.
    pub fn with_halves(
        &self,
        whole: &[Vec<f64>],
        both: &[Vec<f64>],
        halves: [usize; 2],
    ) -> JumpError {
        let [h, k] = halves.map(|n| n as f64);
        let change = whole.iter().zip(both).map(|(whole, both)| -> Vec<f64> {
            let each = whole.iter().zip(both);
            each.map(|(w, b)| (w - b).abs() / (h * k)).collect()
        });
        let mut after = self.clone();
        after.change = change.collect();
        add(&mut after.worn, 1.0, both);
        let factor = UNCERTAINTY_OF_HALVES * error(h, k);
        let change = after.change.clone();
        add(&mut after.off, factor, &change);
        after
    }

    /// What was known before, with how rates change as it is known now.
    pub fn of_change(&self, before: &JumpError) -> JumpError {
        JumpError {
            change: self.change.clone(),
            ..before.clone()
        }
    }

    /// By how much jumps are off.
    pub fn off(&self, places: &[Vec<Place>]) -> Off {
        self.off_with(places, 0.0, &[], 0.0)
    }

    /// How many cycles two halves may stand for so that jumps are off by no more than a part, with rates that go on as they do; so many at most.
    pub fn reach(&self, places: &[Vec<Place>], rates: &[Vec<f64>], part: f64, most: f64) -> f64 {
        if self.change.is_empty() {
            return 1.0;
        }
        let mut n = most;
        while n >= 2.0 {
            let factor = UNCERTAINTY_OF_HALVES * error(0.5 * n, 0.5 * n);
            if self.off_with(places, factor, rates, n).worst() <= part {
                return n;
            }
            n *= 0.85;
        }
        1.0
    }

    /// By how much jumps are off after another that is off by so many times the change, and wears off so many times the rates.
    fn off_with(&self, places: &[Vec<Place>], factor: f64, rates: &[Vec<f64>], n: f64) -> Off {
        let mut worst = Off::default();
        let at = |all: &[Vec<f64>], i: usize, k: usize| -> f64 {
            all.get(i)
                .and_then(|own| own.get(k))
                .copied()
                .unwrap_or(0.0)
        };
        for (i, places) in places.iter().enumerate() {
            for primary in [false, true] {
                let mut sums = [0.0; 2];
                let mut deepest = [0.0_f64; 2];
                let own = places.iter().enumerate();
                for (k, (_, area)) in own.filter(|(_, (side, _))| *side == primary) {
                    let worn = at(&self.worn, i, k) + n * at(rates, i, k);
                    let off = at(&self.off, i, k) + factor * at(&self.change, i, k);
                    for (q, value) in [off.abs(), worn.abs()].into_iter().enumerate() {
                        sums[q] += value;
                        if *area > 0.0 {
                            deepest[q] = deepest[q].max(value / area);
                        }
                    }
                }
                let ratio = |[off, worn]: [f64; 2]| match off > 0.0 {
                    true => off / worn.max(f64::MIN_POSITIVE),
                    false => 0.0,
                };
                worst.volume = worst.volume.max(ratio(sums));
                worst.depth = worst.depth.max(ratio(deepest));
            }
        }
        worst
    }
}

/// Error of two jumps over so many cycles, relative to the change of a rate from cycle to cycle.
fn error(h: f64, k: f64) -> f64 {
    0.5 * (h * (h - 1.0).max(0.0) + k * (k - 1.0).max(0.0))
}

/// `sum += factor more`, place by place; places that are new begin with nothing.
fn add(sum: &mut Vec<Vec<f64>>, factor: f64, more: &[Vec<f64>]) {
    sum.resize(sum.len().max(more.len()), Vec::new());
    for (sum, more) in sum.iter_mut().zip(more) {
        sum.resize(sum.len().max(more.len()), 0.0);
        sum.iter_mut().zip(more).for_each(|(s, m)| *s += factor * m);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What cycles wear off whose rates begin with `first` and change by `change` each, as one that stands for all does it: as much as the last.
    fn jump(first: f64, change: f64, from: usize, n: usize) -> f64 {
        n as f64 * (first + change * (from + n - 1) as f64)
    }

    #[test]
    fn the_error_of_rates_that_change_evenly_is_found_exactly() {
        let (first, change, n) = (1.0, -0.01, 7);
        let every: f64 = (0..n).map(|j| jump(first, change, j, 1)).sum();
        let whole = jump(first, change, 0, n);
        let halves = jump(first, change, 0, 3) + jump(first, change, 3, 4);
        let made = JumpError::default();
        let after = made.with_halves(&[vec![whole]], &[vec![halves]], [3, 4]);
        let off = after.off(&[vec![(false, 2.0)]]);
        let exact = UNCERTAINTY_OF_HALVES * (halves - every).abs() / halves;
        assert!((off.volume - exact).abs() < 1e-12, "{off:?} {exact}");
        assert!((off.depth - exact).abs() < 1e-12, "{off:?} {exact}");
    }

    #[test]
    fn cycles_that_are_all_computed_are_not_off() {
        let mut made = JumpError::default();
        made.enter(&[vec![1.0]], None);
        let places = [vec![(true, 1.0)]];
        assert_eq!(made.off(&places), Off::default());
        assert_eq!(made.reach(&places, &[vec![1.0]], 0.1, 50.0), 1.0);
        made.enter(&[vec![0.9]], Some(vec![vec![0.1]]));
        let few = made.reach(&places, &[vec![0.9]], 0.1, 50.0);
        made.enter(&[vec![0.9]], Some(vec![vec![0.001]]));
        let many = made.reach(&places, &[vec![0.9]], 0.1, 50.0);
        assert!(few < 8.0 && many > 20.0, "{few} {many}");
    }
}
