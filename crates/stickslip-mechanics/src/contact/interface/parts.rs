//! An interface with all that it knows: what it is, what it has been through, and what it works with.

use super::attempt::Attempt;
use super::cache::Cache;
use super::definition::InterfaceDefinition;
use super::directives::Directives;
use super::history::History;
use super::view::ContactView;

/// An interface, and what it knows.
#[derive(Debug, Clone)]
pub struct Interface {
    /// What it is.
    pub definition: InterfaceDefinition,
    /// What accepted increments have left; all that a checkpoint has to hold.
    pub history: History,
    /// The attempt at the next one.
    pub attempt: Attempt,
    /// How it is to act at present.
    pub directives: Directives,
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
            history: History::default(),
            attempt: Attempt::default(),
            directives: Directives::default(),
            cache: Cache::default(),
        }
    }

    /// It as those see it who only look.
    pub fn view(&self) -> ContactView<'_> {
        ContactView {
            definition: &self.definition,
            state: &self.history,
        }
    }

    /// Makes room for all points, and begins an attempt if there is none.
    pub(in crate::contact) fn ready(&mut self) {
        self.history.fit(self.points.len());
        if self.attempt.multipliers.len() != self.points.len() {
            self.begin_attempt();
        }
    }

    /// An attempt from the committed history.
    pub(in crate::contact) fn begin_attempt(&mut self) {
        let accepted = self.accepted();
        let before = std::mem::take(&mut self.attempt);
        self.attempt = before.next(&self.history.points, accepted);
        self.cache.last.points.clear();
    }

    /// Does something with what can be made again, which is lent out for that: the rest stays as it is.
    pub(in crate::contact) fn lend<T>(&mut self, work: impl FnOnce(&Self, &mut Cache) -> T) -> T {
        let mut cache = std::mem::take(&mut self.cache);
        let done = work(self, &mut cache);
        self.cache = cache;
        done
    }
}
