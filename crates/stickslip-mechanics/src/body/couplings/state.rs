//! What a checkpoint has of couplings.

use super::all::{Couplings, Hold, Iterate};
use super::memory::CouplingsMemory;

crate::keep!(Hold { stiffness, idle });
crate::keep!(Iterate {
    last,
    off,
    now,
    off_now
});

/// All that couplings know beyond their definition.
#[derive(Debug, Clone)]
pub struct CouplingsState {
    hold: Vec<Hold>,
    iterate: Iterate,
    memory: CouplingsMemory,
    explicit: bool,
}

crate::keep!(CouplingsState {
    hold,
    iterate,
    memory,
    explicit
});

impl Couplings {
    /// All that they know beyond their definition.
    pub fn state(&self) -> CouplingsState {
        CouplingsState {
            hold: self.hold.clone(),
            iterate: self.iterate.clone(),
            memory: self.memory.clone(),
            explicit: self.explicit,
        }
    }

    /// Goes on with that.
    pub fn go_on_from(&mut self, state: CouplingsState) {
        let CouplingsState {
            hold,
            iterate,
            memory,
            explicit,
        } = state;
        self.hold = hold;
        self.iterate = iterate;
        self.memory = memory;
        self.explicit = explicit;
    }
}
