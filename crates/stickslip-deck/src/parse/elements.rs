//! Elements: cells, springs, masses, and lines and faces that bound cells.

use std::collections::BTreeSet;
use std::ops::Range;

use stickslip::io::abaqus;

use super::fields::{number_at, own_number, required};
use super::reader::Reader;
use super::sets::add;
use crate::card::{Card, Data, Place};
use crate::deck::Element;
use crate::text;

/// Numbers of nodes that elements have.
const NODE_COUNTS: [usize; 10] = [1, 2, 3, 4, 5, 6, 8, 10, 15, 20];

/// Nodes of element types that are not cells.
fn other_nodes(kind: &str) -> Option<usize> {
    match kind {
        "SPRINGA" | "SPRING2" | "DASHPOTA" | "DASHPOT2" | "GAPUNI" => Some(2),
        "SPRING1" | "DASHPOT1" | "MASS" | "DCOUP3D" | "DCOUP2D" => Some(1),
        _ => None,
    }
}

/// Nodes of lines and faces, which generators of meshes write beside the cells that they bound.
fn bounding(kind: &str) -> Option<usize> {
    let (start, rest) = ["T2D", "T3D", "STRI", "S", "M3D", "B3", "B2"]
        .into_iter()
        .find_map(|start| Some((start, kind.strip_prefix(start)?)))?;
    let digits = rest.bytes().take_while(u8::is_ascii_digit).count();
    match (start, &rest[..digits]) {
        ("T2D" | "T3D", n @ ("2" | "3")) => n.parse().ok(),
        ("STRI", "3") => Some(3),
        ("STRI", "65") => Some(6),
        ("S" | "M3D", n @ ("3" | "4" | "6" | "8")) => n.parse().ok(),
        ("B2" | "B3", "1") => Some(2),
        ("B2" | "B3", "2") => Some(3),
        _ => None,
    }
}

/// Lines and faces without a section bound the cells beside them, and are there for their sets: Gmsh writes them. Without such cells,
/// or with a section, they are meant to be computed.
pub(super) fn judge_bounding(reader: &mut Reader) {
    let messages = &mut reader.messages;
    let bounding: Vec<_> = reader.sets.bounding.drain(..).collect();
    for (kind, place) in bounding {
        let flat = kind.starts_with("T") || kind.starts_with("B");
        let unsupported = abaqus::element_type(&kind).err();
        let cells = reader.deck.elements.values().any(|e| {
            abaqus::element_type(&e.kind).is_ok_and(|t| flat || t.space == abaqus::Space::Solid)
        });
        let sectioned = reader.deck.properties.sections.iter().any(|s| {
            let mut all = reader.deck.element_sets.get(&s.set).into_iter().flatten();
            all.any(|e| reader.deck.elements.get(e).is_some_and(|e| e.kind == kind))
        });
        let sectioned = sectioned || unsupported.is_some_and(|u| messages.has_beyond(u.what));
        if cells && !sectioned {
            messages.note(place, format!("elements of type {kind} have no section: they are taken as lines or faces of the cells, for their sets"));
        } else if let Some(why) = unsupported {
            let all = reader.deck.elements.values();
            let count = all.filter(|e| e.kind == kind).count();
            messages.elements_beyond(&kind, count, why.what, why.help, place);
        }
    }
}

/// How many nodes elements of a type have; says what is to be said of the type.
fn node_count(reader: &mut Reader, kind: &str, card: &Card) -> Option<usize> {
    let messages = &mut reader.messages;
    match (other_nodes(kind), abaqus::element_type(kind)) {
        (Some(n), _) => Some(n),
        (None, Ok(t)) => {
            for note in &t.notes {
                messages.note(card.place, format!("{kind}: {note}"));
            }
            Some(t.kind.node_count())
        }
        (None, Err(_)) if bounding(kind).is_some() => {
            if !reader.sets.bounding.iter().any(|(k, _)| *k == kind) {
                reader.sets.bounding.push((kind.to_string(), card.place));
            }
            bounding(kind)
        }
        (None, Err(why)) => {
            // The lines that begin an element have as many fields as the first.
            let wide =
                |d: &&Data| Some(d.fields.len()) == card.data.first().map(|f| f.fields.len());
            let count = card.data.iter().filter(wide).count();
            messages.elements_beyond(kind, count, why.what, why.help, card.place);
            let ids = card
                .data
                .iter()
                .filter_map(|d| text::whole(d.fields.first()?));
            let ids = ids.map(|n| reader.scope.of(n));
            reader.sets.skipped.extend(ids);
            let set = card.get("ELSET").map(|s| reader.scope.scoped(s));
            reader.sets.skipped_sets.extend(set);
            None
        }
    }
}

/// Keeps an element. Its nodes may come later.
pub(super) fn keep(reader: &mut Reader, id: u64, element: Element) {
    let place = element.place;
    if element
        .nodes
        .iter()
        .any(|n| !reader.deck.nodes.contains_key(n))
    {
        reader.sets.waiting.push((id, place));
    }
    if reader.deck.elements.insert(id, element).is_some() {
        let message = format!("element {} is given twice", reader.scope.label(id));
        let help = "numbers of elements are unique in the whole deck, or in an instance";
        reader.messages.error(place, message, help);
    }
}

/// Elements whose nodes have not come.
pub(super) fn judge_waiting(reader: &mut Reader) {
    let messages = &mut reader.messages;
    let mut said = BTreeSet::new();
    let waiting: Vec<_> = reader.sets.waiting.drain(..).collect();
    for (id, place) in waiting {
        let absent = |n: &&u64| !reader.deck.nodes.contains_key(n);
        let Some(n) = reader.deck.elements[&id].nodes.iter().find(absent) else {
            continue;
        };
        // What a line lacks it lacks in each instance; and nodes that could not be read are missed for that.
        if messages.unread || !said.insert((place.file, place.line)) {
            continue;
        }
        let (id, n) = (reader.scope.label(id), reader.scope.label(*n));
        let message = format!("element {id} uses node {n}, which does not exist");
        let help = "each node of an element stands in *NODE, or is generated";
        messages.error(place, message, help);
    }
}

pub(super) fn elements(reader: &mut Reader, card: &Card) {
    let Some(kind) = required(&mut reader.messages, card, "TYPE") else {
        return;
    };
    let Some(count) = node_count(reader, &kind, card) else {
        return;
    };
    let mut set = Vec::new();
    let mut forgiven = false;
    let mut lines = card.data.iter();
    while let Some(data) = lines.next() {
        let Some(id) = own_number(reader, data) else {
            continue;
        };
        let mut nodes = Vec::with_capacity(count);
        // What is filled up with zeros ends before them.
        let zeros = data.fields.iter().rev().take_while(|f| *f == "0").count();
        let filled = zeros.min(data.fields.len().saturating_sub(count + 1));
        let end = data.fields.len() - filled;
        members(reader, data, 1..end, &mut nodes);
        // An element goes on until it has its nodes.
        while nodes.len() < count {
            let Some(more) = lines.next() else { break };
            members(reader, more, 0..more.fields.len(), &mut nodes);
        }
        // CalculiX reads as many numbers as the type has nodes. As many as another type has say that the type is another.
        if nodes.len() > count && !NODE_COUNTS.contains(&nodes.len()) {
            if !forgiven {
                let message = format!(
                    "{kind} has {count} nodes: further numbers in the lines of its elements are left out"
                );
                reader.messages.note(data.place, message);
            }
            forgiven = true;
            nodes.truncate(count);
        }
        if nodes.len() != count {
            let id = reader.scope.label(id);
            let message = format!("element {id} has {} nodes; {kind} has {count}", nodes.len());
            let help = "an element goes on in the next line until it has all its nodes";
            reader.messages.error(data.place, message, help);
            continue;
        }
        let element = Element {
            kind: kind.clone(),
            nodes,
            place: data.place,
        };
        keep(reader, id, element);
        set.push(id);
    }
    if let Some(name) = card.get("ELSET") {
        let name = reader.scope.scoped(name);
        add(reader.deck.element_sets.entry(name).or_default(), set);
    }
}

/// The numbers of some fields.
fn members(reader: &mut Reader, data: &Data, fields: Range<usize>, out: &mut Vec<u64>) {
    for i in fields {
        if let Some(n) = number_at(reader, data, i) {
            out.push(n);
        }
    }
}

/// Whether an element has the face; it is an error if not.
pub(super) fn has_face(reader: &mut Reader, element: u64, face: usize, place: Place) -> bool {
    let messages = &mut reader.messages;
    if reader.sets.reflected.contains(&element) {
        let label = reader.scope.label(element);
        let message = format!(
            "a face of element {label}, which *ELCOPY, REFLECT has made, is named by its number"
        );
        let help = "write the reflected elements out: which face has which number depends on how the nodes are turned round";
        messages.error(place, message, help);
        return false;
    }
    let kind = &reader.deck.elements[&element].kind;
    let known = bounding(kind).is_some()
        || abaqus::element_type(kind).is_ok_and(|t| abaqus::face_index(t.kind, face).is_some());
    if !known {
        let element = reader.scope.label(element);
        let message = format!("element {element} ({kind}) has no face {face}");
        let help = "faces are numbered as in the manual of CalculiX, from 1";
        messages.error(place, message, help);
    }
    known
}
