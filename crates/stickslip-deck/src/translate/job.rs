//! A translation under way: what has been written and said.

use std::collections::BTreeSet;

use super::part::Part;
use super::spans::duration;
use super::toml::{self, Writer};
use crate::card::Place;
use crate::deck::{Deck, Target};
use crate::finding::{DeckError, Finding, Severity};

/// A translation under way.
pub(super) struct Job<'a> {
    pub(super) deck: &'a Deck,
    pub(super) out: Writer,
    pub(super) errors: Vec<Finding>,
    pub(super) notes: Vec<Finding>,
    pub(super) places: Vec<(String, Place)>,
    /// The tables there are, for their names.
    pub(super) tables: BTreeSet<String>,
    pub(super) pairs: Vec<(String, String, String)>,
    /// Names of tables that act in some steps only: kind (`supports`, `loads`, ...), name, by step.
    pub(super) active: Vec<(&'static str, String, Vec<bool>)>,
    /// Changes of laws: step, interface, key and value.
    pub(super) changes: Vec<(usize, String, String)>,
    /// Sliding that lasts: step and line.
    pub(super) sliding: Vec<(usize, String)>,
    /// What steps do with pretensions: step and line.
    pub(super) tensions: Vec<(usize, String)>,
    /// Which loads are written.
    pub(super) part: Part,
    /// Loads that shake: name, part, by step.
    pub(super) shaking: Vec<(String, Part, Vec<bool>)>,
    /// Starts and lengths of the steps.
    pub(super) spans: Vec<[f64; 2]>,
    /// Whether the deck asks for large strains (`NLGEOM`), and bodies do not turn: how large they become has to be judged.
    pub(super) strains: bool,
}

impl<'a> Job<'a> {
    pub(super) fn new(deck: &'a Deck) -> Self {
        let mut start = 0.0;
        let spans = deck.steps.iter().map(|s| {
            let length = duration(s);
            start += length;
            [start - length, length]
        });
        Job {
            deck,
            out: Writer::default(),
            errors: Vec::new(),
            notes: Vec::new(),
            places: Vec::new(),
            tables: BTreeSet::new(),
            pairs: Vec::new(),
            active: Vec::new(),
            changes: Vec::new(),
            sliding: Vec::new(),
            tensions: Vec::new(),
            part: Part::Lasting,
            shaking: Vec::new(),
            spans: spans.collect(),
            strains: false,
        }
    }

    pub(super) fn failed(mut self) -> DeckError {
        let files = &self.deck.output.files;
        self.errors
            .sort_by_key(|f| (files.iter().position(|p| *p == f.file), f.line));
        DeckError {
            findings: self.errors,
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
                .deck
                .output
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
        let finding = self.finding(Severity::Error, place, message.into(), help);
        // A line may say something of many nodes; that it is wrong is said once.
        let same = |f: &Finding| {
            f.line == finding.line && f.message == finding.message && f.file == finding.file
        };
        if !self.errors.iter().any(same) {
            self.errors.push(finding);
        }
    }

    pub(super) fn note(&mut self, place: Place, message: impl Into<String>) {
        let finding = self.finding(Severity::Note, place, message.into(), "");
        self.notes.push(finding);
    }

    pub(super) fn warn(&mut self, place: Place, message: impl Into<String>, help: &str) {
        let finding = self.finding(Severity::Warning, place, message.into(), help);
        self.notes.push(finding);
    }

    /// Opens a table of the problem that comes from a place of the deck.
    pub(super) fn table(&mut self, kind: &str, name: &str, place: Place) {
        let header = format!("{kind}.{}", toml::key(name));
        self.out.line("");
        self.out.line(&format!("[{header}]"));
        self.tables.insert(format!("{kind}.{name}"));
        self.places.push((format!("{kind}.{name}"), place));
    }

    /// The nodes of a card.
    pub(super) fn nodes(&self, target: &Target) -> Vec<u64> {
        match target {
            Target::One(n) => vec![*n],
            Target::Set(name) => self.deck.node_sets.get(name).cloned().unwrap_or_default(),
        }
    }

    /// A name that no other table of the kind has yet.
    pub(super) fn fresh(&self, kind: &str, wanted: &str) -> String {
        let taken = |name: &str| self.tables.contains(&format!("{kind}.{name}"));
        if !taken(wanted) {
            return wanted.to_string();
        }
        let more = (2..).map(|i| format!("{wanted}-{i}"));
        more.into_iter().find(|n| !taken(n)).unwrap_or_default()
    }
}
