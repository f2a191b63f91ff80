//! What a checkpoint has of couplings.

use super::all::{Couplings, CouplingsMemory, Hold, Iterate};

crate::keep!(Hold { stiffness, idle });
crate::keep!(CouplingsMemory {
    multipliers,
    forces,
    targets,
    rest,
    stored,
    work,
    damped
});
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
    start: Vec<f64>,
    iterate: Iterate,
    memory: CouplingsMemory,
    explicit: bool,
}

crate::keep!(CouplingsState {
    hold,
    start,
    iterate,
    memory,
    explicit
});

impl Couplings {
    /// All that they know beyond their definition.
    pub fn state(&self) -> CouplingsState {
        CouplingsState {
            hold: self.hold.clone(),
            start: self.start.clone(),
            iterate: self.iterate.clone(),
            memory: self.memory.clone(),
            explicit: self.explicit,
        }
    }

    /// Goes on with that.
    pub fn go_on_from(&mut self, state: CouplingsState) {
        let CouplingsState {
            hold,
            start,
            iterate,
            memory,
            explicit,
        } = state;
        self.hold = hold;
        self.start = start;
        self.iterate = iterate;
        self.memory = memory;
        self.explicit = explicit;
    }
}
