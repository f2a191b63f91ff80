//! What holds at the start.

use super::reader::Reader;
use crate::card::Card;
use crate::deck::{InitialCondition, Temperature};
use crate::text::clip;

impl Reader<'_> {
    pub(super) fn initial_conditions(&mut self, card: &Card) {
        let Some(kind) = self.required(card, "TYPE") else {
            return;
        };
        let velocity = match kind.as_str() {
            "VELOCITY" => true,
            "DISPLACEMENT" => false,
            "TEMPERATURE" => {
                self.initial_temperatures(card);
                return;
            }
            other => {
                let message = format!(
                    "*INITIAL CONDITIONS of type {} are not supported",
                    clip(other)
                );
                self.error(
                    card.place,
                    message,
                    "types are DISPLACEMENT, VELOCITY and TEMPERATURE",
                );
                return;
            }
        };
        for data in &card.data {
            let (Some(target), Some(component)) =
                (self.target(data, 0), self.direction(data, 1, 3))
            else {
                continue;
            };
            let value = self.number(data, 2, 0.0);
            self.deck.initial.push(InitialCondition {
                velocity,
                target,
                component,
                value,
                place: data.place,
            });
        }
    }

    pub(super) fn initial_temperatures(&mut self, card: &Card) {
        for data in &card.data {
            let Some(target) = self.target(data, 0) else {
                continue;
            };
            let value = self.number(data, 1, 0.0);
            if data.fields.len() > 2 && self.number(data, 2, 0.0) != 0.0 {
                self.error(
                    data.place,
                    "temperatures do not vary across a section",
                    "write node or set, temperature",
                );
            }
            self.deck.temperatures.push(Temperature {
                target,
                value,
                place: data.place,
            });
        }
    }
}
