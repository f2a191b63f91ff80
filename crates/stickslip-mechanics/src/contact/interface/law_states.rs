//! How fast the state variables of friction laws change.

use super::parts::Interface;
use super::view::ContactView;
use crate::contact::law::friction::LawState;
use crate::contact::response::Status;

/// The fastest relative change of state variables at an accepted state `[1/s]`; zero where there are none.
pub fn rate_of_change(contact: ContactView) -> f64 {
    let states = contact.state.law_states.iter().copied().enumerate();
    fastest(contact, states)
}

/// The same at the end of an attempt, of points in contact.
pub fn rate_of_attempt(interface: &Interface, before: ContactView) -> f64 {
    if before.state.law_states.is_empty() {
        return 0.0;
    }
    let last = interface.cache.last.points.iter().enumerate();
    let touching = last.filter(|(_, e)| e.response.status != Status::Open);
    fastest(before, touching.map(|(i, e)| (i, e.response.state)))
}

fn fastest(contact: ContactView, states: impl Iterator<Item = (usize, LawState)>) -> f64 {
    let law = contact.laws.friction_law();
    let rates =
        states.map(|(i, state)| law.rate_of_change(&state, contact.place(&contact.points[i])));
    rates.fold(0.0, f64::max)
}
