//! What ties nodes together or acts between them: equations, rigid bodies, pretensions, springs; and masses.

use super::fields::{
    direction, elements_named, line, no_more, number, only, required, required_name, target, whole,
};
use super::reader::Reader;
use super::step;
use crate::card::Card;
use crate::deck::{Action, Equation, GapSection, Pretension, Rigid, SpringSection, Term};
use crate::text::clip;

pub(super) fn equation(reader: &mut Reader, card: &Card) {
    if card.has("REMOVE") || card.has("REMOVEALL") {
        remove_equations(reader, card);
        return;
    }
    if reader.position.in_step {
        let message = "equations begin before the first step";
        let help = "give *EQUATION before the first *STEP; *EQUATION, REMOVE in a step ends them";
        reader.messages.error(card.place, message, help);
        return;
    }
    let mut lines = card.data.iter();
    while let Some(data) = lines.next() {
        let Some(count) = whole(&mut reader.messages, data, 0) else {
            return;
        };
        let mut terms = Vec::new();
        while (terms.len() as u64) < count {
            let Some(line) = lines.next() else {
                let message = format!("the equation has {} of its {count} terms", terms.len());
                let help = "each term is node, direction, factor";
                reader.messages.error(data.place, message, help);
                return;
            };
            for k in (0..line.fields.len()).step_by(3) {
                let (Some(target), Some(component)) = (
                    target(reader, line, k),
                    direction(&mut reader.messages, line, k + 1, 6),
                ) else {
                    return;
                };
                let factor = number(&mut reader.messages, line, k + 2, 0.0);
                terms.push(Term {
                    target,
                    component,
                    factor,
                });
            }
        }
        if terms.len() as u64 != count {
            let message = format!("the equation has {} terms instead of {count}", terms.len());
            let help = "each term is node, direction, factor";
            reader.messages.error(data.place, message, help);
            return;
        }
        if terms.first().is_some_and(|t| t.factor == 0.0) {
            let message = "the first factor of the equation is zero";
            let help = "the first term is the one that the others determine";
            reader.messages.error(data.place, message, help);
        }
        reader.deck.connectors.equations.push(Equation {
            terms,
            place: data.place,
        });
    }
}

/// Equations that hold no longer from this step on.
fn remove_equations(reader: &mut Reader, card: &Card) {
    if step::own_step(reader, card).is_none() {
        return;
    }
    let all = card.has("REMOVEALL") || card.get("REMOVE") == Some("ALL");
    if all {
        only(&mut reader.messages, card, 0, &[]);
        reader.deck.act(Action::RemoveEquations {
            target: None,
            components: Vec::new(),
            place: card.place,
        });
        return;
    }
    if card.data.is_empty() {
        line(&mut reader.messages, card);
    }
    for data in &card.data {
        let (Some(target), Some(first)) = (
            target(reader, data, 0),
            direction(&mut reader.messages, data, 1, 3),
        ) else {
            continue;
        };
        let last = match data.fields.get(2).filter(|f| !f.is_empty()) {
            Some(_) => direction(&mut reader.messages, data, 2, 3).unwrap_or(first),
            None => first,
        };
        no_more(&mut reader.messages, data, 3, "*EQUATION, REMOVE");
        reader.deck.act(Action::RemoveEquations {
            target: Some(target),
            components: (first..=last).collect(),
            place: data.place,
        });
    }
}

pub(super) fn rigid_body(reader: &mut Reader, card: &Card) {
    if card.get("POSITION").is_some_and(|p| p != "INPUT") {
        let message = "*RIGID BODY: the reference node stays where it is";
        let help = "write POSITION=INPUT, and give the node the place that is meant";
        reader.messages.error(card.place, message, help);
    }
    let reference = single_node(reader, card, "REFNODE");
    let rotation = single_node(reader, card, "ROTNODE");
    let rigid = Rigid {
        elements: card.get("ELSET").map(|s| reader.scope.scoped(s)),
        nodes: card.get("NSET").map(|s| reader.scope.scoped(s)),
        reference,
        rotation,
        place: card.place,
    };
    reader.deck.connectors.rigid.push(rigid);
}

/// A parameter that names a node, by its number or by a set of one.
pub(super) fn single_node(reader: &mut Reader, card: &Card, name: &str) -> Option<u64> {
    let text = card.get(name)?;
    let of_set = |set: &Vec<u64>| match set.as_slice() {
        [one] => Some(*one),
        _ => None,
    };
    let set = || {
        reader
            .deck
            .node_sets
            .get(&reader.scope.scoped(text))
            .and_then(of_set)
    };
    let id = reader.scope.number_of(text).or_else(set);
    if id.is_none_or(|n| !reader.deck.nodes.contains_key(&n)) {
        let message = format!(
            "{}: {name} is {}, which is no node",
            card.written,
            clip(text)
        );
        let help = "give the number of a node that exists";
        reader.messages.error(card.place, message, help);
        return None;
    }
    id
}

pub(super) fn pretension(reader: &mut Reader, card: &Card) {
    let surface = required_name(reader, card, "SURFACE");
    if card.get("NODE").is_none() {
        required(&mut reader.messages, card, "NODE");
    }
    let node = single_node(reader, card, "NODE");
    let messages = &mut reader.messages;
    let mut normal = None;
    if let Some(data) = card.data.first() {
        let given: [f64; 3] = std::array::from_fn(|i| number(messages, data, i, 0.0));
        normal = (given != [0.0; 3]).then(|| reader.scope.motion().vector(given));
    }
    let (Some(surface), Some(node)) = (surface, node) else {
        return;
    };
    if reader.deck.pretension(node).is_some() {
        let message = format!("node {} has a pretension already", reader.scope.label(node));
        let help = "give every *PRE-TENSION SECTION a node of its own";
        messages.error(card.place, message, help);
    }
    reader.deck.connectors.pretensions.push(Pretension {
        surface,
        node,
        normal,
        place: card.place,
    });
}

/// Stiffnesses of springs, or coefficients of dashpots.
pub(super) fn spring(reader: &mut Reader, card: &Card) {
    let Some(set) = required_name(reader, card, "ELSET") else {
        return;
    };
    let damper = card.keyword == "DASHPOT";
    let (thing, constant) = match damper {
        true => ("a dashpot", "coefficient"),
        false => ("a spring", "stiffness"),
    };
    let kind = elements_named(reader, &set, &set, card.place)
        .first()
        .map(|e| reader.deck.elements[e].kind.clone());
    let messages = &mut reader.messages;
    // The first line has directions; for SPRINGA it is empty, and empty lines are not kept.
    let (mut directions, mut data) = (Vec::new(), card.data.as_slice());
    let along_axes = ["SPRING1", "SPRING2", "DASHPOT1", "DASHPOT2"];
    if kind.as_deref().is_some_and(|k| along_axes.contains(&k)) {
        let Some(line) = line(messages, card) else {
            return;
        };
        for i in 0..line.fields.len() {
            directions.extend(direction(messages, line, i, 3));
        }
        data = &data[1..];
    }
    // An empty line of directions has survived as one without fields.
    let mut data = data.iter().filter(|d| !d.fields.is_empty());
    let (line, more) = (data.next(), data.next());
    if let Some(more) = more {
        messages.error(
            more.place,
            format!("{thing} has one {constant}"),
            &format!("they are linear and depend on neither frequency nor temperature: give one {constant}"),
        );
    }
    let Some(line) = line else {
        messages.error(
            card.place,
            format!("{} has no {constant}", card.written),
            &format!("the line after the directions has the {constant}"),
        );
        return;
    };
    let stiffness = number(messages, line, 0, 0.0);
    let section = SpringSection {
        set,
        directions,
        stiffness,
        place: card.place,
    };
    match damper {
        true => reader.deck.connectors.dashpots.push(section),
        false => reader.deck.connectors.springs.push(section),
    }
}

pub(super) fn gap(reader: &mut Reader, card: &Card) {
    let Some(set) = required_name(reader, card, "ELSET") else {
        return;
    };
    elements_named(reader, &set, &set, card.place);
    let messages = &mut reader.messages;
    let Some(line) = line(messages, card) else {
        return;
    };
    let v: Vec<f64> = (0..7).map(|i| number(messages, line, i, 0.0)).collect();
    let given = [v[1], v[2], v[3]];
    let direction = stickslip::math::normalize(given).unwrap_or_default();
    let length = stickslip::math::norm(given);
    if length > 0.0 && (length - 1.0).abs() > 1e-3 {
        let message = format!(
            "the direction of the gap has the length {length:.4}: it is taken with length 1"
        );
        messages.warn(line.place, message, "write a direction of length 1");
    }
    if v[6] > 0.0 {
        let message = "the tension of open gaps is left out: force begins where a gap closes, and grows with the stiffness";
        let help = "leave the last field out, or make it small against the forces";
        messages.warn(line.place, message, help);
    }
    reader.deck.connectors.gaps.push(GapSection {
        set,
        clearance: v[0],
        direction,
        stiffness: Some(v[5]).filter(|k| *k > 0.0),
        place: card.place,
    });
}

pub(super) fn mass(reader: &mut Reader, card: &Card) {
    let Some(set) = required_name(reader, card, "ELSET") else {
        return;
    };
    elements_named(reader, &set, &set, card.place);
    let messages = &mut reader.messages;
    let Some(line) = line(messages, card) else {
        return;
    };
    let mass = number(messages, line, 0, 0.0);
    if mass < 0.0 {
        let message = "the mass is negative";
        messages.error(line.place, message, "write the mass of each point");
    }
    reader.deck.connectors.masses.push((set, mass, card.place));
}
