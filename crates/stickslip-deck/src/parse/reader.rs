//! What cards are read into: the deck, what has been said of it, and where the reader stands.

use std::collections::{BTreeMap, BTreeSet};

use super::structure::Structure;
use super::uncomputed::Beyond;
use crate::card::Place;
use crate::deck::{Action, Deck};
use crate::finding::{Finding, Severity};
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

/// Reads cards one after the other.
pub(super) struct Reader<'a> {
    pub(super) source: &'a Source,
    pub(super) deck: Deck,
    /// What has been said of the deck.
    pub(super) messages: Messages,
    /// Where among the cards of a step the reader stands.
    pub(super) position: StepCards,
    /// What is to be checked of elements and sets when all are read.
    pub(super) sets: SetChecks,
    /// Parts, and where in the assembly the reader stands.
    pub(super) structure: Structure,
    /// The instance that numbers and names are those of.
    pub(super) scope: Option<usize>,
    /// The `*SYSTEM` of the nodes that follow.
    pub(super) system: Motion,
}

/// What has been said of a deck while it is read.
#[derive(Debug, Default)]
pub(super) struct Messages {
    pub(super) errors: Vec<Finding>,
    /// What is not computed, by kind.
    pub(super) beyond: Vec<Beyond>,
    /// Keywords as they were first written.
    pub(super) written: BTreeMap<String, String>,
    /// Lines that are wrong whatever else there is: misspelt keywords and parameters.
    pub(super) formal: BTreeSet<Place>,
    /// Parameters that a note has been made of.
    pub(super) noted: BTreeSet<(&'static str, String)>,
    /// A line of a *NODE could not be read.
    pub(super) unread: bool,
    /// The deck goes on from what is not there: the rest means nothing.
    pub(super) stopped: bool,
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

/// After so many errors no more are looked for: something else is wrong than single lines.
const ENOUGH: usize = 50;

impl<'a> Reader<'a> {
    pub(super) fn new(source: &'a Source) -> Self {
        let mut deck = Deck::default();
        deck.output.files.clone_from(&source.files);
        Reader {
            source,
            deck,
            messages: Messages::default(),
            position: StepCards::default(),
            sets: SetChecks::default(),
            structure: Structure::default(),
            scope: None,
            system: Motion::NONE,
        }
    }

    pub(super) fn finding(
        &self,
        severity: Severity,
        place: Place,
        message: String,
        help: &str,
    ) -> Finding {
        Finding {
            severity,
            file: self
                .source
                .files
                .get(place.file)
                .cloned()
                .unwrap_or_default(),
            line: place.line,
            message,
            help: (!help.is_empty()).then(|| help.to_string()),
        }
    }

    pub(super) fn error(&mut self, place: Place, message: impl Into<String>, help: &str) {
        if self.messages.errors.len() < ENOUGH {
            let finding = self.finding(Severity::Error, place, message.into(), help);
            if self.said(&finding, &self.messages.errors) {
                return;
            }
            self.messages.errors.push(finding);
        }
    }

    pub(super) fn warn(&mut self, place: Place, message: impl Into<String>, help: &str) {
        let finding = self.finding(Severity::Warning, place, message.into(), help);
        if !self.said(&finding, &self.deck.notes) {
            self.deck.notes.push(finding);
        }
    }

    pub(super) fn note(&mut self, place: Place, message: impl Into<String>) {
        let finding = self.finding(Severity::Note, place, message.into(), "");
        if !self.said(&finding, &self.deck.notes) {
            self.deck.notes.push(finding);
        }
    }

    /// Puts errors in the order of the deck.
    pub(super) fn sort_errors(&mut self) {
        self.messages.errors.sort_by_key(|f| {
            self.source
                .files
                .iter()
                .position(|p| *p == f.file)
                .map(|p| (p, f.line))
        });
    }

    /// Whether something has been said of a line of a part for an instance before.
    fn said(&self, finding: &Finding, before: &[Finding]) -> bool {
        let here = |f: &Finding| f.line == finding.line && f.file == finding.file;
        self.structure.again && before.iter().any(here)
    }
}
