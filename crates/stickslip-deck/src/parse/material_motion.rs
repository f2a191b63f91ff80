//! `*MOTION`: material that runs through the mesh, as that of a disc under pads.

use super::fields::{direction, number, only, target};
use super::messages::Messages;
use super::reader::Reader;
use super::step;
use crate::card::{Card, Data};
use crate::deck::{Action, MaterialMotion, MaterialVelocity};
use crate::text::clip;

pub(super) fn material_motion(reader: &mut Reader, card: &Card) {
    if step::own_step(reader, card).is_none() {
        return;
    }
    if let Some(other) = card.get("TYPE").filter(|t| *t != "VELOCITY") {
        let message = format!("*MOTION, TYPE={} is not supported", clip(other));
        let help = "write TYPE=VELOCITY: it says how fast surfaces slide, and displacements are given by *BOUNDARY";
        return reader.messages.error(card.place, message, help);
    }
    let (turns, moves) = (card.has("ROTATION"), card.has("TRANSLATION"));
    if turns && moves {
        let message = "*MOTION is a ROTATION or a TRANSLATION, not both";
        return reader
            .messages
            .error(card.place, message, "write a card for each");
    }
    for data in &card.data {
        let Some(target) = target(reader, data, 0) else {
            continue;
        };
        let velocity = match turns {
            true => rotation(&mut reader.messages, card, data),
            false => translation(&mut reader.messages, card, data),
        };
        if let Some(velocity) = velocity {
            let place = data.place;
            reader.deck.act(Action::Motion(MaterialMotion {
                target,
                velocity,
                place,
            }));
        }
    }
}

fn translation(messages: &mut Messages, card: &Card, data: &Data) -> Option<MaterialVelocity> {
    only(
        messages,
        card,
        usize::MAX,
        &[
            "node or set",
            "first direction",
            "last direction",
            "velocity",
        ],
    );
    let first = direction(messages, data, 1, 3)?;
    let last = match data.fields.get(2).filter(|f| !f.is_empty()) {
        Some(_) => direction(messages, data, 2, 3)?,
        None => first,
    };
    if last < first {
        let help = "write node or set, first direction, last direction, velocity";
        messages.error(data.place, "the last direction is below the first", help);
        return None;
    }
    let value = number(messages, data, 3, 0.0);
    Some(MaterialVelocity::Along((first..=last).collect(), value))
}

/// A line of a rotation: speed, a point of the axis, and in 3D another that it runs to.
fn rotation(messages: &mut Messages, card: &Card, data: &Data) -> Option<MaterialVelocity> {
    only(
        messages,
        card,
        usize::MAX,
        &["node or set", "speed", "ax", "ay", "az", "bx", "by", "bz"],
    );
    let speed = number(messages, data, 1, 0.0);
    let [a, b] = [2, 5].map(|first| [0, 1, 2].map(|i| number(messages, data, first + i, 0.0)));
    let axis = match data.fields.len() > 4 {
        true => [0, 1, 2].map(|i| b[i] - a[i]),
        // In a plane the axis is across it.
        false => [0.0, 0.0, 1.0],
    };
    let length = axis.iter().map(|x| x * x).sum::<f64>().sqrt();
    if length == 0.0 {
        let help = "write node or set, speed, ax, ay, az, bx, by, bz";
        messages.error(data.place, "the axis of the rotation has no length", help);
        return None;
    }
    let turning = axis.map(|x| speed * x / length);
    Some(MaterialVelocity::About(a, turning))
}
