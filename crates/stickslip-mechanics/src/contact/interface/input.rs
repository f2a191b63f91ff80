//! What an evaluation of an interface reads, and never writes.

use super::attempt::Attempt;
use super::conditions::Conditions;
use super::view::ContactView;

/// What an interface is and what accepted increments have left, the attempt at the next one, and what holds in it.
#[derive(Debug, Clone, Copy)]
pub(in crate::contact) struct InterfaceInput<'a> {
    pub contact: ContactView<'a>,
    pub attempt: &'a Attempt,
    pub conditions: &'a Conditions,
}

impl<'a> std::ops::Deref for InterfaceInput<'a> {
    type Target = ContactView<'a>;

    fn deref(&self) -> &ContactView<'a> {
        &self.contact
    }
}
