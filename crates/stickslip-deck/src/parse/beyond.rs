//! What a deck needs and is not computed: one finding a kind, with how much there is of it, in place of all that follows from it.

use std::collections::BTreeSet;

use super::reader::Reader;
use super::table;
use super::uncomputed::{Beyond, kind_of_elements};
use crate::card::{Card, Place};
use crate::finding::{Finding, Severity};

impl Reader<'_> {
    /// Whether nothing has been said against the deck so far.
    pub(super) fn sound(&self) -> bool {
        self.messages.errors.is_empty() && self.messages.beyond.is_empty()
    }

    /// A card of a kind that is not computed.
    pub(super) fn card_beyond(&mut self, card: &Card, help: &'static str) {
        let kind = table::kind_of_card(&card.keyword, help);
        // The table has each keyword once, however it is written.
        let what = match self.messages.written.get(&card.keyword) {
            Some(first) => first.clone(),
            None => card.written.clone(),
        };
        self.messages
            .written
            .insert(card.keyword.clone(), what.clone());
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
        kind.is_some() && self.messages.beyond.iter().any(|b| b.kind == kind)
    }

    fn count_beyond(
        &mut self,
        kind: Option<&'static str>,
        what: String,
        n: usize,
        place: Place,
        help: &'static str,
    ) {
        if self.structure.again {
            return;
        }
        let same = |b: &&mut Beyond| match kind {
            Some(_) => b.kind == kind,
            None => b.kind.is_none() && b.counts.iter().any(|c| c.0 == what),
        };
        let Some(known) = self.messages.beyond.iter_mut().find(same) else {
            self.messages.beyond.push(Beyond {
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
        if self.messages.beyond.is_empty() {
            return self.messages.errors;
        }
        let mut findings: Vec<Finding> = Vec::new();
        self.messages
            .beyond
            .sort_by_key(|b| (b.place.file, b.place.line));
        for b in &self.messages.beyond {
            findings.push(self.finding(Severity::Error, b.place, b.message(), b.help));
        }
        let misspelt: BTreeSet<_> = self
            .messages
            .formal
            .iter()
            .map(|p| (p.file, p.line))
            .collect();
        let files = &self.source.files;
        let own = |f: &Finding| {
            let file = files.iter().position(|p| *p == f.file).unwrap_or_default();
            misspelt.contains(&(file, f.line))
        };
        let (kept, left): (Vec<Finding>, Vec<Finding>) =
            self.messages.errors.drain(..).partition(own);
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
