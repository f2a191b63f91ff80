//! What the parameters and fields of a card say, or the finding that they do not say it.

use super::known::absent;
use super::messages::Messages;
use super::reader::Reader;
use crate::card::{Card, Data, Place};
use crate::deck::Target;
use crate::text::{self, clip, squeeze};

/// Nodes by number or set.
pub(super) enum Nodes {
    /// A node that exists.
    One(u64),
    /// A number that no node has.
    Absent(u64),
    /// A set that exists, by its label.
    Set(String),
    /// The name of no set.
    NoSet,
}

/// A parameter that must have a value.
pub(super) fn required(messages: &mut Messages, card: &Card, name: &str) -> Option<String> {
    match card.get(name) {
        Some(value) if !value.is_empty() => Some(value.to_string()),
        _ => {
            let message = format!("{} needs the parameter {name}", card.written);
            messages.error(
                card.place,
                message,
                &format!("write {}, {name}=...", card.written),
            );
            None
        }
    }
}

/// A parameter that must name something of the scope.
pub(super) fn required_name(reader: &mut Reader, card: &Card, parameter: &str) -> Option<String> {
    let name = required(&mut reader.messages, card, parameter)?;
    Some(reader.scope.scoped(&name))
}

/// The number by which the scope defines a node or an element, in the first field.
pub(super) fn own_number(reader: &mut Reader, data: &Data) -> Option<u64> {
    let n = whole(&mut reader.messages, data, 0)?;
    Some(reader.scope.of(n))
}

/// A field as a number, the default where it is empty or missing.
pub(super) fn number(messages: &mut Messages, data: &Data, field: usize, default: f64) -> f64 {
    let text = data.fields.get(field).map_or("", String::as_str);
    if text.is_empty() {
        return default;
    }
    match text::number(text) {
        Some(value) => value,
        None => {
            let message = format!(
                "field {} is `{}`: a finite number is expected",
                field + 1,
                clip(text)
            );
            let help = "write numbers as 1.5, 2.E-3 or 1D4, separated by commas";
            messages.error(data.place, message, help);
            default
        }
    }
}

/// A field as a whole number above zero.
pub(super) fn whole(messages: &mut Messages, data: &Data, field: usize) -> Option<u64> {
    let text = data.fields.get(field).map_or("", String::as_str);
    let value = text::whole(text);
    if value.is_none() {
        let message = format!(
            "field {} is `{}`: a whole number above 0 is expected",
            field + 1,
            clip(text)
        );
        let help = "numbers of nodes and elements and directions count from 1";
        messages.error(data.place, message, help);
    }
    value
}

/// A field as the number of a node or element, as the deck keeps it.
pub(super) fn number_at(reader: &mut Reader, data: &Data, field: usize) -> Option<u64> {
    let text = data.fields.get(field).map_or("", String::as_str);
    match reader.scope.number_of(text) {
        Some(n) => Some(n),
        // It says what is wrong.
        None => whole(&mut reader.messages, data, field),
    }
}

/// The first data line.
pub(super) fn line<'c>(messages: &mut Messages, card: &'c Card) -> Option<&'c Data> {
    if card.data.is_empty() {
        let message = format!("{} has no data line", card.written);
        let help = "the numbers stand in the line after the keyword";
        messages.error(card.place, message, help);
    }
    card.data.first()
}

/// A node or a set of nodes.
pub(super) fn target(reader: &mut Reader, data: &Data, field: usize) -> Option<Target> {
    let text = data.fields.get(field).map_or("", String::as_str);
    if text.is_empty() {
        let message = "a node or a set of nodes is expected in the first field";
        let help = "write node or set, direction, value";
        reader.messages.error(data.place, message, help);
        return None;
    }
    Some(match reader.scope.number_of(text) {
        Some(node) => Target::One(node),
        None => Target::Set(reader.scope.name(text)),
    })
}

/// A direction 1 to `most` as 0 to `most - 1`.
pub(super) fn direction(
    messages: &mut Messages,
    data: &Data,
    field: usize,
    most: u64,
) -> Option<usize> {
    let d = whole(messages, data, field)?;
    if d > most {
        let help = match most {
            3 => "directions are 1 (x), 2 (y) and 3 (z)",
            _ => {
                "directions are 1 (x), 2 (y), 3 (z) and, at the reference node of a rigid body, 4 to 6"
            }
        };
        messages.error(data.place, format!("there is no direction {d} here"), help);
        return None;
    }
    Some(d as usize - 1)
}

/// What is meant by a text that is the number of a node or, as a label, the name of a set.
pub(super) fn named_nodes(reader: &Reader, text: &str, name: String) -> Nodes {
    match reader.scope.number_of(text) {
        Some(n) if reader.deck.nodes.contains_key(&n) => Nodes::One(n),
        Some(n) => Nodes::Absent(n),
        None if reader.deck.node_sets.contains_key(&name) => Nodes::Set(name),
        None => Nodes::NoSet,
    }
}

/// Elements by number or set, from a field.
pub(super) fn elements_of(reader: &mut Reader, text: &str, place: Place) -> Vec<u64> {
    let name = reader.scope.name(text);
    elements_named(reader, text, &name, place)
}

/// Elements by number, or by the name of a set as the deck keeps it.
pub(super) fn elements_named(
    reader: &mut Reader,
    text: &str,
    name: &str,
    place: Place,
) -> Vec<u64> {
    let messages = &mut reader.messages;
    match reader.scope.number_of(text) {
        Some(n) if reader.deck.elements.contains_key(&n) => vec![n],
        Some(n) if reader.sets.skipped.contains(&n) => Vec::new(),
        Some(n) => {
            let message = format!("there is no element {}", reader.scope.label(n));
            let help = "elements must stand before what refers to them";
            messages.error(place, message, help);
            Vec::new()
        }
        None => match reader.deck.element_sets.get(name) {
            Some(set) => set.clone(),
            None if reader.sets.skipped_sets.contains(name) => Vec::new(),
            None => {
                let known = reader.deck.element_sets.keys();
                let (message, help) =
                    absent(&reader.scope.numbering, "set of elements", name, known);
                messages.error(place, message, &help);
                Vec::new()
            }
        },
    }
}

/// It is an error if a card has more lines, or lines with more fields, than these.
pub(super) fn only(messages: &mut Messages, card: &Card, lines: usize, fields: &[&str]) {
    let means = |text: &String| !text.is_empty() && text::number(text) != Some(0.0);
    let beyond = card.data.iter().enumerate().find_map(|(i, data)| {
        let from = if i < lines { fields.len() } else { 0 };
        let at = from + data.fields.iter().skip(from).position(means)?;
        Some((data.place, at, data.fields[at].clone()))
    });
    if let Some((place, field, text)) = beyond {
        let message = format!(
            "{}: field {} of this line, `{}`, is not read",
            card.written,
            field + 1,
            clip(&text)
        );
        let one = if lines == 1 { ", in one line" } else { "" };
        messages.error(
            place,
            message,
            &format!("the fields are: {}{one}", fields.join(", ")),
        );
    }
}

/// It is an error if a line has more fields than the kind of load reads.
pub(super) fn no_more(messages: &mut Messages, data: &Data, count: usize, kind: &str) {
    let means = |text: &String| !text.is_empty() && text::number(text) != Some(0.0);
    if let Some(at) = data.fields.iter().skip(count).position(means) {
        let field = count + at;
        let message = format!(
            "field {} of this line, `{}`, is not read",
            field + 1,
            clip(&data.fields[field])
        );
        messages.error(
            data.place,
            message,
            &format!("a line with {kind} has {count} fields"),
        );
    }
}

/// The value of a parameter that is a number.
pub(super) fn parameter(messages: &mut Messages, card: &Card, name: &str) -> Option<f64> {
    let text = card.get(name)?;
    let value = text::number(text);
    if value.is_none() {
        let message = format!(
            "{}: {name} is `{}`: a number is expected",
            card.written,
            clip(text)
        );
        messages.error(card.place, message, "write it as 1.5 or 2.E-3");
    }
    value
}

/// A list of keys such as `U, RF`, over all data lines.
pub(super) fn keys(card: &Card) -> Vec<String> {
    card.data
        .iter()
        .flat_map(|d| d.fields.iter().map(|f| squeeze(f)))
        .filter(|k| !k.is_empty())
        .collect()
}
