//! What is said of a deck while it is read. What it needs and is not computed is one finding a kind, with how much there is of it, in place of all that
//! follows from it.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

use super::uncomputed::{Beyond, kind_of_elements};
use crate::card::{Card, Place};
use crate::finding::{Finding, Severity};

/// After so many errors no more are looked for: something else is wrong than single lines.
const MOST_ERRORS: usize = 50;

/// What has been said of a deck.
#[derive(Debug, Default)]
pub(super) struct Messages<'a> {
    /// The files of the deck, which places count.
    files: &'a [PathBuf],
    errors: Vec<Finding>,
    /// Warnings and notes.
    pub(super) notes: Vec<Finding>,
    /// What is not computed, by kind.
    beyond: Vec<Beyond>,
    /// Keywords as they were first written.
    written: BTreeMap<String, String>,
    /// Lines that are wrong whatever else there is: misspelt keywords and parameters.
    formal: BTreeSet<Place>,
    /// Parameters that a note has been made of.
    noted: BTreeSet<(&'static str, String)>,
    /// A line of a *NODE could not be read.
    pub(super) unread: bool,
    /// The deck goes on from what is not there: the rest means nothing.
    pub(super) stopped: bool,
    /// A part is read for another instance: what is to be said of its cards has been said.
    pub(super) again: bool,
}

impl<'a> Messages<'a> {
    pub(super) fn new(files: &'a [PathBuf]) -> Self {
        Messages {
            files,
            ..Messages::default()
        }
    }

    fn finding(&self, severity: Severity, place: Place, message: String, help: &str) -> Finding {
        Finding {
            severity,
            file: self.files.get(place.file).cloned().unwrap_or_default(),
            line: place.line,
            message,
            help: (!help.is_empty()).then(|| help.to_string()),
        }
    }

    pub(super) fn error(&mut self, place: Place, message: impl Into<String>, help: &str) {
        if self.errors.len() < MOST_ERRORS {
            let finding = self.finding(Severity::Error, place, message.into(), help);
            if !self.said(&finding, &self.errors) {
                self.errors.push(finding);
            }
        }
    }

    pub(super) fn warn(&mut self, place: Place, message: impl Into<String>, help: &str) {
        let finding = self.finding(Severity::Warning, place, message.into(), help);
        if !self.said(&finding, &self.notes) {
            self.notes.push(finding);
        }
    }

    pub(super) fn note(&mut self, place: Place, message: impl Into<String>) {
        let finding = self.finding(Severity::Note, place, message.into(), "");
        if !self.said(&finding, &self.notes) {
            self.notes.push(finding);
        }
    }

    /// A note of a parameter of cards, of the first of them that has it.
    pub(super) fn note_parameter(
        &mut self,
        card: &Card,
        keyword: &'static str,
        name: &str,
        why: &str,
    ) {
        if self.noted.insert((keyword, name.to_string())) {
            let message = format!("{}: {name} is left out: {why}", card.written);
            self.note(card.place, message);
        }
    }

    /// The line at a place is wrong whatever else there is.
    pub(super) fn misspelt(&mut self, place: Place) {
        self.formal.insert(place);
    }

    /// Ends the reading at a card without which the rest means nothing: what is wrong with it is all there is to say.
    pub(super) fn stop(&mut self, place: Place) {
        self.stopped = true;
        self.beyond.clear();
        self.errors.retain(|f| f.line == place.line);
    }

    /// Puts errors in the order of the deck.
    pub(super) fn sort_errors(&mut self) {
        let files = self.files;
        let file = |f: &Finding| files.iter().position(|p| *p == f.file);
        self.errors.sort_by_key(|f| file(f).map(|p| (p, f.line)));
    }

    /// Whether something has been said of a line of a part for an instance before.
    fn said(&self, finding: &Finding, before: &[Finding]) -> bool {
        let here = |f: &Finding| f.line == finding.line && f.file == finding.file;
        self.again && before.iter().any(here)
    }

    /// How many errors there are so far.
    pub(super) fn count(&self) -> usize {
        self.errors.len()
    }

    /// Whether nothing has been said against the deck so far.
    pub(super) fn sound(&self) -> bool {
        self.errors.is_empty() && self.beyond.is_empty()
    }

    /// A card of a kind that is not computed.
    pub(super) fn card_beyond(
        &mut self,
        card: &Card,
        kind: Option<&'static str>,
        help: &'static str,
    ) {
        // The table has each keyword once, however it is written.
        let first = self.written.entry(card.keyword.clone());
        let what = first.or_insert_with(|| card.written.clone()).clone();
        self.count_beyond(kind, what, 1, card.place, help);
    }

    /// Elements of a type that is not computed.
    pub(super) fn elements_beyond(
        &mut self,
        kind: &str,
        count: usize,
        what: &'static str,
        help: &'static str,
        place: Place,
    ) {
        let group = kind_of_elements(what);
        let text = match group {
            Some(_) => format!("elements of type {kind}"),
            None => format!("elements of type {kind} ({what})"),
        };
        self.count_beyond(group, text, count, place, help);
    }

    /// Whether there are things of the kind that elements of a type are.
    pub(super) fn has_beyond(&self, what: &'static str) -> bool {
        let kind = kind_of_elements(what);
        kind.is_some() && self.beyond.iter().any(|b| b.kind == kind)
    }

    fn count_beyond(
        &mut self,
        kind: Option<&'static str>,
        what: String,
        n: usize,
        place: Place,
        help: &'static str,
    ) {
        if self.again {
            return;
        }
        let same = |b: &&mut Beyond| match kind {
            Some(_) => b.kind == kind,
            None => b.kind.is_none() && b.counts.iter().any(|c| c.0 == what),
        };
        let Some(known) = self.beyond.iter_mut().find(same) else {
            self.beyond.push(Beyond {
                kind,
                counts: vec![(what, n)],
                place,
                help,
            });
            return;
        };
        if (place.file, place.line) < (known.place.file, known.place.line) {
            known.place = place;
        }
        match known.counts.iter_mut().find(|c| c.0 == what) {
            Some(count) => count.1 += n,
            None => known.counts.push((what, n)),
        }
    }

    /// All that is wrong: what is not computed, if there is such, with what is misspelt whatever else there is; otherwise every error.
    pub(super) fn verdict(mut self) -> Vec<Finding> {
        self.sort_errors();
        if self.beyond.is_empty() {
            return self.errors;
        }
        let mut findings: Vec<Finding> = Vec::new();
        self.beyond.sort_by_key(|b| (b.place.file, b.place.line));
        for b in &self.beyond {
            findings.push(self.finding(Severity::Error, b.place, b.message(), b.help));
        }
        let misspelt: BTreeSet<_> = self.formal.iter().map(|p| (p.file, p.line)).collect();
        let files = self.files;
        let own = |f: &Finding| {
            let file = files.iter().position(|p| *p == f.file).unwrap_or_default();
            misspelt.contains(&(file, f.line))
        };
        let (kept, left): (Vec<Finding>, Vec<Finding>) = self.errors.drain(..).partition(own);
        findings.extend(kept);
        if !left.is_empty() {
            let message = format!(
                "what else there is to say ({}) is left until then: most of it follows from what is not computed",
                left.len()
            );
            findings.push(self.finding(Severity::Note, Place::default(), message, ""));
        }
        findings
    }
}
