//! What cards are read into: the deck, what has been said of it, and where the reader stands.

use std::collections::{BTreeMap, BTreeSet};

use super::messages::Messages;
use super::scope::Scope;
use super::structure::Structure;
use crate::card::Place;
use crate::deck::{Action, Deck};
use crate::motion::Motion;
use crate::source::Source;

/// What of a material or interaction the next cards are about.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) enum Context {
    #[default]
    None,
    Material(String),
    Interaction(String),
    /// After `*CHANGE FRICTION`.
    ChangeFriction(String),
    /// After `*CHANGE SURFACE BEHAVIOR`.
    ChangeBehavior(String),
}

/// What cards are read into, one after the other.
pub(super) struct Reader<'a> {
    pub(super) source: &'a Source,
    pub(super) deck: Deck,
    pub(super) messages: Messages<'a>,
    /// Where among the cards of a step the reader stands.
    pub(super) position: StepCards,
    /// What is to be checked of elements and sets when all are read.
    pub(super) sets: SetChecks,
    /// Parts, and where in the assembly the reader stands.
    pub(super) structure: Structure,
    pub(super) scope: Scope,
    /// The `*SYSTEM` of the nodes that follow.
    pub(super) system: Motion,
}

/// Where among the cards of a step the reader stands.
#[derive(Debug, Default)]
pub(super) struct StepCards {
    pub(super) context: Context,
    pub(super) in_step: bool,
    /// Whether the step has its procedure.
    pub(super) procedure: bool,
    /// What cards with `OP` have been met in the step, each by what clears it.
    pub(super) touched: Vec<Action>,
    /// Kinds of output that the step has asked for.
    pub(super) asked: BTreeSet<String>,
    /// The last `*OUTPUT`, under which cards of Abaqus stand, is `HISTORY`; `None` before there was one.
    pub(super) history: Option<bool>,
}

/// What is to be checked of elements and sets when all are read.
#[derive(Debug, Default)]
pub(super) struct SetChecks {
    /// Sets of nodes and of elements that name one twice, with its number.
    pub(super) doubled: [BTreeMap<String, u64>; 2],
    /// Elements with a node that is not there yet, and where.
    pub(super) waiting: Vec<(u64, Place)>,
    /// Sets of nodes that keep the order of the deck where order counts.
    pub(super) unsorted: BTreeSet<String>,
    /// Elements whose faces have other numbers than those they were made of.
    pub(super) reflected: BTreeSet<u64>,
    /// Elements of types that are not supported, and sets of them: one error is enough.
    pub(super) skipped: BTreeSet<u64>,
    pub(super) skipped_sets: BTreeSet<String>,
    /// Types of elements that may bound others, where they were met first.
    pub(super) bounding: Vec<(String, Place)>,
    /// Nodes and elements that sets name and that are not there: set, what, where.
    pub(super) absent: Vec<(String, String, Place)>,
}

impl<'a> Reader<'a> {
    pub(super) fn new(source: &'a Source) -> Self {
        let mut deck = Deck::default();
        deck.output.files.clone_from(&source.files);
        Reader {
            source,
            deck,
            messages: Messages::new(&source.files),
            position: StepCards::default(),
            sets: SetChecks::default(),
            structure: Structure::default(),
            scope: Scope::default(),
            system: Motion::NONE,
        }
    }
}
