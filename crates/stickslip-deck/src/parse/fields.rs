//! What the parameters and fields of a card say, or the finding that they do not say it.

use super::known::absent;
use super::reader::Reader;
use crate::card::{Card, Data, Place};
use crate::deck::Target;
use crate::text::{clip, number, squeeze, whole};

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

impl Reader<'_> {
    /// A parameter that must have a value.
    pub(super) fn required(&mut self, card: &Card, name: &str) -> Option<String> {
        match card.get(name) {
            Some(value) if !value.is_empty() => Some(value.to_string()),
            _ => {
                let message = format!("{} needs the parameter {name}", card.written);
                self.error(
                    card.place,
                    message,
                    &format!("write {}, {name}=...", card.written),
                );
                None
            }
        }
    }

    /// A parameter that must name something of the scope.
    pub(super) fn required_name(&mut self, card: &Card, parameter: &str) -> Option<String> {
        let name = self.required(card, parameter)?;
        Some(self.scoped(&name))
    }

    /// The number by which the scope defines a node or an element, in the first field.
    pub(super) fn own_number(&mut self, data: &Data) -> Option<u64> {
        let n = self.whole(data, 0)?;
        Some(self.deck.numbering.of(self.scope, n))
    }

    /// A field as a number, the default where it is empty or missing.
    pub(super) fn number(&mut self, data: &Data, field: usize, default: f64) -> f64 {
        let text = data.fields.get(field).map_or("", String::as_str);
        if text.is_empty() {
            return default;
        }
        match number(text) {
            Some(value) => value,
            None => {
                let message = format!(
                    "field {} is `{}`: a finite number is expected",
                    field + 1,
                    clip(text)
                );
                self.error(
                    data.place,
                    message,
                    "write numbers as 1.5, 2.E-3 or 1D4, separated by commas",
                );
                default
            }
        }
    }

    /// A field as a whole number above zero.
    pub(super) fn whole(&mut self, data: &Data, field: usize) -> Option<u64> {
        let text = data.fields.get(field).map_or("", String::as_str);
        let value = whole(text);
        if value.is_none() {
            let message = format!(
                "field {} is `{}`: a whole number above 0 is expected",
                field + 1,
                clip(text)
            );
            self.error(
                data.place,
                message,
                "numbers of nodes and elements and directions count from 1",
            );
        }
        value
    }

    /// A field as the number of a node or element, as the deck keeps it.
    pub(super) fn number_at(&mut self, data: &Data, field: usize) -> Option<u64> {
        let text = data.fields.get(field).map_or("", String::as_str);
        match self.number_of(text) {
            Some(n) => Some(n),
            // It says what is wrong.
            None => self.whole(data, field),
        }
    }

    /// The first data line.
    pub(super) fn line<'c>(&mut self, card: &'c Card) -> Option<&'c Data> {
        if card.data.is_empty() {
            self.error(
                card.place,
                format!("{} has no data line", card.written),
                "the numbers stand in the line after the keyword",
            );
        }
        card.data.first()
    }

    /// A node or a set of nodes.
    pub(super) fn target(&mut self, data: &Data, field: usize) -> Option<Target> {
        let text = data.fields.get(field).map_or("", String::as_str);
        if text.is_empty() {
            self.error(
                data.place,
                "a node or a set of nodes is expected in the first field",
                "write node or set, direction, value",
            );
            return None;
        }
        Some(match self.number_of(text) {
            Some(node) => Target::One(node),
            None => Target::Set(self.name(text)),
        })
    }

    /// A direction 1 to `most` as 0 to `most - 1`.
    pub(super) fn direction(&mut self, data: &Data, field: usize, most: u64) -> Option<usize> {
        let d = self.whole(data, field)?;
        if d > most {
            let help = match most {
                3 => "directions are 1 (x), 2 (y) and 3 (z)",
                _ => {
                    "directions are 1 (x), 2 (y), 3 (z) and, at the reference node of a rigid body, 4 to 6"
                }
            };
            self.error(data.place, format!("there is no direction {d} here"), help);
            return None;
        }
        Some(d as usize - 1)
    }

    /// What is meant by a text that is the number of a node or, as a label, the name of a set.
    pub(super) fn named_nodes(&self, text: &str, name: String) -> Nodes {
        match self.number_of(text) {
            Some(n) if self.deck.nodes.contains_key(&n) => Nodes::One(n),
            Some(n) => Nodes::Absent(n),
            None if self.deck.node_sets.contains_key(&name) => Nodes::Set(name),
            None => Nodes::NoSet,
        }
    }

    /// Elements by number or set, from a field.
    pub(super) fn elements_of(&mut self, text: &str, place: Place) -> Vec<u64> {
        let name = self.name(text);
        self.elements_named(text, &name, place)
    }

    /// Elements by number, or by the name of a set as the deck keeps it.
    pub(super) fn elements_named(&mut self, text: &str, name: &str, place: Place) -> Vec<u64> {
        match self.number_of(text) {
            Some(n) if self.deck.elements.contains_key(&n) => vec![n],
            Some(n) if self.sets.skipped.contains(&n) => Vec::new(),
            Some(n) => {
                self.error(
                    place,
                    format!("there is no element {}", self.deck.label(n)),
                    "elements must stand before what refers to them",
                );
                Vec::new()
            }
            None => match self.deck.element_sets.get(name) {
                Some(set) => set.clone(),
                None if self.sets.skipped_sets.contains(name) => Vec::new(),
                None => {
                    let known = self.deck.element_sets.keys();
                    let (message, help) =
                        absent(&self.deck.numbering, "set of elements", name, known);
                    self.error(place, message, &help);
                    Vec::new()
                }
            },
        }
    }
}

/// The value of a parameter that is a number.
pub(super) fn parameter(reader: &mut Reader, card: &Card, name: &str) -> Option<f64> {
    let text = card.get(name)?;
    let value = number(text);
    if value.is_none() {
        let message = format!(
            "{}: {name} is `{}`: a number is expected",
            card.written,
            clip(text)
        );
        reader.error(card.place, message, "write it as 1.5 or 2.E-3");
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
