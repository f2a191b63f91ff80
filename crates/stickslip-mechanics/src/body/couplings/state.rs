//! What a checkpoint has of couplings.

use super::all::{Couplings, Hold, Iterate};

/// All that couplings know beyond their definition and what accepted increments have left.
#[derive(Debug, Clone, crate::keep::Keep)]
pub struct CouplingsState {
    hold: Vec<Hold>,
    iterate: Iterate,
    explicit: bool,
}

/// All that they know beyond their definition and what accepted increments have left.
pub fn state(couplings: &Couplings) -> CouplingsState {
    CouplingsState {
        hold: couplings.hold.clone(),
        iterate: couplings.iterate.clone(),
        explicit: couplings.explicit,
    }
}

/// Goes on with that.
pub fn go_on_from(couplings: &mut Couplings, state: CouplingsState) {
    let CouplingsState {
        hold,
        iterate,
        explicit,
    } = state;
    couplings.hold = hold;
    couplings.iterate = iterate;
    couplings.explicit = explicit;
}
