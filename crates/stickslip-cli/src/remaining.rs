//! How long the rest of an analysis takes, if that can be told.

use stickslip::model::Step;

/// Increments after which there is something to go by.
const FEW_INCREMENTS: usize = 4;

/// Factor by which an estimate made earlier may differ from the time that passed since. Tuned: on six examples every estimate that is printed
/// was within a factor of 1.7, and without this check some were off by a factor of seven.
const LARGEST_ERROR: f64 = 1.6;

/// How many earlier moments are asked.
const MOMENTS: usize = 12;
/// The first of the earlier moments is when this part of what is done was done: rates are those of the second half, which is an eighth of
/// the work before that.
const FIRST_MOMENT: f64 = 0.25;

/// Most looks at the clock that are kept.
const MOST_LOOKS: usize = 512;

/// What is done, and what it took.
#[derive(Debug, Default)]
pub struct Remaining {
    /// Part of the work, rising, and seconds; the first is where counting begins.
    looks: Vec<(f64, f64)>,
}

impl Remaining {
    /// This part of the work was done after so many seconds. Where it is less than before, work of another kind has begun.
    pub fn note(&mut self, done: f64, seconds: f64) {
        if self.looks.last().is_some_and(|(before, _)| done < *before) {
            self.looks.clear();
        }
        self.looks.push((done, seconds));
        if self.looks.len() > MOST_LOOKS {
            let mut odd = false;
            self.looks.retain(|_| {
                odd = !odd;
                odd
            });
        }
    }

    /// Seconds that are left, if that is known: the rest goes as fast as the second half of what is done, and whoever had said so of what is done at
    /// several moments before would have been right.
    pub fn seconds(&self) -> Option<f64> {
        let (&(first, begun), &(done, now)) = (self.looks.first()?, self.looks.last()?);
        // There is something to go by after a twentieth of the work, some increments and a second.
        if self.looks.len() < FEW_INCREMENTS || done - first < 0.05 || now - begun < 1.0 {
            return None;
        }
        // The last had half as far to see as is to be seen now, or a quarter of what is done.
        let far = (1.0 - done).min(0.5 * (done - first));
        let last = 1.0 - 0.5 * far / (done - first);
        for moment in 0..MOMENTS {
            let along = moment as f64 / (MOMENTS - 1) as f64;
            let part = FIRST_MOMENT + (last - FIRST_MOMENT) * along;
            let (k, (then, at)) = self.at(first + part * (done - first))?;
            let told = self.rate(k)? * (done - then);
            let right = told <= LARGEST_ERROR * (now - at) && now - at <= LARGEST_ERROR * told;
            if !right {
                return None;
            }
        }
        Some((1.0 - done) * self.rate(self.looks.len() - 1)?)
    }

    /// The last look at which no more than this part was done.
    fn at(&self, part: f64) -> Option<(usize, (f64, f64))> {
        let after = self.looks.partition_point(|(done, _)| *done <= part);
        let k = after.checked_sub(1)?;
        Some((k, self.looks[k]))
    }

    /// Seconds for the whole work, by the second half of what was done at a look; unknown before there are two.
    fn rate(&self, k: usize) -> Option<f64> {
        let (first, _) = self.looks[0];
        let (done, now) = self.looks[k];
        let (_, (part, then)) = self.at(0.5 * (first + done))?;
        (done > part).then(|| (now - then) / (done - part))
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
    fn bursts_are_told_to_be_unknown_or_within_a_factor_of_two() {
        // Most increments are quick, and now and then some are slow: at events, say.
        for (quick, slow) in [(3, 1), (8, 2), (8, 5), (2, 5)] {
            let seconds = |k: usize| match k % (quick + slow) < quick {
                true => 0.1,
                false => 2.0,
            };
            let told = estimates(seconds).into_iter();
            let wrong = told.filter(|(told, left)| {
                told.is_some_and(|told| told > 2.0 * left || *left > 2.0 * told)
            });
            // At the very end a burst more or less counts.
            let wrong = wrong.filter(|(_, left)| *left > 4.0 * slow as f64);
            assert_eq!(wrong.count(), 0, "{quick} {slow}");
        }
    }

    #[test]
    fn little_is_no_measure() {
        let mut remaining = Remaining::default();
        assert_eq!(remaining.seconds(), None);
        for k in 0..50 {
            remaining.note(k as f64 * 0.01, 1e-3 * k as f64);
        }
        // Half of it, but in no time.
        assert_eq!(remaining.seconds(), None);
        // Work of another kind counts from its own beginning.
        for k in 0..50 {
            remaining.note(k as f64 * 0.01, 100.0 + k as f64);
        }
        let told = remaining.seconds().expect("an estimate");
        assert!((told - 51.0).abs() < 1e-9, "{told}");
        let mut remaining = Remaining::default();
        remaining.note(1e-4, 1.0);
        assert_eq!(remaining.seconds(), None);
        for k in 0..10_000 {
            remaining.note(k as f64 * 1e-4, k as f64);
        }
        assert!(remaining.looks.len() <= MOST_LOOKS);
    }
}
