//! An interface: what it is, and what it works with.

use super::attempt::Attempt;
use super::cache::Cache;
use super::conditions::Conditions;
use super::definition::InterfaceDefinition;
use super::history::History;
use super::input::InterfaceInput;
use super::view::ContactView;

/// An interface without what it has been through.
#[derive(Debug, Clone)]
pub struct Interface {
    /// What it is.
    pub definition: InterfaceDefinition,
    /// The attempt at the next increment.
    pub attempt: Attempt,
    /// What can be made again.
    pub cache: Cache,
}

/// An interface as a force, which goes on from a history.
#[derive(Debug)]
pub struct InterfaceForce<'a> {
    /// What it is.
    pub definition: &'a InterfaceDefinition,
    /// What accepted increments have left.
    pub state: &'a History,
    /// The attempt at the next one.
    pub attempt: &'a mut Attempt,
    /// What holds in the attempt.
    pub conditions: &'a Conditions,
    /// What can be made again.
    pub cache: &'a mut Cache,
}

impl std::ops::Deref for Interface {
    type Target = InterfaceDefinition;

    fn deref(&self) -> &InterfaceDefinition {
        &self.definition
    }
}

impl std::ops::Deref for InterfaceForce<'_> {
    type Target = InterfaceDefinition;

    fn deref(&self) -> &InterfaceDefinition {
        self.definition
    }
}

impl Interface {
    /// One with which nothing has been tried yet.
    pub fn new(definition: InterfaceDefinition) -> Self {
        Interface {
            definition,
            attempt: Attempt::default(),
            cache: Cache::default(),
        }
    }

    /// It as those see it who only look.
    pub fn view<'a>(&'a self, state: &'a History) -> ContactView<'a> {
        ContactView {
            definition: &self.definition,
            state,
        }
    }

    /// It as a force that goes on from a history, under these conditions.
    pub fn force<'a>(
        &'a mut self,
        state: &'a History,
        conditions: &'a Conditions,
    ) -> InterfaceForce<'a> {
        InterfaceForce {
            definition: &self.definition,
            state,
            attempt: &mut self.attempt,
            conditions,
            cache: &mut self.cache,
        }
    }
}

impl InterfaceForce<'_> {
    /// It as those see it who only look.
    pub fn view(&self) -> ContactView<'_> {
        ContactView {
            definition: self.definition,
            state: self.state,
        }
    }

    /// It as evaluations see it.
    pub(super) fn input(&self) -> InterfaceInput<'_> {
        InterfaceInput {
            contact: self.view(),
            attempt: self.attempt,
            conditions: self.conditions,
        }
    }

    /// It as evaluations see it, and what they work with.
    pub(super) fn parts(&mut self) -> (InterfaceInput<'_>, &mut Cache) {
        let contact = ContactView {
            definition: self.definition,
            state: self.state,
        };
        let input = InterfaceInput {
            contact,
            attempt: self.attempt,
            conditions: self.conditions,
        };
        (input, self.cache)
    }

    /// An attempt from the committed history.
    pub(super) fn begin_attempt(&mut self) {
        let accepted = self.view().accepted_gap();
        self.attempt.restart(&self.state.points, accepted);
        self.cache.last.points.clear();
    }
}
