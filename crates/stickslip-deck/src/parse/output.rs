//! What is printed and written, and when.

use stickslip::io::frd::Encoding;
use stickslip::results::Quantity;

use super::fields::{keys, parameter, required_name};
use super::known::absent;
use super::messages::Messages;
use super::reader::Reader;
use super::{sets, step};
use crate::card::Card;
use crate::deck::{Deck, FieldsOf, Filed, Print, SurfaceParts, Totals, When};
use crate::text::clip;

/// Every so many increments, or at times; `None` is never.
pub(super) fn when(reader: &mut Reader, card: &Card) -> Option<When> {
    if let Some(name) = card.get("TIMEPOINTS").map(str::to_string) {
        if let Some(step) = reader.deck.steps.last_mut() {
            step.output_times.push(name.clone());
        }
        return Some(When::Times(name));
    }
    let name = ["FREQUENCY", "FREQUENCYF"]
        .into_iter()
        .find(|n| card.has(n));
    let every = name
        .and_then(|n| parameter(&mut reader.messages, card, n))
        .unwrap_or(1.0)
        .max(0.0);
    (every >= 1.0).then_some(When::Every(every.min(1e9) as usize))
}

/// The quantities of a card that are printed; notes on the others.
fn known_keys(messages: &mut Messages, card: &Card) -> Vec<String> {
    let known: &[&str] = match card.keyword.as_str() {
        "NODEPRINT" => &["U", "RF", "V", "A", "UR", "RM", "NT", "NT11"],
        "ELPRINT" => &["S", "E", "ME", "ELSE", "EVOL"],
        _ => &[
            "CDIS", "CDISP", "CSTR", "CSTRESS", "CELS", "CF", "CNUM", "CFN", "CFS",
        ],
    };
    let (printed, others): (Vec<String>, Vec<String>) = keys(card)
        .into_iter()
        .partition(|k| known.contains(&k.as_str()));
    for key in others {
        let message = format!(
            "{}: {} is left out: it is not printed",
            card.written,
            clip(&key)
        );
        messages.note(card.place, message);
    }
    printed
}

/// The set that is printed, of nodes or of elements.
fn printed_set(
    reader: &mut Reader,
    card: &Card,
    parameter: &str,
    what: &str,
    known: impl Fn(&Deck, &str) -> bool,
) -> Option<String> {
    let messages = &mut reader.messages;
    let Some(set) = card.get(parameter).map(|s| reader.scope.scoped(s)) else {
        let message = format!("{} names no set: nothing is printed", card.written);
        messages.note(card.place, message);
        return None;
    };
    if !known(&reader.deck, &set) {
        messages.error(
            card.place,
            format!("there is no set of {what} {set}"),
            &format!("define it with *{parameter} before it is printed"),
        );
        return None;
    }
    Some(set)
}

pub(super) fn print(reader: &mut Reader, card: &Card) {
    if step::own_step(reader, card).is_none() {
        return;
    }
    let kind = |p: &Print| match p {
        Print::Node { .. } => "NODEPRINT",
        Print::Element { .. } => "ELPRINT",
        Print::Contact { .. } => "CONTACTPRINT",
        Print::Section { .. } => "SECTIONPRINT",
    };
    if reader.position.asked.insert(card.keyword.clone())
        && let Some(step) = reader.deck.steps.last_mut()
    {
        step.prints.retain(|p| kind(p) != card.keyword);
    }
    let totals = match card.get("TOTALS") {
        Some("YES") => Totals::Yes,
        Some("ONLY") => Totals::Only,
        _ => Totals::No,
    };
    let Some(when) = when(reader, card) else {
        return;
    };
    let keys = known_keys(&mut reader.messages, card);
    let sums = match card.keyword.as_str() {
        "NODEPRINT" => card.get("NSET").map(|s| (0, reader.scope.scoped(s))),
        "ELPRINT" => card.get("ELSET").map(|s| (1, reader.scope.scoped(s))),
        _ => None,
    };
    if let (true, Some((kind, set))) = (totals != Totals::No, sums) {
        sets::once(reader, kind, &set, card.place);
    }
    let global = || card.get("GLOBAL") == Some("YES");
    let print = match card.keyword.as_str() {
        "NODEPRINT" => printed_set(reader, card, "NSET", "nodes", |d, set| {
            d.node_sets.contains_key(set)
        })
        .map(|set| Print::Node {
            set,
            keys,
            totals,
            global: global(),
            when,
        }),
        "ELPRINT" => printed_set(reader, card, "ELSET", "elements", |d, set| {
            d.element_sets.contains_key(set)
        })
        .map(|set| Print::Element {
            set,
            keys,
            totals,
            global: global(),
            when,
        }),
        _ => {
            let pair = card.get("SLAVE").zip(card.get("MASTER"));
            Some(Print::Contact {
                pair: pair.map(|(s, m)| (reader.scope.scoped(s), reader.scope.scoped(m))),
                keys,
                totals,
                when,
            })
        }
    };
    if let (Some(print), Some(step)) = (print, reader.deck.steps.last_mut()) {
        step.prints.push(print);
    }
}

/// What surfaces carry. A card takes the place of those in earlier steps.
pub(super) fn section_print(reader: &mut Reader, card: &Card) {
    if step::own_step(reader, card).is_none() {
        return;
    }
    let first = reader.position.asked.insert(card.keyword.clone());
    if let (true, Some(step)) = (first, reader.deck.steps.last_mut()) {
        step.prints.retain(|p| !matches!(p, Print::Section { .. }));
    }
    let Some(surface) = required_name(reader, card, "SURFACE") else {
        return;
    };
    let (sums, others): (Vec<String>, Vec<String>) = keys(card)
        .into_iter()
        .partition(|k| ["SOF", "SOM", "SOAREA"].contains(&k.as_str()));
    for key in others {
        let message = format!(
            "{}: {} is left out: it is not printed",
            card.written,
            clip(&key)
        );
        reader.messages.note(card.place, message);
    }
    match reader.deck.surfaces.get(&surface).map(|s| &s.parts) {
        Some(SurfaceParts::Faces(_)) => {}
        Some(SurfaceParts::Nodes(_)) => {
            let message = format!("the surface {surface} consists of nodes");
            let help = "*SECTION PRINT sums up what faces carry";
            reader.messages.error(card.place, message, help);
            return;
        }
        None => {
            let known = reader.deck.surfaces.keys();
            let (message, help) = absent(&reader.scope.numbering, "surface", &surface, known);
            reader.messages.error(card.place, message, &help);
            return;
        }
    }
    // Each of the keys prints all of it.
    if let (false, Some(when)) = (sums.is_empty(), when(reader, card))
        && let Some(step) = reader.deck.steps.last_mut()
    {
        step.prints.push(Print::Section { surface, when });
    }
}

pub(super) fn output(reader: &mut Reader, card: &Card) {
    if step::own_step(reader, card).is_none() {
        return;
    }
    if reader.position.asked.insert("OUTPUT".into())
        && let Some(step) = reader.deck.steps.last_mut()
    {
        step.output_every = None;
    }
    let when = when(reader, card);
    file(reader, card, when.clone());
    if let (Some(When::Every(n)), Some(step)) = (when, reader.deck.steps.last_mut()) {
        step.output_every = Some(step.output_every.map_or(n, |e| e.min(n)));
    }
}

/// What a card asks for in the `.frd` file. A card takes the place of those of its kind in earlier steps.
fn file(reader: &mut Reader, card: &Card, when: Option<When>) {
    let of = match card.keyword.as_str() {
        "NODEFILE" | "NODEOUTPUT" => FieldsOf::Nodes,
        "ELFILE" | "ELEMENTOUTPUT" => FieldsOf::Elements,
        "CONTACTFILE" | "CONTACTOUTPUT" => FieldsOf::Contact,
        _ => {
            reader.position.history = Some(card.has("HISTORY"));
            return;
        }
    };
    // Histories are of single nodes and elements, which are no fields.
    if reader.position.history == Some(true) {
        return;
    }
    if reader.position.asked.insert(format!("FILE {of:?}"))
        && let Some(step) = reader.deck.steps.last_mut()
    {
        step.filed.retain(|f| f.of != of);
    }
    let quantities = quantities(reader, card, of);
    if reader.deck.output.frd.is_none() {
        // In CalculiX cards with OUTPUT are for a binary file; in Abaqus, where they stand under *OUTPUT, they say nothing of it.
        let binary = card.keyword.ends_with("OUTPUT") && reader.position.history.is_none();
        reader.deck.output.frd = Some(match binary {
            true => Encoding::Binary,
            false => Encoding::Text,
        });
    }
    if let (Some(when), Some(step)) = (when, reader.deck.steps.last_mut()) {
        step.filed.push(Filed {
            of,
            quantities,
            when,
        });
    }
}

/// The quantities of a card that are written; notes on the others.
fn quantities(reader: &mut Reader, card: &Card, of: FieldsOf) -> Vec<Quantity> {
    let mut out = Vec::new();
    let asked = keys(card);
    for key in &asked {
        match quantity(of, key) {
            Some(quantity) => out.push(quantity),
            None => {
                let message = format!(
                    "{}: {} is left out: it is not written to the .frd file",
                    card.written,
                    clip(key)
                );
                reader.messages.note(card.place, message);
            }
        }
    }
    // A choice of Abaqus's own, such as VARIABLE=PRESELECT.
    if asked.is_empty() && reader.position.history.is_some() {
        out.extend(match of {
            FieldsOf::Nodes => vec![Quantity::Displacement, Quantity::Force],
            FieldsOf::Elements => vec![Quantity::Stress, Quantity::Strain],
            FieldsOf::Contact => vec![Quantity::Contact],
        });
    }
    out
}

/// The block of the `.frd` file that has what a key asks for. Gap and pressure of contact are one block, as in CalculiX.
fn quantity(of: FieldsOf, key: &str) -> Option<Quantity> {
    Some(match (of, key) {
        (FieldsOf::Nodes, "U") => Quantity::Displacement,
        (FieldsOf::Nodes, "V") => Quantity::Velocity,
        (FieldsOf::Nodes, "RF") => Quantity::Force,
        (FieldsOf::Nodes, "NT" | "NT11") => Quantity::Temperature,
        (FieldsOf::Elements, "S") => Quantity::Stress,
        (FieldsOf::Elements, "E" | "LE") => Quantity::Strain,
        (FieldsOf::Elements, "ENER") => Quantity::Energy,
        (FieldsOf::Contact, "CDIS" | "CDISP" | "CSTR" | "CSTRESS") => Quantity::Contact,
        _ => return None,
    })
}
