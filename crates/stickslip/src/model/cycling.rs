//! Steps that are gone through again and again, where one cycle that is computed may stand for many.

use crate::tolerance::SAME;
use serde::{Deserialize, Serialize};

/// The cycles of a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cycling {
    /// Duration of one `[s]`.
    pub period: f64,
    /// How many there are.
    pub count: usize,
    /// How many of them each one that is computed stands for; the last for those that are left.
    pub jump: Jump,
}

/// How many cycles one that is computed stands for: what slides in it wears as often.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(
    untagged,
    expecting = "expected a number of cycles, or the error by which jumps are chosen: { error = 0.01 }"
)]
pub enum Jump {
    /// Always so many.
    Fixed(#[cfg_attr(feature = "schema", schemars(range(min = 1)))] usize),
    /// As many as an error allows.
    Chosen(ChosenJump),
}

/// Jumps that are as long as an error allows. `TIME` and `output.times` are those of all cycles then: where some are jumped over time jumps as well, and no jump goes past a time of
/// output.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct ChosenJump {
    /// Largest error of jumps, compared with computing all cycles: of the worn volume relative to itself, summed over the places of a surface without
    /// sign, and of the depth at every place relative to the greatest. A jump that is too long is repeated with fewer cycles `[-]`.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0), range(max = 1)))]
    pub error: f64,
    /// Number of cycles of the first jump. Default: 1.
    #[cfg_attr(feature = "schema", schemars(range(min = 1)))]
    #[serde(default = "once", skip_serializing_if = "is_once")]
    pub first: usize,
    /// Largest number of cycles of a jump. Default: all that remain.
    #[cfg_attr(feature = "schema", schemars(range(min = 1)))]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub largest: Option<usize>,
}

impl Default for Jump {
    fn default() -> Self {
        Jump::Fixed(1)
    }
}

fn once() -> usize {
    1
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde asks like that")]
fn is_once(n: &usize) -> bool {
    *n == 1
}

/// The cycle at hand, in steps that choose their jumps: those before it, and how many it stands for, itself included.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, crate::keep::Keep)]
pub struct Block {
    /// Cycles that were over when it began.
    pub before: usize,
    /// How many it stands for; 0 between two of them.
    pub stands_for: usize,
}

impl Cycling {
    /// How jumps are chosen, if they are.
    pub fn chosen(&self) -> Option<ChosenJump> {
        match self.jump {
            Jump::Fixed(_) => None,
            Jump::Chosen(chosen) => Some(chosen),
        }
    }

    /// The cycle in which an increment lies that begins a time `since` the step did; `at_hand` where jumps are chosen.
    pub fn block(&self, since: f64, at_hand: Block) -> Block {
        let Jump::Fixed(jump) = self.jump else {
            return at_hand;
        };
        let block = (since / self.period + SAME).floor().max(0.0) as usize;
        let before = block.saturating_mul(jump).min(self.count);
        Block {
            before,
            stands_for: jump.min(self.count - before).max(1),
        }
    }

    /// Whether a computed cycle begins a time `since` the step did.
    pub fn begins(&self, since: f64) -> bool {
        let cycles = since / self.period;
        (cycles - cycles.round()).abs() < SAME * cycles.max(1.0)
    }

    /// Whether a computed cycle ends with an increment between two times since the step began.
    pub fn ends(&self, [from, to]: [f64; 2]) -> bool {
        let begun = (from / self.period + SAME).floor();
        to / self.period >= begun + 1.0 - SAME
    }

    /// Cycles that are over a time `since` the step began `[-]`.
    pub fn done(&self, since: f64, at_hand: Block) -> f64 {
        let Block { before, stands_for } = self.block(since, at_hand);
        let cycles = since / self.period;
        let part = match self.jump {
            Jump::Fixed(_) => cycles - (cycles + SAME).floor().max(0.0),
            // The last of those that it stands for is computed.
            Jump::Chosen(_) => cycles + 1.0 - (before + stands_for) as f64,
        };
        (before as f64 + part.clamp(0.0, 1.0) * stands_for as f64).min(self.count as f64)
    }
}

impl Block {
    /// The time since the beginning of the step at which it is computed: that of the last cycle that it stands for.
    pub fn begins(&self, period: f64) -> f64 {
        (self.before + self.stands_for.max(1) - 1) as f64 * period
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cycles_are_counted_as_they_are_computed() {
        let fixed = Cycling {
            period: 2.0,
            count: 20,
            jump: Jump::Fixed(8),
        };
        let none = Block::default();
        for (since, stands_for, done) in [
            (0.0, 8, 0.0),
            (1.0, 8, 4.0),
            (2.0, 8, 8.0),
            (5.0, 4, 18.0),
            (6.0, 1, 20.0),
        ] {
            assert_eq!(fixed.block(since, none).stands_for, stands_for);
            assert_eq!(fixed.done(since, none), done);
        }
        let chosen = Cycling {
            jump: Jump::Chosen(ChosenJump {
                error: 0.1,
                first: 1,
                largest: None,
            }),
            ..fixed
        };
        let block = Block {
            before: 3,
            stands_for: 10,
        };
        assert_eq!(block.begins(2.0), 24.0);
        for (since, done) in [(24.0, 3.0), (25.0, 8.0), (26.0, 13.0)] {
            assert_eq!(chosen.done(since, block), done);
        }
    }
}
