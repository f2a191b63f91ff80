//! `*ELGEN` and `*ELCOPY`: elements that are made of others, as in Abaqus.

use super::elements;
use super::fields::{number, own_number, required, required_name, whole};
use super::generate::MOST_OF_A_LINE;
use super::known::absent;
use super::messages::Messages;
use super::reader::Reader;
use super::sets::add;
use crate::card::{Card, Data, Place};
use crate::deck::Element;
use crate::text::{self, clip};

/// By how much the numbers that a card makes can be larger than those before it.
pub(super) fn farther(card: &Card) -> u64 {
    let at = |d: &Data, i: usize| d.fields.get(i).and_then(|f| text::whole(f)).unwrap_or(1);
    let parameter = |name: &str| {
        let value = card.parameters.iter().find(|p| p.name == name);
        let value = value.and_then(|p| text::number(p.value.as_deref()?));
        value.map_or(0, |n| n.max(0.0) as u64)
    };
    match card.keyword.as_str() {
        "NFILL" => (card.data.iter())
            .map(|d| at(d, 2).saturating_mul(at(d, 3)))
            .fold(0, u64::max),
        "ELGEN" => (card.data.iter())
            .map(|d| {
                let of = |i: usize| at(d, i).saturating_mul(at(d, i + 2));
                of(1).saturating_add(of(4)).saturating_add(of(7))
            })
            .fold(0, u64::max),
        "NCOPY" => parameter("CHANGENUMBER"),
        "ELCOPY" => parameter("ELEMENTSHIFT"),
        _ => 0,
    }
}

/// The order in which an element that was reflected has its nodes, so that it is not inside out.
fn turned_round(count: usize, solid: bool) -> Option<&'static [usize]> {
    Some(match (count, solid) {
        (3, false) => &[0, 2, 1],
        (6, false) => &[0, 2, 1, 5, 4, 3],
        (4, false) => &[0, 3, 2, 1],
        (8, false) => &[0, 3, 2, 1, 7, 6, 5, 4],
        (4, true) => &[0, 2, 1, 3],
        (10, true) => &[0, 2, 1, 3, 6, 5, 4, 7, 9, 8],
        (6, true) => &[0, 2, 1, 3, 5, 4],
        (15, true) => &[0, 2, 1, 3, 5, 4, 8, 7, 6, 11, 10, 9, 12, 14, 13],
        (8, true) => &[0, 3, 2, 1, 4, 7, 6, 5],
        (20, true) => &[
            0, 3, 2, 1, 4, 7, 6, 5, 11, 10, 9, 8, 15, 14, 13, 12, 16, 19, 18, 17,
        ],
        _ => return None,
    })
}

/// An element with the numbers of its nodes raised; `None` where numbers leave the scope.
fn raised(reader: &mut Reader, element: &Element, by: i64, place: Place) -> Option<Element> {
    let mut nodes = Vec::with_capacity(element.nodes.len());
    for n in &element.nodes {
        nodes.push(raised_number(reader, *n, by, place)?);
    }
    Some(Element {
        kind: element.kind.clone(),
        nodes,
        place,
    })
}

fn raised_number(reader: &mut Reader, n: u64, by: i64, place: Place) -> Option<u64> {
    let own = reader.scope.numbering.parts(n).1;
    match own.checked_add_signed(by).filter(|n| *n > 0) {
        Some(new) => Some(reader.scope.of(new)),
        None => {
            let message = format!("the number {own} cannot be raised by {by}");
            reader.messages.error(place, message, "numbers are above 0");
            None
        }
    }
}

fn master(reader: &mut Reader, data: &Data) -> Option<(u64, Element)> {
    let id = own_number(reader, data)?;
    let found = reader.deck.elements.get(&id).cloned();
    if found.is_none() && !reader.sets.skipped.contains(&id) {
        let message = format!("there is no element {}", reader.scope.label(id));
        let help = "*ELEMENT must stand before what is made of its elements";
        reader.messages.error(data.place, message, help);
    }
    Some((id, found?))
}

/// Number, increment of nodes and increment of elements of rows (1), rows of a layer (4) and layers (7).
fn series(messages: &mut Messages, data: &Data, from: usize) -> Option<(u64, i64, i64)> {
    let given = |i: usize| data.fields.get(i).is_some_and(|f| !f.is_empty());
    let count = match given(from) {
        true => whole(messages, data, from)?,
        false => 1,
    };
    let mut by = [1_i64; 2];
    for (k, by) in by.iter_mut().enumerate() {
        let field = from + 1 + k;
        if given(field) {
            let value = number(messages, data, field, 1.0);
            if value.fract() != 0.0 || value.abs() > 4e9 {
                whole(messages, data, field);
                return None;
            }
            *by = value as i64;
        } else if count > 1 && from > 1 {
            let message = format!("*ELGEN: field {} is missing", field + 1);
            messages.error(data.place, message, "each number of rows and of layers is followed by the increments of nodes and of elements");
            return None;
        }
    }
    Some((count, by[0], by[1]))
}

/// `*ELGEN`: an element again and again, in rows and layers.
pub(super) fn generate_elements(reader: &mut Reader, card: &Card) {
    let mut made = Vec::new();
    for data in &card.data {
        let Some((id, master)) = master(reader, data) else {
            continue;
        };
        let all = [1, 4, 7].map(|from| series(&mut reader.messages, data, from));
        let [Some(row), Some(rows), Some(layers)] = all else {
            continue;
        };
        let count = row.0.saturating_mul(rows.0).saturating_mul(layers.0);
        if count > MOST_OF_A_LINE {
            let message = format!("*ELGEN asks for {count} elements");
            reader.messages.error(
                data.place,
                message,
                &format!("a line makes up to {MOST_OF_A_LINE}"),
            );
            continue;
        }
        for k in 0..count {
            let at = [k % row.0, k / row.0 % rows.0, k / (row.0 * rows.0)].map(|n| n as i64);
            let sum = |by: [i64; 3]| at.iter().zip(by).map(|(n, by)| n * by).sum::<i64>();
            let (nodes, elements) = (
                sum([row.1, rows.1, layers.1]),
                sum([row.2, rows.2, layers.2]),
            );
            let new = match k {
                0 => Some(id),
                _ => raised_number(reader, id, elements, data.place),
            };
            let (Some(new), Some(element)) = (new, raised(reader, &master, nodes, data.place))
            else {
                break;
            };
            if k > 0 {
                elements::keep(reader, new, element);
            }
            made.push(new);
        }
    }
    if let Some(name) = card.get("ELSET") {
        let name = reader.scope.scoped(name);
        add(reader.deck.element_sets.entry(name).or_default(), made);
    }
}

/// A parameter that is a whole number.
fn shift(messages: &mut Messages, card: &Card, name: &str) -> Option<i64> {
    let text = required(messages, card, name)?;
    let value = text::number(&text).filter(|n| n.fract() == 0.0 && n.abs() < 4e9);
    if value.is_none() {
        let message = format!("{}: {name} is `{}`", card.written, clip(&text));
        messages.error(card.place, message, "it is a whole number");
    }
    value.map(|n| n as i64)
}

/// `*ELCOPY`: elements of a set once more, on other nodes.
pub(super) fn copy_elements(reader: &mut Reader, card: &Card) {
    let (Some(old), Some(elements), Some(nodes)) = (
        required_name(reader, card, "OLDSET"),
        shift(&mut reader.messages, card, "ELEMENTSHIFT"),
        shift(&mut reader.messages, card, "SHIFTNODES"),
    ) else {
        return;
    };
    let Some(set) = reader.deck.element_sets.get(&old).cloned() else {
        if !reader.sets.skipped_sets.contains(&old) {
            let known = reader.deck.element_sets.keys();
            let (message, help) = absent(&reader.scope.numbering, "set of elements", &old, known);
            reader.messages.error(card.place, message, &help);
        }
        return;
    };
    let mut made = Vec::with_capacity(set.len());
    for id in set {
        let element = reader.deck.elements[&id].clone();
        let new = raised_number(reader, id, elements, card.place);
        let copy = raised(reader, &element, nodes, card.place);
        let (Some(new), Some(mut copy)) = (new, copy) else {
            return;
        };
        if card.has("REFLECT") {
            let solid = copy.kind.starts_with("C3D");
            let Some(order) = turned_round(copy.nodes.len(), solid) else {
                let message = format!("{} cannot be reflected", copy.kind);
                let help = "write the elements out";
                reader.messages.error(card.place, message, help);
                return;
            };
            copy.nodes = order.iter().map(|i| copy.nodes[*i]).collect();
            reader.sets.reflected.insert(new);
        }
        elements::keep(reader, new, copy);
        made.push(new);
    }
    if let Some(name) = card.get("NEWSET") {
        let name = reader.scope.scoped(name);
        add(reader.deck.element_sets.entry(name).or_default(), made);
    }
}
