//! What is remembered of jumps over cycles from one block to the next.

use super::jump_error::JumpError;

/// By interface and place.
pub(super) type Amounts = Vec<Vec<f64>>;

/// What is known of the blocks of a step.
#[derive(Debug, Clone, Default, crate::keep::Keep)]
pub(super) struct Jumps {
    /// The next is to stand for so many cycles; where something wears, it and the one after it together.
    pub wish: f64,
    /// What had been taken when the block began, and what a cycle of the block before took.
    pub start: Amounts,
    pub rates: Amounts,
    /// By how much a cycle of each of the last blocks differed from one of the block before, relative to what it took; no more than three.
    pub changes: Vec<f64>,
    /// Blocks that were kept, and those that were taken back.
    pub kept: usize,
    pub rejected: usize,
    /// The jump that is tried, where something wears.
    pub trial: Option<Halved>,
    /// What the error of the jumps so far comes to.
    pub made: JumpError,
}

/// A jump that is tried as a whole and as two halves: what both wear off tells the error.
#[derive(Debug, Clone, Default, crate::keep::Keep)]
pub(super) struct Halved {
    /// Cycles that it stands for.
    pub cycles: usize,
    /// What the whole wears off.
    pub whole: Option<Amounts>,
    /// What the first half wears off, once it is over.
    pub first: Option<Amounts>,
}

impl Halved {
    /// How many cycles each half stands for.
    pub fn halves(&self) -> [usize; 2] {
        let first = self.cycles / 2;
        [first, self.cycles - first]
    }
}

impl Jumps {
    pub(super) fn note_change(&mut self, change: f64) {
        if self.changes.len() == 3 {
            self.changes.remove(0);
        }
        self.changes.push(change);
    }

    /// Whether cycles in which nothing wears are as good as equal to the last one.
    pub(super) fn settles(&self, error: f64) -> bool {
        self.to_come() <= error
    }

    /// Whether the one of so many that was computed differs too much from the one before for all of them to be like it, and so will those to come.
    pub(super) fn overshot(&self, stands_for: usize, error: f64) -> bool {
        let last = self.changes.last().copied().unwrap_or(0.0);
        stands_for > 1 && last * stands_for as f64 > error && last + self.to_come() > error
    }

    /// By how much cycles in which nothing wears will come to differ from the last one, however many there are: what friction keeps from one to the next settles, and changes that
    /// fall by the larger of their last two quotients are a geometric series. Infinite as long as they do not fall.
    fn to_come(&self) -> f64 {
        let [before, between, last] = self.changes[..] else {
            return f64::INFINITY;
        };
        let quotient = (between / before).max(last / between);
        match quotient < 1.0 {
            true => last * quotient / (1.0 - quotient),
            false => f64::INFINITY,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Jumps;

    #[test]
    fn changes_that_fall_are_summed_and_others_are_not() {
        let mut jumps = Jumps::default();
        for change in [0.4, 0.1] {
            jumps.note_change(change);
            assert_eq!(jumps.to_come(), f64::INFINITY);
        }
        // The larger quotient, a half: 0.025 + 0.0125 + ...
        jumps.note_change(0.05);
        assert!((jumps.to_come() - 0.05).abs() < 1e-15);
        jumps.note_change(0.05);
        assert_eq!(jumps.to_come(), f64::INFINITY);
        for _ in 0..3 {
            jumps.note_change(0.0);
        }
        assert_eq!(jumps.to_come(), f64::INFINITY, "nothing to go by");
    }

    #[test]
    fn a_jump_is_taken_back_if_changes_did_not_fall_as_expected() {
        let jumps = |changes: &[f64]| Jumps {
            changes: changes.to_vec(),
            ..Jumps::default()
        };
        let error = 1e-3;
        assert!(jumps(&[1e-1, 1e-2, 1e-3]).settles(error));
        assert!(!jumps(&[1e-1, 1e-2, 9e-3]).settles(error));
        // As expected, larger than expected, and as large but of few cycles.
        assert!(!jumps(&[1e-2, 1e-3, 1e-4]).overshot(990, error));
        assert!(jumps(&[1e-2, 1e-3, 9e-4]).overshot(990, error));
        assert!(!jumps(&[1e-2, 1e-3, 9e-5]).overshot(10, error));
        assert!(!jumps(&[1e-2, 1e-3, 1e-3]).overshot(1, error));
        assert!(!jumps(&[0.0; 3]).overshot(990, error));
    }
}
