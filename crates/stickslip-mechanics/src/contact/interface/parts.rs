//! An interface with all that it knows: what it is, what it has been through, and what it works with.

use super::attempt::Attempt;
use super::cache::Cache;
use super::conditions::Conditions;
use super::definition::InterfaceDefinition;
use super::history::History;
use super::input::InterfaceInput;
use super::view::ContactView;

/// An interface, and what it knows.
#[derive(Debug, Clone)]
pub struct Interface {
    /// What it is.
    pub definition: InterfaceDefinition,
    /// What accepted increments have left; all that a checkpoint has to hold.
    pub state: History,
    /// The attempt at the next one.
    pub attempt: Attempt,
    /// What holds in the attempt.
    pub conditions: Conditions,
    /// What can be made again.
    pub cache: Cache,
}

impl std::ops::Deref for Interface {
    type Target = InterfaceDefinition;

    fn deref(&self) -> &InterfaceDefinition {
        &self.definition
    }
}

impl Interface {
    /// One that nothing has happened to yet.
    pub fn new(definition: InterfaceDefinition) -> Self {
        Interface {
            definition,
            state: History::default(),
            attempt: Attempt::default(),
            conditions: Conditions::default(),
            cache: Cache::default(),
        }
    }

    /// It as those see it who only look.
    pub fn view(&self) -> ContactView<'_> {
        ContactView {
            definition: &self.definition,
            state: &self.state,
        }
    }

    /// It as evaluations see it.
    pub(in crate::contact) fn input(&self) -> InterfaceInput<'_> {
        InterfaceInput {
            contact: self.view(),
            attempt: &self.attempt,
            conditions: &self.conditions,
        }
    }

    /// It as evaluations see it, and what they work with.
    pub(super) fn parts(&mut self) -> (InterfaceInput<'_>, &mut Cache) {
        let contact = ContactView {
            definition: &self.definition,
            state: &self.state,
        };
        let input = InterfaceInput {
            contact,
            attempt: &self.attempt,
            conditions: &self.conditions,
        };
        (input, &mut self.cache)
    }

    /// Makes room for all points, and begins an attempt if there is none.
    pub(super) fn ready(&mut self) {
        self.state.fit(self.definition.points.len());
        if self.attempt.multipliers.len() != self.definition.points.len() {
            self.begin_attempt();
        }
    }

    /// An attempt from the committed history.
    pub(super) fn begin_attempt(&mut self) {
        let accepted = self.view().accepted_gap();
        self.attempt.restart(&self.state.points, accepted);
        self.cache.last.points.clear();
    }
}
