//! Interactions: pressure, friction and damping of contact.

use std::collections::BTreeSet;

use super::fields::parameter;
use super::reader::{Context, Reader};
use crate::card::Card;
use crate::deck::{Action, Behavior, Friction, Interaction};
use crate::text::{clip, number};

impl Reader<'_> {
    pub(super) fn interaction(&mut self, card: &Card) {
        let Some(name) = self.required(card, "NAME") else {
            return;
        };
        if let Some(data) = card.data.first()
            && !data.fields.is_empty()
            && self.number(data, 0, 1.0) != 1.0
        {
            self.error(
                data.place,
                "the thickness of an interaction is not supported",
                "contact acts on the faces as they are: leave the line out, or write 1.",
            );
        }
        let interaction = Interaction {
            place: card.place,
            ..Interaction::default()
        };
        if self
            .deck
            .contact
            .interactions
            .insert(name.clone(), interaction)
            .is_some()
        {
            self.error(
                card.place,
                format!("the surface interaction {name} is given twice"),
                "names are unique: blanks and case do not count",
            );
        }
        self.position.context = Context::Interaction(name);
    }

    pub(super) fn behavior(&mut self, card: &Card) {
        let kind = card.get("PRESSURE-OVERCLOSURE").unwrap_or("HARD");
        let behavior = match kind {
            "HARD" | "" => Some(self.hard(card)),
            "LINEAR" => self.linear(card),
            "EXPONENTIAL" => self.exponential(card),
            "TABULAR" => self.tabular(card),
            "TIED" => {
                self.only(card, 1, &["stiffness"]);
                let stiffness = card.data.first().map(|d| self.number(d, 0, 0.0));
                Some(Behavior::Tied(stiffness.filter(|k| *k > 0.0)))
            }
            other => {
                let message = format!("PRESSURE-OVERCLOSURE={} is not supported", clip(other));
                self.error(
                    card.place,
                    message,
                    "HARD, LINEAR, EXPONENTIAL, TABULAR and TIED are",
                );
                None
            }
        };
        let Some(behavior) = behavior else { return };
        match self.position.context.clone() {
            Context::Interaction(name) => {
                if let Some(i) = self.deck.contact.interactions.get_mut(&name) {
                    i.behavior = Some(behavior);
                }
            }
            Context::ChangeBehavior(name) => {
                if let Some(step) = self.deck.steps.last_mut() {
                    step.actions
                        .push(Action::ChangeBehavior(name, behavior, card.place));
                }
            }
            _ => self.error(
                card.place,
                "*SURFACE BEHAVIOR belongs to no interaction",
                "write it beneath *SURFACE INTERACTION",
            ),
        }
    }

    fn hard(&mut self, card: &Card) -> Behavior {
        if card.data.iter().any(|d| !d.fields.is_empty()) {
            self.note(
                card.place,
                "the data of hard contact are left out: it is exact here, without a penalty",
            );
        }
        Behavior::Hard
    }

    fn linear(&mut self, card: &Card) -> Option<Behavior> {
        let data = self.line(card)?;
        // Where CalculiX begins to look for contact is nothing that the pressure depends on.
        self.only(card, 1, &["slope", "tension", "clearance"]);
        let slope = self.number(data, 0, 0.0);
        if slope <= 0.0 {
            self.error(data.place, "the slope of the pressure over the overclosure must be above 0", "write it in the first field; in CalculiX 5 to 50 times Young's modulus is customary");
            return None;
        }
        Some(Behavior::Linear {
            slope,
            tension: self.number(data, 1, 0.0),
        })
    }

    fn exponential(&mut self, card: &Card) -> Option<Behavior> {
        let data = self.line(card)?;
        self.only(card, 1, &["c0", "p0"]);
        let (c0, p0) = (self.number(data, 0, 0.0), self.number(data, 1, 0.0));
        if c0 <= 0.0 || p0 <= 0.0 {
            self.error(
                data.place,
                "the clearance c0 and the pressure p0 must be above 0",
                "write c0, p0",
            );
            return None;
        }
        Some(Behavior::Exponential { c0, p0 })
    }

    fn tabular(&mut self, card: &Card) -> Option<Behavior> {
        let mut rows: Vec<[f64; 2]> = Vec::new();
        self.only(card, usize::MAX, &["pressure", "overclosure"]);
        for data in &card.data {
            let row = [self.number(data, 1, 0.0), self.number(data, 0, 0.0)];
            if rows
                .last()
                .is_some_and(|last| last[0] >= row[0] || last[1] > row[1])
            {
                self.error(
                    data.place,
                    "overclosures must increase and pressures must not fall",
                    "write pressure, overclosure",
                );
                return None;
            }
            rows.push(row);
        }
        let [first, .., last] = rows.as_slice() else {
            self.error(
                card.place,
                "the table needs two rows or more",
                "write pressure, overclosure",
            );
            return None;
        };
        if first[1] > 0.0 {
            self.error(
                card.data[0].place,
                format!(
                    "the table begins with a pressure of {}: it would act at any distance",
                    first[1]
                ),
                "let the first row have no pressure: 0., overclosure at which contact begins",
            );
            return None;
        }
        self.warn(
            card.place,
            format!(
                "beyond an overclosure of {} the pressure goes on with the slope of the last two rows; CalculiX keeps it at {}",
                last[0], last[1]
            ),
            "let the table reach as far as the surfaces may penetrate",
        );
        Some(Behavior::Tabular(rows))
    }

    /// Friction belongs to the interaction or change above it.
    fn give_friction(&mut self, card: &Card, friction: Friction) {
        match self.position.context.clone() {
            Context::Interaction(name) => {
                if let Some(i) = self.deck.contact.interactions.get_mut(&name) {
                    i.friction = Some(friction);
                }
            }
            Context::ChangeFriction(name) => {
                if let Some(step) = self.deck.steps.last_mut() {
                    step.actions
                        .push(Action::ChangeFriction(name, friction, card.place));
                }
            }
            _ => self.error(
                card.place,
                "*FRICTION belongs to no interaction",
                "write it beneath *SURFACE INTERACTION or *CHANGE FRICTION",
            ),
        }
    }

    pub(super) fn friction(&mut self, card: &Card) {
        let rough = card.has("ROUGH");
        let decaying = card.has("EXPONENTIALDECAY");
        let (mut v, mut table, mut plain) = ([0.0; 3], Vec::new(), false);
        if !rough {
            let Some(data) = self.line(card) else { return };
            v = [0, 1, 2].map(|i| self.number(data, i, 0.0));
            if decaying {
                self.only(
                    card,
                    1,
                    &["static coefficient", "kinetic coefficient", "decay"],
                );
            } else {
                table = self.friction_table(card);
                plain = table.is_empty() && data.fields.len() < 3;
            }
        }
        if v[0] < 0.0 || table.iter().any(|row| row[0] < 0.0) {
            self.error(
                card.place,
                "the coefficient of friction is negative",
                "write 0 or more",
            );
        }
        let decay = decaying.then_some([v[1], v[2]]);
        let slope = parameter(self, card, "SHEARTRACTIONSLOPE");
        // CalculiX's stiffness of sticking stands where Abaqus has the slip rate, which says nothing in a single row.
        let second = plain.then_some(v[1]);
        let friction = Friction {
            mu: v[0],
            stick: slope.or(second).filter(|k| *k > 0.0),
            cap: parameter(self, card, "TAUMAX"),
            decay,
            rough,
            table,
        };
        if friction.cap.is_some() && !friction.table.is_empty() {
            self.error(
                card.place,
                "*FRICTION, TAUMAX is not supported for coefficients that depend on slip rate or pressure",
                "let the coefficients of the table fall with the pressure as the limit does",
            );
        }
        self.give_friction(card, friction);
    }

    /// The rows of a coefficient that depends on slip rate or pressure; empty if it does not.
    pub(super) fn friction_table(&mut self, card: &Card) -> Vec<[f64; 3]> {
        let mut rows: Vec<[f64; 3]> = Vec::new();
        if card.data.len() < 2 {
            // One row says the same at every slip rate, pressure and temperature.
            return rows;
        }
        self.only(card, usize::MAX, &["coefficient", "slip rate", "pressure"]);
        for data in &card.data {
            let row = [0, 1, 2].map(|i| self.number(data, i, 0.0));
            if rows.iter().any(|r| r[1..] == row[1..]) {
                self.error(
                    data.place,
                    "there is a coefficient for this slip rate and pressure already",
                    "write coefficient, slip rate, pressure",
                );
            }
            rows.push(row);
        }
        let count = |k: usize| {
            let values: BTreeSet<u64> = rows.iter().map(|r| r[k].to_bits()).collect();
            values.len()
        };
        if count(1) * count(2) != rows.len() {
            self.error(
                card.place,
                "the table of coefficients has gaps",
                "give a coefficient for each slip rate at each pressure",
            );
        }
        rows
    }

    pub(super) fn contact_damping(&mut self, card: &Card) {
        if card
            .get("DEFINITION")
            .is_some_and(|d| d != "DAMPINGCOEFFICIENT")
        {
            self.error(
                card.place,
                "*CONTACT DAMPING: only DEFINITION=DAMPING COEFFICIENT is read",
                "give pressure per closing velocity",
            );
            return;
        }
        let Some(data) = self.line(card) else { return };
        let value = self.number(data, 0, 0.0);
        let tangent = parameter(self, card, "TANGENTFRACTION").unwrap_or(0.0);
        if tangent != 0.0 {
            self.error(
                card.place,
                "*CONTACT DAMPING, TANGENT FRACTION is not supported",
                "damping acts against approach only: write TANGENT FRACTION=0., or leave it out",
            );
        }
        match self.position.context.clone() {
            Context::Interaction(name) => {
                if let Some(i) = self.deck.contact.interactions.get_mut(&name) {
                    i.damping = Some([value, tangent]);
                }
            }
            _ => self.error(
                card.place,
                "*CONTACT DAMPING belongs to no interaction",
                "write it beneath *SURFACE INTERACTION",
            ),
        }
    }

    pub(super) fn change(&mut self, card: &Card, context: fn(String) -> Context) {
        let Some(name) = self.required(card, "INTERACTION") else {
            return;
        };
        if !self.position.in_step {
            self.error(
                card.place,
                format!("{} stands before the first step", card.written),
                "write it in the *STEP from which it holds",
            );
            return;
        }
        self.position.context = context(name);
    }

    /// It is an error if a card has more lines, or lines with more fields, than these.
    pub(super) fn only(&mut self, card: &Card, lines: usize, fields: &[&str]) {
        let means = |text: &String| !text.is_empty() && number(text) != Some(0.0);
        let beyond = card.data.iter().enumerate().find_map(|(i, data)| {
            let from = if i < lines { fields.len() } else { 0 };
            let at = from + data.fields.iter().skip(from).position(means)?;
            Some((data.place, at, data.fields[at].clone()))
        });
        if let Some((place, field, text)) = beyond {
            let message = format!(
                "{}: field {} of this line, `{}`, is not read",
                card.written,
                field + 1,
                clip(&text)
            );
            let one = if lines == 1 { ", in one line" } else { "" };
            self.error(
                place,
                message,
                &format!("the fields are: {}{one}", fields.join(", ")),
            );
        }
    }
}
