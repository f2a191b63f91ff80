//! What holds at the start, and temperatures of any time.

use super::reader::Reader;
use crate::card::{Card, Data};
use crate::deck::{Action, InitialCondition, Temperature};
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
            self.deck.start.initial.push(InitialCondition {
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
            if let Some(temperature) = self.warm(data) {
                self.deck.start.temperatures.push(temperature);
            }
        }
    }

    pub(super) fn temperature(&mut self, card: &Card) {
        if self.own_step(card).is_none() {
            return;
        }
        self.operation(card, Action::ClearTemperatures);
        let amplitude = self.course(card);
        for data in &card.data {
            if let Some(of) = self.warm(data) {
                let amplitude = amplitude.clone();
                self.act(Action::Temperature { of, amplitude });
            }
        }
    }

    /// Nodes and their temperature.
    fn warm(&mut self, data: &Data) -> Option<Temperature> {
        let target = self.target(data, 0)?;
        let value = self.number(data, 1, 0.0);
        if data.fields.len() > 2 && self.number(data, 2, 0.0) != 0.0 {
            self.error(
                data.place,
                "temperatures do not vary across a section",
                "write node or set, temperature",
            );
        }
        Some(Temperature {
            target,
            value,
            place: data.place,
        })
    }
}
