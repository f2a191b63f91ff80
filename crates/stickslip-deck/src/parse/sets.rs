//! Sets of nodes and of elements.

use std::collections::{BTreeMap, BTreeSet};

use super::fields::{Nodes, elements_named, elements_of, named_nodes, required_name, whole};
use super::messages::Messages;
use super::reader::{Reader, SetChecks};
use super::scope::Scope;
use crate::card::{Card, Data, Place};
use crate::text::{clip, label};

/// `start, end, step` as those of the numbers that exist.
fn generated<T>(
    messages: &mut Messages,
    scope: &Scope,
    data: &Data,
    known: &BTreeMap<u64, T>,
) -> Vec<u64> {
    let (Some(from), Some(to)) = (whole(messages, data, 0), whole(messages, data, 1)) else {
        return Vec::new();
    };
    let by = match data.fields.len() {
        0..=2 => 1,
        _ => whole(messages, data, 2).unwrap_or(1),
    };
    if to < from {
        let message = format!("the range runs from {from} down to {to}");
        messages.error(data.place, message, "write first, last, increment");
        return Vec::new();
    }
    let Some((from, to)) = scope.numbering.span(scope.instance, from, to) else {
        return Vec::new();
    };
    let all = known.range(from..=to).map(|(n, _)| *n);
    all.filter(|n| (n - from).is_multiple_of(by)).collect()
}

pub(super) fn node_set(reader: &mut Reader, card: &Card) {
    let Some(name) = required_name(reader, card, "NSET") else {
        return;
    };
    let Some(outer) = reader.scope.enter(&mut reader.messages, card) else {
        return;
    };
    let out = nodes_named(reader, card, &name);
    reader.scope.instance = outer;
    if card.has("UNSORTED") {
        reader.sets.unsorted.insert(name.clone());
    }
    let set = reader.deck.node_sets.entry(name.clone()).or_default();
    if let Some(n) = add(set, out) {
        reader.sets.doubled[0].entry(name).or_insert(n);
    }
}

/// The nodes that a `*NSET` lists.
fn nodes_named(reader: &mut Reader, card: &Card, name: &str) -> Vec<u64> {
    let mut out = Vec::new();
    if let Some(set) = card.get("ELSET").map(str::to_string) {
        // Elements share nodes, which is not meant to count.
        let mut of_cells = BTreeSet::new();
        let of = reader.scope.scoped(&set);
        for e in elements_named(reader, &set, &of, card.place) {
            of_cells.extend(reader.deck.elements[&e].nodes.iter().copied());
        }
        out.extend(of_cells);
    }
    for data in &card.data {
        if card.has("GENERATE") {
            out.extend(generated(
                &mut reader.messages,
                &reader.scope,
                data,
                &reader.deck.nodes,
            ));
            continue;
        }
        for field in data.fields.iter().filter(|f| !f.is_empty()) {
            match named_nodes(reader, field, reader.scope.name(field)) {
                Nodes::One(n) => out.push(n),
                Nodes::Absent(n) => {
                    let what = format!("node {}", reader.scope.label(n));
                    reader
                        .sets
                        .absent
                        .push((name.to_string(), what, data.place));
                }
                Nodes::Set(part) => {
                    out.extend(&reader.deck.node_sets[&part]);
                    inherit(&mut reader.sets, 0, &part, name);
                }
                Nodes::NoSet => reader.messages.error(
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
pub(super) fn inherit(sets: &mut SetChecks, kind: usize, part: &str, whole: &str) {
    if let Some(n) = sets.doubled[kind].get(part).copied() {
        sets.doubled[kind].entry(whole.to_string()).or_insert(n);
    }
}

/// It is an error to add up over a set of nodes (0) or elements (1) that names one of them twice: programs differ in how often it counts.
pub(super) fn once(reader: &mut Reader, kind: usize, set: &str, place: Place) {
    let Some(n) = reader.sets.doubled[kind].get(set) else {
        return;
    };
    let what = ["node", "element"][kind];
    let message = format!(
        "{what} {n} stands in the set {set} more than once: it counts as often in CalculiX, and once in Abaqus"
    );
    reader.messages.error(
        place,
        message,
        &format!("let the set name each {what} once"),
    );
}

/// Nodes of sets that are not there: CalculiX leaves them out, which changes nothing where the set is only printed.
pub(super) fn judge_absent(reader: &mut Reader) {
    let messages = &mut reader.messages;
    // What a part lacks its instances lack as well: it is said once.
    let mut said = BTreeSet::new();
    let absent: Vec<_> = reader.sets.absent.drain(..).collect();
    for (set, what, place) in absent {
        if !said.insert((place, reader.scope.without_instances(&what))) {
            continue;
        }
        // In the instance that has it, it is named without the instance.
        let bare = reader.scope.numbering.bare(&set).to_string();
        let is_set = |name: &str| name == set || name == bare || reader.scope.outside(name) == set;
        let (mut printed, mut used) = (false, false);
        for card in reader.source.cards.iter().filter(|c| c.keyword != "NSET") {
            let named = card
                .parameters
                .iter()
                .any(|p| p.value.as_deref().is_some_and(is_set));
            match card.keyword.as_str() {
                "NODEPRINT" | "NODEFILE" | "NODEOUTPUT" => printed |= named,
                _ => used |= named,
            }
        }
        let mut fields = reader
            .source
            .cards
            .iter()
            .flat_map(|c| &c.data)
            .flat_map(|d| &d.fields);
        used |= fields.any(|f| is_set(&label(f)));
        match printed && !used {
            false => messages.error(
                place,
                format!("there is no {what}"),
                "*NODE must stand before *NSET",
            ),
            true => messages.note(
                place,
                format!(
                    "there is no {what}: it is left out of the set {set}, which is only printed"
                ),
            ),
        }
    }
}

pub(super) fn element_set(reader: &mut Reader, card: &Card) {
    let Some(name) = required_name(reader, card, "ELSET") else {
        return;
    };
    let Some(outer) = reader.scope.enter(&mut reader.messages, card) else {
        return;
    };
    let mut out = Vec::new();
    for data in &card.data {
        if card.has("GENERATE") {
            out.extend(generated(
                &mut reader.messages,
                &reader.scope,
                data,
                &reader.deck.elements,
            ));
            continue;
        }
        for field in data.fields.iter().filter(|f| !f.is_empty()) {
            out.extend(elements_of(reader, field, data.place));
            inherit(&mut reader.sets, 1, &reader.scope.name(field), &name);
        }
    }
    reader.scope.instance = outer;
    let set = reader.deck.element_sets.entry(name.clone()).or_default();
    if let Some(n) = add(set, out) {
        reader.sets.doubled[1].entry(name).or_insert(n);
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
