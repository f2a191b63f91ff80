//! Loads that stay and loads that shake.

use crate::deck::{Action, Deck, Step};

/// Which loads are meant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Part {
    /// Those that stay from step to step.
    Lasting,
    /// The real parts of those that shake.
    Real,
    /// Their imaginary parts.
    Imaginary,
}

impl Part {
    /// The parts that a deck has.
    pub fn of(deck: &Deck) -> Vec<Part> {
        match deck.steps.iter().any(Step::is_harmonic) {
            true => vec![Part::Lasting, Part::Real, Part::Imaginary],
            false => vec![Part::Lasting],
        }
    }

    /// Whether nothing of the step before counts.
    pub fn begins_anew(self) -> bool {
        self != Part::Lasting
    }

    /// The actions of a step that count.
    pub fn actions(self, step: &Step) -> impl Iterator<Item = &Action> {
        let harmonic = step.is_harmonic() == (self != Part::Lasting);
        let counts = move |a: &&Action| match a {
            Action::Force { imaginary, .. } | Action::Distributed { imaginary, .. } => {
                harmonic && (self == Part::Lasting || *imaginary == (self == Part::Imaginary))
            }
            _ => harmonic,
        };
        step.actions.iter().filter(counts)
    }
}
