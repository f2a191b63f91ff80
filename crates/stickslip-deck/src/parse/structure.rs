//! Parts, assembly and instances: what of them the reader keeps while it reads.

use std::collections::BTreeMap;

use crate::card::Place;
use crate::motion::Motion;

/// A part: its cards are read anew for every instance.
#[derive(Debug, Default)]
pub(super) struct Part {
    /// Its cards in the source.
    pub cards: Vec<usize>,
    /// Where.
    pub place: Place,
    /// How many instances it has so far.
    pub instances: usize,
}

/// The instance that is open.
#[derive(Debug)]
pub(super) struct OpenInstance {
    pub place: Place,
    /// The `*SYSTEM` of the assembly, which comes back behind it.
    pub system: Motion,
}

/// `*ASSEMBLY`.
#[derive(Debug)]
pub(super) struct Assembly {
    pub open: bool,
    pub place: Place,
}

/// Parts, assembly and instances.
#[derive(Debug, Default)]
pub(super) struct Structure {
    /// The card that is read, by its index in the source.
    pub at: usize,
    pub parts: BTreeMap<String, Part>,
    /// The part that is open, by its name.
    pub part: Option<(String, Part)>,
    pub assembly: Option<Assembly>,
    pub instance: Option<OpenInstance>,
    /// The part whose cards are to be read for the instance.
    pub due: Option<String>,
    /// Lines that have been read for instances.
    pub lines: usize,
    /// The card above stands where it must not, and what belongs to it with it.
    pub misplaced: bool,
    /// An instance lacks its mesh: what refers to it means nothing.
    pub incomplete: bool,
}

/// Where a card may stand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Level {
    /// Outside of parts and of the assembly.
    Model,
    /// In the assembly, too, but in no part or instance.
    Assembly,
    /// In parts, instances and the assembly, too.
    Mesh,
    /// It makes this structure itself: parts, assembly and instances.
    Structure,
}

/// Where in a deck a card stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Inside {
    Model,
    Part,
    Assembly,
    Instance,
}

impl Structure {
    /// Where the next card stands.
    pub fn inside(&self) -> Inside {
        let open = self.assembly.as_ref().is_some_and(|a| a.open);
        match (&self.part, &self.instance) {
            (Some(_), _) => Inside::Part,
            (None, Some(_)) => Inside::Instance,
            (None, None) if open => Inside::Assembly,
            (None, None) => Inside::Model,
        }
    }
}

impl Inside {
    /// Whether a card of a level may stand here.
    pub fn allows(self, level: Level) -> bool {
        match level {
            Level::Structure | Level::Mesh => true,
            Level::Model => self == Inside::Model,
            Level::Assembly => matches!(self, Inside::Model | Inside::Assembly),
        }
    }
}
