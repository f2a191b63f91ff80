//! Sets of nodes and of elements.

use std::collections::{BTreeMap, BTreeSet};

use super::fields::Nodes;
use super::reader::Reader;
use crate::card::{Card, Data, Place};
use crate::text::{clip, label};

impl Reader<'_> {
    /// `start, end, step` as those of the numbers that exist.
    pub(super) fn generated<T>(
        &mut self,
        data: &Data,
        known: impl Fn(&Self) -> &BTreeMap<u64, T>,
    ) -> Vec<u64> {
        let (Some(from), Some(to)) = (self.whole(data, 0), self.whole(data, 1)) else {
            return Vec::new();
        };
        let by = match data.fields.len() {
            0..=2 => 1,
            _ => self.whole(data, 2).unwrap_or(1),
        };
        if to < from {
            self.error(
                data.place,
                format!("the range runs from {from} down to {to}"),
                "write first, last, increment",
            );
            return Vec::new();
        }
        let Some((from, to)) = self.deck.numbering.span(self.scope, from, to) else {
            return Vec::new();
        };
        let all = known(self).range(from..=to).map(|(n, _)| *n);
        all.filter(|n| (n - from).is_multiple_of(by)).collect()
    }

    pub(super) fn node_set(&mut self, card: &Card) {
        let Some(name) = self.required_name(card, "NSET") else {
            return;
        };
        let Some(outer) = self.enter(card) else {
            return;
        };
        let out = self.nodes_named(card, &name);
        self.scope = outer;
        if card.has("UNSORTED") {
            self.sets.unsorted.insert(name.clone());
        }
        let set = self.deck.node_sets.entry(name.clone()).or_default();
        if let Some(n) = add(set, out) {
            self.sets.doubled[0].entry(name).or_insert(n);
        }
    }

    /// The nodes that a `*NSET` lists.
    fn nodes_named(&mut self, card: &Card, name: &str) -> Vec<u64> {
        let mut out = Vec::new();
        if let Some(set) = card.get("ELSET").map(str::to_string) {
            // Elements share nodes, which is not meant to count.
            let mut of_cells = BTreeSet::new();
            let of = self.scoped(&set);
            for e in self.elements_named(&set, &of, card.place) {
                of_cells.extend(self.deck.elements[&e].nodes.iter().copied());
            }
            out.extend(of_cells);
        }
        for data in &card.data {
            if card.has("GENERATE") {
                out.extend(self.generated(data, |r| &r.deck.nodes));
                continue;
            }
            for field in data.fields.iter().filter(|f| !f.is_empty()) {
                match self.named_nodes(field, self.name(field)) {
                    Nodes::One(n) => out.push(n),
                    Nodes::Absent(n) => {
                        let what = format!("node {}", self.deck.label(n));
                        self.sets.absent.push((name.to_string(), what, data.place));
                    }
                    Nodes::Set(part) => {
                        out.extend(&self.deck.node_sets[&part]);
                        self.inherit(0, &part, name);
                    }
                    Nodes::NoSet => self.error(
                        data.place,
                        format!("there is no set of nodes {}", clip(field)),
                        "a set must stand before those it is part of",
                    ),
                }
            }
        }
        out
    }

    /// A set of nodes (0) or elements (1) that is part of another makes it name twice what it names twice.
    pub(super) fn inherit(&mut self, kind: usize, part: &str, whole: &str) {
        if let Some(n) = self.sets.doubled[kind].get(part).copied() {
            self.sets.doubled[kind]
                .entry(whole.to_string())
                .or_insert(n);
        }
    }

    /// It is an error to add up over a set of nodes (0) or elements (1) that names one of them twice: programs differ in how often it counts.
    pub(super) fn once(&mut self, kind: usize, set: &str, place: Place) {
        let Some(n) = self.sets.doubled[kind].get(set) else {
            return;
        };
        let what = ["node", "element"][kind];
        let message = format!(
            "{what} {n} stands in the set {set} more than once: it counts as often in CalculiX, and once in Abaqus"
        );
        self.error(
            place,
            message,
            &format!("let the set name each {what} once"),
        );
    }

    /// Nodes of sets that are not there: CalculiX leaves them out, which changes nothing where the set is only printed.
    pub(super) fn judge_absent(&mut self) {
        // What a part lacks its instances lack as well: it is said once.
        let mut said = BTreeSet::new();
        let absent: Vec<_> = self.sets.absent.drain(..).collect();
        for (set, what, place) in absent {
            if !said.insert((place, self.without_instances(&what))) {
                continue;
            }
            // In the instance that has it, it is named without the instance.
            let bare = self.deck.numbering.bare(&set).to_string();
            let is_set = |name: &str| name == set || name == bare || self.outside(name) == set;
            let (mut printed, mut used) = (false, false);
            for card in self.source.cards.iter().filter(|c| c.keyword != "NSET") {
                let named = card
                    .parameters
                    .iter()
                    .any(|p| p.value.as_deref().is_some_and(is_set));
                match card.keyword.as_str() {
                    "NODEPRINT" | "NODEFILE" | "NODEOUTPUT" => printed |= named,
                    _ => used |= named,
                }
            }
            let mut fields = self
                .source
                .cards
                .iter()
                .flat_map(|c| &c.data)
                .flat_map(|d| &d.fields);
            used |= fields.any(|f| is_set(&label(f)));
            match printed && !used {
                false => self.error(
                    place,
                    format!("there is no {what}"),
                    "*NODE must stand before *NSET",
                ),
                true => self.note(
                    place,
                    format!(
                        "there is no {what}: it is left out of the set {set}, which is only printed"
                    ),
                ),
            }
        }
    }

    pub(super) fn element_set(&mut self, card: &Card) {
        let Some(name) = self.required_name(card, "ELSET") else {
            return;
        };
        let Some(outer) = self.enter(card) else {
            return;
        };
        let mut out = Vec::new();
        for data in &card.data {
            if card.has("GENERATE") {
                out.extend(self.generated(data, |r| &r.deck.elements));
                continue;
            }
            for field in data.fields.iter().filter(|f| !f.is_empty()) {
                out.extend(self.elements_of(field, data.place));
                self.inherit(1, &self.name(field), &name);
            }
        }
        self.scope = outer;
        let set = self.deck.element_sets.entry(name.clone()).or_default();
        if let Some(n) = add(set, out) {
            self.sets.doubled[1].entry(name).or_insert(n);
        }
    }
}

/// Adds to a set what it does not have yet, in order. The first that it has already.
pub(super) fn add(set: &mut Vec<u64>, more: Vec<u64>) -> Option<u64> {
    let mut seen: BTreeSet<u64> = set.iter().copied().collect();
    let mut again = None;
    for n in more {
        match seen.insert(n) {
            true => set.push(n),
            false => again = again.or(Some(n)),
        }
    }
    again
}
