//! Whose names and numbers are meant: those of an instance, or of what stands outside of all.

use super::known::nearest;
use super::messages::Messages;
use crate::card::Card;
use crate::motion::Motion;
use crate::numbering::Numbering;
use crate::text::{clip, label, whole};

/// Instances, and the one that numbers and names are those of.
#[derive(Debug, Default)]
pub(super) struct Scope {
    pub(super) numbering: Numbering,
    /// Where instances are put, by index.
    pub(super) motions: Vec<Motion>,
    /// The name of the assembly.
    pub(super) assembly: Option<String>,
    /// The instance whose numbers and names are meant; `None` outside of all.
    pub(super) instance: Option<usize>,
}

impl Scope {
    /// A name of the scope, as the deck keeps it.
    pub(super) fn scoped(&self, name: &str) -> String {
        match self.instance {
            Some(i) => format!("{}.{name}", self.numbering.instances()[i]),
            None => self.outside(name),
        }
    }

    /// The same of a field.
    pub(super) fn name(&self, field: &str) -> String {
        self.scoped(&label(field))
    }

    /// A name outside of instances: that of the assembly in front says nothing, and that of an instance is written as the instance writes it.
    pub(super) fn outside(&self, name: &str) -> String {
        let rest = name.split_once('.').filter(|(first, _)| {
            let own = self.assembly.as_deref();
            own.is_some_and(|own| own == *first || own == label(first))
        });
        let name = rest.map_or(name, |(_, rest)| rest);
        match self.numbering.within(name) {
            Some((i, bare)) => format!("{}.{bare}", self.numbering.instances()[i]),
            None => name.to_string(),
        }
    }

    /// The number of a node or an element of the scope as the deck keeps it.
    pub(super) fn of(&self, n: u64) -> u64 {
        self.numbering.of(self.instance, n)
    }

    /// The same from a text: `12` of the scope, `PART-1-1.12` of an instance. It may be that of nothing.
    pub(super) fn number_of(&self, text: &str) -> Option<u64> {
        if let Some(n) = whole(text) {
            return Some(self.of(n));
        }
        if self.instance.is_some() || self.numbering.instances().is_empty() {
            return None;
        }
        let name = self.outside(&label(text));
        let (instance, own) = self.numbering.within(&name)?;
        Some(self.numbering.of(Some(instance), whole(own)?))
    }

    /// A number that the deck keeps as the deck writes it.
    pub(super) fn label(&self, number: u64) -> String {
        self.numbering.label(number)
    }

    /// Where the scope is put.
    pub(super) fn motion(&self) -> Motion {
        let of = |i: usize| self.motions.get(i).copied();
        self.instance.and_then(of).unwrap_or(Motion::NONE)
    }

    /// Makes the instance of the parameter `INSTANCE` the scope, if there is one. The scope before, or nothing if there is no such instance.
    pub(super) fn enter(&mut self, messages: &mut Messages, card: &Card) -> Option<Option<usize>> {
        let before = self.instance;
        let Some(instance) = card.get("INSTANCE") else {
            return Some(before);
        };
        if before.is_some() {
            let message = format!("{}, INSTANCE stands in a part or an instance", card.written);
            let help = "leave INSTANCE out there: numbers are those of the part";
            messages.error(card.place, message, help);
            return None;
        }
        let Some(found) = self.numbering.find(&self.outside(instance)) else {
            let message = format!("there is no instance {}", clip(instance));
            let help = nearest(instance, "instances", self.numbering.instances());
            messages.error(card.place, message, &help);
            return None;
        };
        self.instance = Some(found);
        Some(before)
    }

    /// A message without names of instances: what two instances of a part have in common.
    pub(super) fn without_instances(&self, message: &str) -> String {
        let names = self.numbering.instances().iter();
        names.fold(message.to_string(), |text, i| {
            text.replace(&format!("{i}."), "")
        })
    }
}
