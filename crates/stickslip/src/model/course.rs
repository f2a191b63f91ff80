//! Where the last increments came from, and where the next one is expected to end.

use crate::math::vector::norm;

/// Increments that are remembered: what two have in common is a parabola.
const REACH: usize = 2;

/// Part of the way of an increment by which it may bend away from a straight line and still be expected to go on bending. Where points
/// begin to slip or a load turns, the last two increments say nothing of the next, and a straight line is the safer guess.
/// With 0.03 and 0.3 all short cases (see [`tolerance`](crate::tolerance)) keep their expected values, within 0.5 % of the same number of iterations.
const LARGEST_BEND: f64 = 0.1;

/// The last increments of a quasi-static step, as long as what drives them goes on as it did.
#[derive(Debug, Clone, Default, crate::keep::Keep)]
pub struct Course {
    /// The length of each `[s]` and the numbers at its start, the latest first.
    past: Vec<(f64, Vec<f64>)>,
}

impl Course {
    /// What the last increments did is no guide any more.
    pub fn forget(&mut self) {
        self.past.clear();
    }

    /// Takes note of an increment of a `length` that is over, and of the numbers at its start.
    pub fn go_on(&mut self, length: f64, start: Vec<f64>) {
        self.past.truncate(REACH - 1);
        self.past.insert(0, (length, start));
    }

    /// By how much numbers that are `now` are expected to change in an increment of a `length`, along the straight line through the last one. `None` where
    /// nothing is known.
    pub fn straight(&self, now: &[f64], length: f64) -> Option<Vec<f64>> {
        let (last, start) = self.past.first()?;
        let way = |(b, a): (&f64, &f64)| length / last * (b - a);
        Some(now.iter().zip(start).map(way).collect())
    }

    /// The same along the parabola through the last two increments, by divided differences, as long as it stays near the line.
    pub fn ahead(&self, now: &[f64], length: f64) -> Option<Vec<f64>> {
        let (last, start) = self.past.first()?;
        let mut ahead = self.straight(now, length)?;
        if let Some((before, first)) = self.past.get(1) {
            let factor = length * (length + last) / (last + before);
            let bend = now.iter().zip(start).zip(first);
            let bend: Vec<f64> = bend
                .map(|((c, b), a)| factor * ((c - b) / last - (b - a) / before))
                .collect();
            if norm(&bend) <= LARGEST_BEND * norm(&ahead) {
                ahead.iter_mut().zip(bend).for_each(|(a, b)| *a += b);
            }
        }
        Some(ahead)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The course of two functions of time, and by how much they are expected to change in the next increment.
    fn followed(times: &[f64], next: f64, of: impl Fn(f64) -> Vec<f64>) -> Option<Vec<f64>> {
        let mut course = Course::default();
        for pair in times.windows(2) {
            course.go_on(pair[1] - pair[0], of(pair[0]));
        }
        let last = times[times.len() - 1];
        course.ahead(&of(last), next - last)
    }

    #[test]
    fn a_parabola_is_met_whatever_the_increments() {
        let of = |t: f64| vec![1.0 + 3.0 * t + 0.2 * t * t, -2.0 * t + 0.1 * t * t];
        let found = followed(&[0.3, 0.5, 0.8, 0.9], 1.3, of).expect("two increments are known");
        for ((found, then), now) in found.iter().zip(of(1.3)).zip(of(0.9)) {
            assert!((found - (then - now)).abs() < 1e-14, "{found:?}");
        }
    }

    #[test]
    fn a_corner_is_left_along_a_straight_line() {
        let of = |t: f64| vec![(t - 1.0).max(0.0)];
        let found = followed(&[0.5, 1.0, 1.2], 1.5, of).expect("an increment is known");
        assert!((found[0] - 0.3).abs() < 1e-15, "{found:?}");
        assert_eq!(followed(&[0.5], 1.0, of), None);
    }

    #[test]
    fn what_is_forgotten_is_no_guide() {
        let mut course = Course::default();
        course.go_on(1.0, vec![0.0]);
        course.forget();
        assert_eq!(course.ahead(&[1.0], 1.0), None);
    }
}
