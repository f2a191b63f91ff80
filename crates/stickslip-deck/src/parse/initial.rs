//! What holds at the start, and temperatures of any time.

use super::fields::{direction, number, required, target};
use super::reader::Reader;
use super::{loads, step};
use crate::card::{Card, Data};
use crate::deck::{Action, InitialCondition, Temperature};
use crate::text::clip;

pub(super) fn initial_conditions(reader: &mut Reader, card: &Card) {
    let Some(kind) = required(&mut reader.messages, card, "TYPE") else {
        return;
    };
    let velocity = match kind.as_str() {
        "VELOCITY" => true,
        "DISPLACEMENT" => false,
        "TEMPERATURE" => {
            initial_temperatures(reader, card);
            return;
        }
        other => {
            let message = format!(
                "*INITIAL CONDITIONS of type {} are not supported",
                clip(other)
            );
            let help = "types are DISPLACEMENT, VELOCITY and TEMPERATURE";
            reader.messages.error(card.place, message, help);
            return;
        }
    };
    for data in &card.data {
        let (Some(target), Some(component)) = (
            target(reader, data, 0),
            direction(&mut reader.messages, data, 1, 3),
        ) else {
            continue;
        };
        let value = number(&mut reader.messages, data, 2, 0.0);
        reader.deck.start.initial.push(InitialCondition {
            velocity,
            target,
            component,
            value,
            place: data.place,
        });
    }
}

pub(super) fn initial_temperatures(reader: &mut Reader, card: &Card) {
    for data in &card.data {
        if let Some(temperature) = warm(reader, data) {
            reader.deck.start.temperatures.push(temperature);
        }
    }
}

pub(super) fn temperature(reader: &mut Reader, card: &Card) {
    if step::own_step(reader, card).is_none() {
        return;
    }
    loads::operation(reader, card, Action::ClearTemperatures);
    let amplitude = loads::course(reader, card);
    for data in &card.data {
        if let Some(of) = warm(reader, data) {
            let amplitude = amplitude.clone();
            reader.deck.act(Action::Temperature { of, amplitude });
        }
    }
}

/// Nodes and their temperature.
fn warm(reader: &mut Reader, data: &Data) -> Option<Temperature> {
    let target = target(reader, data, 0)?;
    let messages = &mut reader.messages;
    let value = number(messages, data, 1, 0.0);
    if data.fields.len() > 2 && number(messages, data, 2, 0.0) != 0.0 {
        let message = "temperatures do not vary across a section";
        messages.error(data.place, message, "write node or set, temperature");
    }
    Some(Temperature {
        target,
        value,
        place: data.place,
    })
}
