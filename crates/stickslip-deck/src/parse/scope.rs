//! Whose names and numbers are meant: those of an instance, or of what stands outside of all.

use super::known::nearest;
use super::reader::Reader;
use crate::card::Card;
use crate::motion::Motion;
use crate::text::{clip, label, whole};

impl Reader<'_> {
    /// A name of the scope, as the deck keeps it.
    pub(super) fn scoped(&self, name: &str) -> String {
        match self.scope {
            Some(i) => format!("{}.{name}", self.deck.numbering.instances()[i]),
            None => self.outside(name),
        }
    }

    /// The same of a field.
    pub(super) fn name(&self, field: &str) -> String {
        self.scoped(&label(field))
    }

    /// A name outside of instances: that of the assembly in front says nothing, and that of an instance is written as the instance writes it.
    pub(super) fn outside(&self, name: &str) -> String {
        let assembly = self.structure.assembly.as_ref();
        let rest = name.split_once('.').filter(|(first, _)| {
            assembly.is_some_and(|a| a.name == *first || a.name == label(first))
        });
        let name = rest.map_or(name, |(_, rest)| rest);
        match self.deck.numbering.within(name) {
            Some((i, bare)) => format!("{}.{bare}", self.deck.numbering.instances()[i]),
            None => name.to_string(),
        }
    }

    /// The number of a node or an element as the deck keeps it: `12` of the scope, `PART-1-1.12` of an instance. It may be that of nothing.
    pub(super) fn number_of(&self, text: &str) -> Option<u64> {
        let numbering = &self.deck.numbering;
        if let Some(n) = whole(text) {
            return Some(numbering.of(self.scope, n));
        }
        if self.scope.is_some() || numbering.instances().is_empty() {
            return None;
        }
        let name = self.outside(&label(text));
        let (instance, own) = numbering.within(&name)?;
        Some(numbering.of(Some(instance), whole(own)?))
    }

    /// Where the scope is put.
    pub(super) fn motion(&self) -> Motion {
        let of = |i: usize| self.structure.motions.get(i).copied();
        self.scope.and_then(of).unwrap_or(Motion::NONE)
    }

    /// Makes the instance of the parameter `INSTANCE` the scope, if there is one. The scope before, or nothing if there is no such instance.
    pub(super) fn enter(&mut self, card: &Card) -> Option<Option<usize>> {
        let before = self.scope;
        let Some(instance) = card.get("INSTANCE") else {
            return Some(before);
        };
        if before.is_some() {
            let message = format!("{}, INSTANCE stands in a part or an instance", card.written);
            self.error(
                card.place,
                message,
                "leave INSTANCE out there: numbers are those of the part",
            );
            return None;
        }
        let written = self.outside(instance);
        let Some(found) = self.deck.numbering.find(&written) else {
            let message = format!("there is no instance {}", clip(instance));
            let help = nearest(instance, "instances", self.deck.numbering.instances());
            self.error(card.place, message, &help);
            return None;
        };
        self.scope = Some(found);
        Some(before)
    }

    /// A message without names of instances: what two instances of a part have in common.
    pub(super) fn without_instances(&self, message: &str) -> String {
        let names = self.deck.numbering.instances().iter();
        names.fold(message.to_string(), |text, i| {
            text.replace(&format!("{i}."), "")
        })
    }
}
