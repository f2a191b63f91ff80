//! Surfaces: faces of elements, or nodes.

use std::collections::BTreeSet;

use super::elements;
use super::fields::{Nodes, elements_of, named_nodes, required_name};
use super::messages::Messages;
use super::reader::Reader;
use crate::card::{Card, Data, Place};
use crate::deck::{Surface, SurfaceParts};
use crate::text::{clip, squeeze};

/// `S3` or `P3` as 3.
pub(super) fn face(
    messages: &mut Messages,
    text: &str,
    letter: char,
    place: Place,
) -> Option<usize> {
    let text = squeeze(text);
    // Sides of shells and membranes.
    let side = matches!(text.as_str(), "SPOS" | "SNEG" | "SP" | "SN") && letter == 'S';
    let text = if side { "S1".to_string() } else { text };
    let n = text
        .strip_prefix(letter)
        .and_then(|n| n.parse().ok())
        .filter(|n| (1..=6).contains(n));
    if n.is_none() {
        let message = format!("`{}` is no face", clip(&text));
        messages.error(
            place,
            message,
            &format!("faces of elements are {letter}1 to {letter}6"),
        );
    }
    n
}

/// Faces of elements, of which those without a number are all that lie outside.
fn faces_of(reader: &mut Reader, card: &Card) -> Vec<(u64, Option<usize>)> {
    let mut faces = Vec::new();
    for data in &card.data {
        let Some(first) = data.fields.first() else {
            continue;
        };
        let elements = elements_of(reader, first, data.place);
        let face = match data.fields.get(1).filter(|f| !f.is_empty()) {
            Some(text) => match face(&mut reader.messages, &text.clone(), 'S', data.place) {
                Some(n) => Some(n),
                None => continue,
            },
            None => None,
        };
        for e in elements {
            if face.is_none_or(|f| elements::has_face(reader, e, f, data.place)) {
                faces.push((e, face));
            }
        }
    }
    faces
}

fn nodes_of(reader: &mut Reader, card: &Card) -> Vec<u64> {
    let mut nodes = Vec::new();
    for data in &card.data {
        let Some(field) = data.fields.first() else {
            continue;
        };
        match named_nodes(reader, field, reader.scope.name(field)) {
            Nodes::One(n) => nodes.push(n),
            Nodes::Absent(n) => reader.messages.error(
                data.place,
                format!("there is no node {}", reader.scope.label(n)),
                "*NODE must stand before what refers to it",
            ),
            Nodes::Set(name) => nodes.extend(&reader.deck.node_sets[&name]),
            Nodes::NoSet => reader.messages.error(
                data.place,
                format!("there is no set of nodes {}", clip(field)),
                "define it with *NSET before",
            ),
        }
    }
    nodes
}

pub(super) fn surface(reader: &mut Reader, card: &Card) {
    let Some(name) = required_name(reader, card, "NAME") else {
        return;
    };
    if let Some(how) = card.get("COMBINE").map(str::to_string) {
        combine(reader, card, name, &how);
        return;
    }
    let outside = |d: &Data| d.fields.len() < 2;
    if card.get("TRIM") == Some("YES") && card.data.iter().any(outside) {
        let message = "*SURFACE, TRIM=YES is not supported";
        let help = "name the faces (S1 to S6) that are meant";
        reader.messages.error(card.place, message, help);
    }
    let parts = match card.get("TYPE").unwrap_or("ELEMENT") {
        "" | "ELEMENT" => SurfaceParts::Faces(faces_of(reader, card)),
        "NODE" => SurfaceParts::Nodes(nodes_of(reader, card)),
        other => {
            let message = format!("*SURFACE of type {other} is not supported");
            reader.messages.error(card.place, message, "surfaces are of type ELEMENT or NODE; a rigid surface can be a *RIGID BODY of elements");
            return;
        }
    };
    let empty = match &parts {
        SurfaceParts::Faces(f) => f.is_empty(),
        SurfaceParts::Nodes(n) => n.is_empty(),
    };
    if empty && reader.messages.sound() {
        let message = format!("the surface {name} is empty");
        let help = "name faces of elements, or nodes with TYPE=NODE";
        reader.messages.error(card.place, message, help);
    }
    put_surface(reader, card, name, parts);
}

fn put_surface(reader: &mut Reader, card: &Card, name: String, parts: SurfaceParts) {
    let surface = Surface {
        parts,
        place: card.place,
    };
    if reader.deck.surfaces.insert(name.clone(), surface).is_some() {
        let message = format!("the surface {name} is given twice");
        let help = "give each surface a name of its own";
        reader.messages.error(card.place, message, help);
    }
}

/// A surface of the faces or nodes of others: of all, of those that all have, or of the first without those of the rest.
fn combine(reader: &mut Reader, card: &Card, name: String, how: &str) {
    let messages = &mut reader.messages;
    let mut all = Vec::new();
    for field in card.data.iter().flat_map(|d| &d.fields) {
        let part = reader.scope.name(field);
        let Some(surface) = reader.deck.surfaces.get(&part) else {
            let message = format!("there is no surface {}", clip(field));
            let help = "define it with *SURFACE before it is combined with others";
            messages.error(card.place, message, help);
            return;
        };
        all.push(surface.parts.clone());
    }
    let combined = match how {
        "UNION" => joined(&all, |_, _| true, true),
        "INTERSECTION" => joined(&all, |i, n| i == n, false),
        "DIFFERENCE" => joined(&all, |i, _| i == 1, false),
        _ => {
            let message = format!("*SURFACE, COMBINE={} is not known", clip(how));
            let help = "COMBINE is UNION, INTERSECTION or DIFFERENCE";
            messages.error(card.place, message, help);
            return;
        }
    };
    match combined {
        Some(parts) => put_surface(reader, card, name, parts),
        None => reader.messages.error(
            card.place,
            format!(
                "the surfaces that {name} combines do not go together, or nothing is left of them"
            ),
            "name surfaces of faces with numbers, or of nodes",
        ),
    }
}

/// The members of surfaces of one kind: of the first surface, or of any, those that so many of all surfaces have. Faces without numbers are not known yet.
fn joined(
    all: &[SurfaceParts],
    wanted: impl Fn(usize, usize) -> bool,
    any: bool,
) -> Option<SurfaceParts> {
    fn members<T: Clone + PartialEq + Ord>(
        all: &[Vec<T>],
        wanted: impl Fn(usize, usize) -> bool,
        any: bool,
    ) -> Option<Vec<T>> {
        let sets: Vec<BTreeSet<&T>> = all.iter().map(|l| l.iter().collect()).collect();
        let from = if any { all } else { all.get(..1)? };
        let mut seen = BTreeSet::new();
        let kept = from.iter().flatten().filter(|m| {
            let count = sets.iter().filter(|s| s.contains(m)).count();
            wanted(count, sets.len()) && seen.insert(*m)
        });
        let kept: Vec<T> = kept.cloned().collect();
        (!kept.is_empty()).then_some(kept)
    }
    let mut faces = Vec::new();
    let mut nodes = Vec::new();
    for parts in all {
        match parts {
            SurfaceParts::Faces(list) => faces.push(list.clone()),
            SurfaceParts::Nodes(list) => nodes.push(list.clone()),
        }
    }
    let open = faces.iter().flatten().any(|(_, face)| face.is_none());
    match (faces.is_empty(), nodes.is_empty()) {
        (false, true) if any || !open => members(&faces, wanted, any).map(SurfaceParts::Faces),
        (true, false) => members(&nodes, wanted, any).map(SurfaceParts::Nodes),
        _ => None,
    }
}
