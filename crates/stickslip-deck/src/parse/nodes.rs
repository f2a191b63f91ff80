//! Nodes, their axes and normals.

use stickslip::math::{cross, sub};

use super::fields::{Nodes, line, named_nodes, number, own_number, required};
use super::messages::Messages;
use super::reader::Reader;
use super::sets::add;
use crate::axes::{frame, polar};
use crate::card::Card;
use crate::deck::Transform;
use crate::motion::Motion;

pub(super) fn nodes(reader: &mut Reader, card: &Card) {
    let round = match card.get("SYSTEM") {
        None | Some("" | "R") => false,
        Some("C") => true,
        Some(_) => {
            let message = "*NODE: only rectangular and cylindrical coordinates are read";
            let help = "give x, y and z";
            reader.messages.error(card.place, message, help);
            false
        }
    };
    let mut set = Vec::new();
    for data in &card.data {
        let Some(id) = own_number(reader, data) else {
            reader.messages.unread = true;
            continue;
        };
        let x = [1, 2, 3].map(|i| number(&mut reader.messages, data, i, 0.0));
        let x = if round { polar(x) } else { x };
        let x = reader.scope.motion().point(reader.system.point(x));
        if x.iter().any(|c| !c.is_finite()) {
            let message = "the node lies too far away to be moved or turned";
            let help =
                "write the mesh near the origin, in units in which it is neither huge nor tiny";
            reader.messages.error(data.place, message, help);
            reader.messages.unread = true;
            continue;
        }
        if let Some(before) = reader.deck.nodes.insert(id, x)
            && before != x
        {
            let message = format!(
                "node {} is given twice; the last one counts",
                reader.scope.label(id)
            );
            reader.messages.warn(data.place, message, "");
        }
        set.push(id);
    }
    if let Some(name) = card.get("NSET") {
        let name = reader.scope.scoped(name);
        add(reader.deck.node_sets.entry(name).or_default(), set);
    }
}

/// Axes for the coordinates of the nodes that follow: origin, a point on x, a point in the plane of x and y. Without lines they are the global ones.
pub(super) fn system(reader: &mut Reader, card: &Card) {
    let messages = &mut reader.messages;
    reader.system = Motion::NONE;
    let Some(first) = card.data.first() else {
        return;
    };
    let a = [0, 1, 2].map(|i| number(messages, first, i, 0.0));
    if first.fields.len() <= 3 {
        reader.system = Motion::by(a);
        return;
    }
    let b = [3, 4, 5].map(|i| number(messages, first, i, 0.0));
    let x = sub(b, a);
    let y = match card.data.get(1) {
        Some(second) => sub([0, 1, 2].map(|i| number(messages, second, i, 0.0)), a),
        // The local z axis is the global one.
        None => cross([0.0, 0.0, 1.0], x),
    };
    let beyond = card
        .data
        .get(2)
        .or(card.data.get(1).filter(|d| d.fields.len() > 3));
    match (frame(x, y), beyond) {
        (Some(axes), None) => reader.system = Motion::from_axes(axes, a),
        (None, _) => messages.error(
            first.place,
            "*SYSTEM: the points do not span a plane",
            "write the origin and a point on the x axis, and in the next line a point in the xy plane beside it",
        ),
        (_, Some(more)) => messages.error(
            more.place,
            "*SYSTEM: this line is not read",
            "the lines are: ax, ay, az, bx, by, bz; cx, cy, cz",
        ),
    }
}

/// Normals of nodes are for shells and beams, unless they are those of contact.
pub(super) fn normal(messages: &mut Messages, card: &Card) {
    match card.get("TYPE").unwrap_or("ELEMENT") {
        "CONTACTSURFACE" => messages.error(
            card.place,
            "normals of contact surfaces are those of their faces",
            "leave *NORMAL, TYPE=CONTACT SURFACE out, or refine the mesh",
        ),
        _ => messages.note(
            card.place,
            format!(
                "{} is left out: normals at nodes are for shells and beams",
                card.written
            ),
        ),
    }
}

pub(super) fn transform(reader: &mut Reader, card: &Card) {
    let messages = &mut reader.messages;
    let Some(set) = required(messages, card, "NSET") else {
        return;
    };
    let cylindrical = match card.get("TYPE").unwrap_or("R") {
        "R" | "" => false,
        "C" => true,
        other => {
            let message = format!("*TRANSFORM of type {other} is not supported");
            let help = "types are R (rectangular) and C (cylindrical)";
            messages.error(card.place, message, help);
            return;
        }
    };
    let Some(data) = line(messages, card) else {
        return;
    };
    let v: Vec<f64> = (0..6).map(|i| number(messages, data, i, 0.0)).collect();
    // Those of a part go with its instance: points of an axis move, directions turn.
    let motion = reader.scope.motion();
    let [a, b] = [[v[0], v[1], v[2]], [v[3], v[4], v[5]]].map(|x| match cylindrical {
        true => motion.point(x),
        false => motion.vector(x),
    });
    let transform = Transform { cylindrical, a, b };
    let nodes = match named_nodes(reader, &set, reader.scope.scoped(&set)) {
        Nodes::One(n) | Nodes::Absent(n) => vec![n],
        Nodes::Set(name) => reader.deck.node_sets[&name].clone(),
        Nodes::NoSet => {
            let message = format!("there is no set of nodes {set}");
            let help = "*NSET must stand before *TRANSFORM";
            reader.messages.error(card.place, message, help);
            return;
        }
    };
    for n in nodes {
        reader.deck.properties.transforms.insert(n, transform);
    }
}
