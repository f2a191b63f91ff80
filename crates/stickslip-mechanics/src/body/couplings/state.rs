//! What a checkpoint has of couplings.

use super::all::{Couplings, Hold, Iterate};

/// All that couplings know beyond their definition and what accepted increments have left.
#[derive(Debug, Clone, crate::keep::Keep)]
pub struct CouplingsState {
    hold: Vec<Hold>,
    iterate: Iterate,
    explicit: bool,
}

impl Couplings {
    /// All that they know beyond their definition and what accepted increments have left.
    pub fn state(&self) -> CouplingsState {
        CouplingsState {
            hold: self.hold.clone(),
            iterate: self.iterate.clone(),
            explicit: self.explicit,
        }
    }

    /// Goes on with that.
    pub fn go_on_from(&mut self, state: CouplingsState) {
        let CouplingsState {
            hold,
            iterate,
            explicit,
        } = state;
        self.hold = hold;
        self.iterate = iterate;
        self.explicit = explicit;
    }
}
