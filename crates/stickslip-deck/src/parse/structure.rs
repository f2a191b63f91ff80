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
    pub name: String,
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
    /// Where instances are put, by index.
    pub motions: Vec<Motion>,
    /// Lines that have been read for instances.
    pub lines: usize,
    /// A part is read for another instance: what is to be said of its cards has been said.
    pub again: bool,
    /// The card above stands where it must not, and what belongs to it with it.
    pub misplaced: bool,
    /// An instance lacks its mesh: what refers to it means nothing.
    pub incomplete: bool,
}

/// Where in a deck a card can stand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Level {
    Model,
    Part,
    Assembly,
    Instance,
}

/// Cards that make the structure.
pub(super) const STRUCTURE: [&str; 6] = [
    "PART",
    "ENDPART",
    "ASSEMBLY",
    "ENDASSEMBLY",
    "INSTANCE",
    "ENDINSTANCE",
];

/// Cards of a part or of an instance.
const MESH: [&str; 30] = [
    "NODE",
    "ELEMENT",
    "NGEN",
    "NFILL",
    "NCOPY",
    "ELGEN",
    "ELCOPY",
    "NSET",
    "ELSET",
    "SURFACE",
    "SYSTEM",
    "TRANSFORM",
    "NORMAL",
    "ORIENTATION",
    "DISTRIBUTION",
    "DISTRIBUTIONTABLE",
    "SOLIDSECTION",
    "EQUATION",
    "RIGIDBODY",
    "PRE-TENSIONSECTION",
    "COUPLING",
    "KINEMATIC",
    "DISTRIBUTING",
    "KINEMATICCOUPLING",
    "DISTRIBUTINGCOUPLING",
    "MPC",
    "SPRING",
    "DASHPOT",
    "GAP",
    "MASS",
];

impl Structure {
    /// Where the next card stands.
    pub fn level(&self) -> Level {
        let open = self.assembly.as_ref().is_some_and(|a| a.open);
        match (&self.part, &self.instance) {
            (Some(_), _) => Level::Part,
            (None, Some(_)) => Level::Instance,
            (None, None) if open => Level::Assembly,
            (None, None) => Level::Model,
        }
    }
}

impl Level {
    /// Whether a card may stand here.
    pub fn allows(self, keyword: &str) -> bool {
        let mesh = || MESH.contains(&keyword);
        match self {
            _ if STRUCTURE.contains(&keyword) => true,
            Level::Model => true,
            Level::Part | Level::Instance => mesh(),
            Level::Assembly => mesh() || keyword == "TIE",
        }
    }
}
