//! How long the rest of an analysis takes, if that can be told.

use stickslip::model::Step;

/// Part of the work after which there is something to go by, and increments.
const BEGINNING: f64 = 0.02;
const FEW: usize = 4;

/// Ratio of the speeds of the two halves of what is done beyond which nothing follows for the rest.
const STEADY: f64 = 2.0;

/// Most looks at the clock that are kept.
const MOST: usize = 512;

/// What is done, and what it took.
#[derive(Debug, Default)]
pub struct Remaining {
    /// Part of the work, rising, and seconds.
    looks: Vec<(f64, f64)>,
}

impl Remaining {
    /// This part of the work was done after so many seconds.
    pub fn note(&mut self, done: f64, seconds: f64) {
        self.looks.push((done, seconds));
        if self.looks.len() > MOST {
            let mut odd = false;
            self.looks.retain(|_| {
                odd = !odd;
                odd
            });
        }
    }

    /// Seconds that are left: the rest goes as fast as the second half of what is done, if that went about as fast as the first.
    pub fn seconds(&self) -> Option<f64> {
        let &(done, now) = self.looks.last()?;
        if self.looks.len() < FEW || done < BEGINNING {
            return None;
        }
        let half = self.looks.iter().rfind(|(part, _)| *part <= 0.5 * done);
        let &(part, then) = half?;
        let (first, second) = (
            then / part.max(f64::MIN_POSITIVE),
            (now - then) / (done - part),
        );
        let steady = second <= STEADY * first && first <= STEADY * second;
        steady.then_some((1.0 - done) * second)
    }
}

/// The part of the increments of an analysis that is done at time `t` of a step; `None` where steps of another kind follow, the increments of which take another time.
pub fn part(steps: &[Step], step: usize, t: f64) -> Option<f64> {
    let now = steps.get(step)?;
    let kind = |s: &Step| (s.dynamic.is_some(), s.is_explicit());
    if steps[step..].iter().any(|s| kind(s) != kind(now)) {
        return None;
    }
    let count = |s: &Step| {
        let length = (s.increments.initial * s.increments.largest).sqrt();
        ((s.end - s.start) / length).clamp(1.0, 1e9)
    };
    // What went before in another kind of step is no measure either.
    let first = steps[..step].iter().rposition(|s| kind(s) != kind(now));
    let same = first.map_or(0, |k| k + 1);
    let all: f64 = steps[same..].iter().map(count).sum();
    let before: f64 = steps[same..step].iter().map(count).sum();
    let within = ((t - now.start) / (now.end - now.start)).clamp(0.0, 1.0);
    Some((before + within * count(now)) / all)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Estimates after each of a hundred increments that take so long, each with the time that really was left.
    fn estimates(seconds: impl Fn(usize) -> f64) -> Vec<(Option<f64>, f64)> {
        let all: f64 = (0..100).map(&seconds).sum();
        let (mut remaining, mut spent) = (Remaining::default(), 0.0);
        let each = (0..99).map(|k| {
            spent += seconds(k);
            remaining.note((k + 1) as f64 / 100.0, spent);
            (remaining.seconds(), all - spent)
        });
        each.collect()
    }

    #[test]
    fn a_steady_run_is_told_within_a_factor_of_two() {
        for (told, left) in estimates(|k| 1.0 + 0.3 * (k % 3) as f64)
            .into_iter()
            .skip(8)
        {
            let told = told.expect("an estimate");
            assert!(told < 2.0 * left && left < 2.0 * told, "{told} {left}");
        }
    }

    #[test]
    fn a_run_that_has_just_become_slow_or_fast_is_told_to_be_unknown() {
        // A hundred times slower from the middle on: after that nothing is told that is too small by more than two.
        for (told, left) in estimates(|k| if k < 50 { 0.01 } else { 1.0 })
            .into_iter()
            .skip(51)
        {
            assert!(told.is_none_or(|told| left < 2.0 * told), "{told:?} {left}");
        }
        let told = estimates(|k| 1.1f64.powi(k as i32));
        assert!(
            told[30..].iter().all(|(told, _)| told.is_none()),
            "{told:?}"
        );
    }

    #[test]
    fn little_is_no_measure() {
        let mut remaining = Remaining::default();
        assert_eq!(remaining.seconds(), None);
        remaining.note(1e-4, 1.0);
        assert_eq!(remaining.seconds(), None);
        for k in 0..10_000 {
            remaining.note(k as f64 * 1e-4, k as f64);
        }
        assert!(remaining.looks.len() <= MOST);
    }
}
