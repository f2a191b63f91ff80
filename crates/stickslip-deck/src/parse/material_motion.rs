//! `*MOTION`: material that runs through the mesh, as that of a disc under pads.

use super::reader::Reader;
use crate::card::{Card, Data};
use crate::deck::{Action, MaterialMotion, MaterialVelocity};
use crate::text::clip;

impl Reader<'_> {
    pub(super) fn material_motion(&mut self, card: &Card) {
        if self.own_step(card).is_none() {
            return;
        }
        if let Some(other) = card.get("TYPE").filter(|t| *t != "VELOCITY") {
            let message = format!("*MOTION, TYPE={} is not supported", clip(other));
            let help = "write TYPE=VELOCITY: it says how fast surfaces slide, and displacements are given by *BOUNDARY";
            return self.error(card.place, message, help);
        }
        let (turns, moves) = (card.has("ROTATION"), card.has("TRANSLATION"));
        if turns && moves {
            let message = "*MOTION is a ROTATION or a TRANSLATION, not both";
            return self.error(card.place, message, "write a card for each");
        }
        for data in &card.data {
            let Some(target) = self.target(data, 0) else {
                continue;
            };
            let velocity = match turns {
                true => self.rotation(card, data),
                false => self.translation(card, data),
            };
            if let Some(velocity) = velocity {
                let place = data.place;
                self.act(Action::Motion(MaterialMotion {
                    target,
                    velocity,
                    place,
                }));
            }
        }
    }

    fn translation(&mut self, card: &Card, data: &Data) -> Option<MaterialVelocity> {
        self.only(
            card,
            usize::MAX,
            &[
                "node or set",
                "first direction",
                "last direction",
                "velocity",
            ],
        );
        let first = self.direction(data, 1, 3)?;
        let last = match data.fields.get(2).filter(|f| !f.is_empty()) {
            Some(_) => self.direction(data, 2, 3)?,
            None => first,
        };
        if last < first {
            let help = "write node or set, first direction, last direction, velocity";
            self.error(data.place, "the last direction is below the first", help);
            return None;
        }
        let value = self.number(data, 3, 0.0);
        Some(MaterialVelocity::Along((first..=last).collect(), value))
    }

    /// A line of a rotation: speed, a point of the axis, and in 3D another that it runs to.
    fn rotation(&mut self, card: &Card, data: &Data) -> Option<MaterialVelocity> {
        self.only(
            card,
            usize::MAX,
            &["node or set", "speed", "ax", "ay", "az", "bx", "by", "bz"],
        );
        let speed = self.number(data, 1, 0.0);
        let [a, b] = [2, 5].map(|first| [0, 1, 2].map(|i| self.number(data, first + i, 0.0)));
        let axis = match data.fields.len() > 4 {
            true => [0, 1, 2].map(|i| b[i] - a[i]),
            // In a plane the axis is across it.
            false => [0.0, 0.0, 1.0],
        };
        let length = axis.iter().map(|x| x * x).sum::<f64>().sqrt();
        if length == 0.0 {
            let help = "write node or set, speed, ax, ay, az, bx, by, bz";
            self.error(data.place, "the axis of the rotation has no length", help);
            return None;
        }
        let turning = axis.map(|x| speed * x / length);
        Some(MaterialVelocity::About(a, turning))
    }
}
