//! What a checkpoint has of couplings.

use super::all::{Couplings, Hold, Iterate};

crate::keep!(Hold { stiffness, idle });
crate::keep!(Iterate {
    last,
    off,
    now,
    off_now
});

/// All that couplings know beyond their definition and what accepted increments have left.
#[derive(Debug, Clone)]
pub struct CouplingsState {
    hold: Vec<Hold>,
    iterate: Iterate,
    explicit: bool,
}

crate::keep!(CouplingsState {
    hold,
    iterate,
    explicit
});

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
