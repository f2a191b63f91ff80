//! What ties many nodes together: couplings to a reference node, and multi-point constraints.

use super::fields::{direction, elements_named, number, required, required_name, target};
use super::links;
use super::messages::Messages;
use super::reader::Reader;
use crate::card::{Card, Data};
use crate::deck::{MultiPoint, NodeCoupling, Target, Tied, Way};
use crate::text::{self, clip, squeeze};

/// Types of `*MPC`.
const TYPES: [&str; 8] = [
    "BEAM", "DIST", "LINK", "MEANROT", "PIN", "PLANE", "STRAIGHT", "TIE",
];

pub(super) fn coupling(reader: &mut Reader, card: &Card) {
    if required(&mut reader.messages, card, "REFNODE").is_none() {
        return;
    }
    let Some(surface) = required_name(reader, card, "SURFACE") else {
        return;
    };
    let Some(reference) = links::single_node(reader, card, "REFNODE") else {
        return;
    };
    let count = reader.deck.connectors.couplings.len() + 1;
    let name = card.get("CONSTRAINTNAME");
    reader.deck.connectors.couplings.push(NodeCoupling {
        name: name.map_or_else(|| format!("COUPLING-{count}"), str::to_string),
        reference,
        tied: Tied::Surface(surface),
        way: None,
        components: [false; 6],
        orientation: card.get("ORIENTATION").map(|o| reader.scope.scoped(o)),
        place: card.place,
    });
}

/// `*KINEMATIC` or `*DISTRIBUTING` beneath a `*COUPLING`.
pub(super) fn way(reader: &mut Reader, card: &Card, way: Way) {
    let messages = &mut reader.messages;
    if way == Way::Distributing
        && let Some(method) = card.get("WEIGHTINGMETHOD")
        && method != "UNIFORM"
    {
        let message = format!("weights of the method {} are not known", clip(method));
        let help = "leave WEIGHTING METHOD out: nodes count by their area";
        messages.error(card.place, message, help);
    }
    let mut components = [card.data.is_empty(); 6];
    for data in &card.data {
        let Some(range) = directions(messages, data, 0) else {
            return;
        };
        components[range].fill(true);
    }
    let last = reader.deck.connectors.couplings.last_mut();
    match last.filter(|c| c.way.is_none()) {
        Some(coupling) => {
            coupling.way = Some(way);
            coupling.components = components;
        }
        None => messages.error(
            card.place,
            format!("{} belongs to no *COUPLING", card.written),
            "it stands right after the *COUPLING whose kind it is",
        ),
    }
}

/// Directions from one field to the next, from 0; the last is the first if it is not given.
fn directions(
    messages: &mut Messages,
    data: &Data,
    field: usize,
) -> Option<std::ops::Range<usize>> {
    let first = direction(messages, data, field, 6)?;
    let last = match data.fields.get(field + 1).filter(|f| !f.is_empty()) {
        Some(_) => direction(messages, data, field + 1, 6)?,
        None => first,
    };
    if last < first {
        let message = "the last direction lies before the first";
        messages.error(data.place, message, "write first direction, last direction");
        return None;
    }
    Some(first..last + 1)
}

pub(super) fn kinematic_coupling(reader: &mut Reader, card: &Card) {
    if required(&mut reader.messages, card, "REFNODE").is_none() {
        return;
    }
    let Some(reference) = links::single_node(reader, card, "REFNODE") else {
        return;
    };
    for data in &card.data {
        let Some(target) = target(reader, data, 0) else {
            return;
        };
        let range = match data.fields.get(1).filter(|f| !f.is_empty()) {
            None => 0..6,
            Some(_) => match directions(&mut reader.messages, data, 1) {
                Some(range) => range,
                None => return,
            },
        };
        let mut components = [false; 6];
        components[range].fill(true);
        reader.deck.connectors.couplings.push(NodeCoupling {
            name: format!("COUPLING-{}", reader.deck.connectors.couplings.len() + 1),
            reference,
            tied: Tied::Nodes(vec![(target, 1.0)]),
            way: Some(Way::Kinematic),
            components,
            orientation: card.get("ORIENTATION").map(|o| reader.scope.scoped(o)),
            place: data.place,
        });
    }
}

pub(super) fn distributing_coupling(reader: &mut Reader, card: &Card) {
    let Some(set) = required_name(reader, card, "ELSET") else {
        return;
    };
    let elements = elements_named(reader, &set, &set, card.place);
    let node = |e: &u64| {
        let e = &reader.deck.elements[e];
        e.kind.starts_with("DCOUP").then(|| e.nodes[0])
    };
    let [Some(reference)] = elements.iter().map(node).collect::<Vec<_>>()[..] else {
        let message = format!("the set {} is not one element of type DCOUP3D", clip(&set));
        let help = "the node of that element is the reference node";
        reader.messages.error(card.place, message, help);
        return;
    };
    let mut nodes = Vec::new();
    for data in &card.data {
        let Some(target) = target(reader, data, 0) else {
            return;
        };
        let weight = number(&mut reader.messages, data, 1, 1.0);
        if weight < 0.0 {
            let message = "the weight is negative";
            let help = "weights are 0 or more";
            reader.messages.error(data.place, message, help);
        }
        nodes.push((target, weight));
    }
    reader.deck.connectors.couplings.push(NodeCoupling {
        name: set,
        reference,
        tied: Tied::Nodes(nodes),
        way: Some(Way::Distributing),
        components: [true; 6],
        orientation: None,
        place: card.place,
    });
}

pub(super) fn multi_point(reader: &mut Reader, card: &Card) {
    for data in &card.data {
        let first = squeeze(data.fields.first().map_or("", String::as_str));
        let goes_on = first.is_empty() || text::whole(&first).is_some() || first == "0";
        let zero = first.is_empty() || first == "0";
        let mut nodes = Vec::new();
        let from = usize::from(!goes_on || zero);
        for field in from..data.fields.len() {
            let text = &data.fields[field];
            if text.is_empty() || text == "0" {
                continue;
            }
            match target(reader, data, field) {
                Some(Target::One(n)) if reader.deck.nodes.contains_key(&n) => nodes.push(n),
                Some(Target::Set(s)) if reader.deck.node_sets.contains_key(&s) => {
                    nodes.extend(&reader.deck.node_sets[&s]);
                }
                _ => {
                    let message = format!("there is no node and no set of nodes {}", clip(text));
                    let help = "write the type, then nodes or sets of nodes";
                    reader.messages.error(data.place, message, help);
                    return;
                }
            }
        }
        if goes_on {
            match reader.deck.connectors.constraints.last_mut() {
                Some(last) if last.place.line >= card.place.line => last.nodes.extend(nodes),
                _ => reader.messages.error(
                    data.place,
                    "the *MPC has no type",
                    "write the type, then nodes",
                ),
            }
            continue;
        }
        if !TYPES.contains(&first.as_str()) {
            reader.messages.error(
                data.place,
                format!("*MPC of type {} is not supported", clip(&first)),
                &format!(
                    "types are {}; *EQUATION says anything linear",
                    TYPES.join(", ")
                ),
            );
            continue;
        }
        reader.deck.connectors.constraints.push(MultiPoint {
            kind: first,
            nodes,
            place: data.place,
        });
    }
}
