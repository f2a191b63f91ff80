//! Whether surfaces touch, and how hard.

use crate::contact::interface::view::ContactView;
use crate::contact::response::Status;

/// Whether pressure is a multiplier, which has whatever size it takes to hold a mass.
pub fn is_hard(contact: ContactView) -> bool {
    !contact.laws.tied && contact.unknown() && contact.laws.needs_normal_stiffness()
}

/// Whether any point is in contact at the last accepted state.
pub fn touched(contact: ContactView) -> bool {
    let committed = contact.state.points.iter();
    committed.into_iter().any(|h| h.status != Status::Open)
}

/// Whether any point is in contact at the last accepted state, and remembers by friction what it was on.
pub fn rubs(contact: ContactView) -> bool {
    !contact.laws.tied && contact.laws.friction_law().frictional() && touched(contact)
}
