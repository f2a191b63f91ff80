//! Interactions: pressure, friction and damping of contact.

use std::collections::BTreeSet;

use super::fields::{line, number, only, parameter, required};
use super::messages::Messages;
use super::reader::{Context, Reader};
use crate::card::Card;
use crate::deck::{Action, Behavior, Friction, Interaction};
use crate::text::clip;

pub(super) fn interaction(reader: &mut Reader, card: &Card) {
    let messages = &mut reader.messages;
    let Some(name) = required(messages, card, "NAME") else {
        return;
    };
    if let Some(data) = card.data.first()
        && !data.fields.is_empty()
        && number(messages, data, 0, 1.0) != 1.0
    {
        let message = "the thickness of an interaction is not supported";
        let help = "contact acts on the faces as they are: leave the line out, or write 1.";
        messages.error(data.place, message, help);
    }
    let interaction = Interaction {
        place: card.place,
        ..Interaction::default()
    };
    if reader
        .deck
        .contact
        .interactions
        .insert(name.clone(), interaction)
        .is_some()
    {
        let message = format!("the surface interaction {name} is given twice");
        let help = "names are unique: blanks and case do not count";
        messages.error(card.place, message, help);
    }
    reader.position.context = Context::Interaction(name);
}

pub(super) fn behavior(reader: &mut Reader, card: &Card) {
    let messages = &mut reader.messages;
    let kind = card.get("PRESSURE-OVERCLOSURE").unwrap_or("HARD");
    let behavior = match kind {
        "HARD" | "" => Some(hard(messages, card)),
        "LINEAR" => linear(messages, card),
        "EXPONENTIAL" => exponential(messages, card),
        "TABULAR" => tabular(messages, card),
        "TIED" => {
            only(messages, card, 1, &["stiffness"]);
            let stiffness = card.data.first().map(|d| number(messages, d, 0, 0.0));
            Some(Behavior::Tied(stiffness.filter(|k| *k > 0.0)))
        }
        other => {
            let message = format!("PRESSURE-OVERCLOSURE={} is not supported", clip(other));
            let help = "HARD, LINEAR, EXPONENTIAL, TABULAR and TIED are";
            messages.error(card.place, message, help);
            None
        }
    };
    let Some(behavior) = behavior else { return };
    match reader.position.context.clone() {
        Context::Interaction(name) => {
            if let Some(i) = reader.deck.contact.interactions.get_mut(&name) {
                i.behavior = Some(behavior);
            }
        }
        Context::ChangeBehavior(name) => {
            if let Some(step) = reader.deck.steps.last_mut() {
                step.actions
                    .push(Action::ChangeBehavior(name, behavior, card.place));
            }
        }
        _ => messages.error(
            card.place,
            "*SURFACE BEHAVIOR belongs to no interaction",
            "write it beneath *SURFACE INTERACTION",
        ),
    }
}

fn hard(messages: &mut Messages, card: &Card) -> Behavior {
    if card.data.iter().any(|d| !d.fields.is_empty()) {
        messages.note(
            card.place,
            "the data of hard contact are left out: it is exact here, without a penalty",
        );
    }
    Behavior::Hard
}

fn linear(messages: &mut Messages, card: &Card) -> Option<Behavior> {
    let data = line(messages, card)?;
    // Where CalculiX begins to look for contact is nothing that the pressure depends on.
    only(messages, card, 1, &["slope", "tension", "clearance"]);
    let slope = number(messages, data, 0, 0.0);
    if slope <= 0.0 {
        let message = "the slope of the pressure over the overclosure must be above 0";
        let help =
            "write it in the first field; in CalculiX 5 to 50 times Young's modulus is customary";
        messages.error(data.place, message, help);
        return None;
    }
    Some(Behavior::Linear {
        slope,
        tension: number(messages, data, 1, 0.0),
    })
}

fn exponential(messages: &mut Messages, card: &Card) -> Option<Behavior> {
    let data = line(messages, card)?;
    only(messages, card, 1, &["c0", "p0"]);
    let (c0, p0) = (
        number(messages, data, 0, 0.0),
        number(messages, data, 1, 0.0),
    );
    if c0 <= 0.0 || p0 <= 0.0 {
        let message = "the clearance c0 and the pressure p0 must be above 0";
        messages.error(data.place, message, "write c0, p0");
        return None;
    }
    Some(Behavior::Exponential { c0, p0 })
}

fn tabular(messages: &mut Messages, card: &Card) -> Option<Behavior> {
    let mut rows: Vec<[f64; 2]> = Vec::new();
    only(messages, card, usize::MAX, &["pressure", "overclosure"]);
    for data in &card.data {
        let row = [
            number(messages, data, 1, 0.0),
            number(messages, data, 0, 0.0),
        ];
        if rows
            .last()
            .is_some_and(|last| last[0] >= row[0] || last[1] > row[1])
        {
            let message = "overclosures must increase and pressures must not fall";
            messages.error(data.place, message, "write pressure, overclosure");
            return None;
        }
        rows.push(row);
    }
    let [first, .., last] = rows.as_slice() else {
        let message = "the table needs two rows or more";
        messages.error(card.place, message, "write pressure, overclosure");
        return None;
    };
    if first[1] > 0.0 {
        let message = format!(
            "the table begins with a pressure of {}: it would act at any distance",
            first[1]
        );
        let help = "let the first row have no pressure: 0., overclosure at which contact begins";
        messages.error(card.data[0].place, message, help);
        return None;
    }
    let message = format!(
        "beyond an overclosure of {} the pressure goes on with the slope of the last two rows; CalculiX keeps it at {}",
        last[0], last[1]
    );
    let help = "let the table reach as far as the surfaces may penetrate";
    messages.warn(card.place, message, help);
    Some(Behavior::Tabular(rows))
}

/// Friction belongs to the interaction or change above it.
fn give_friction(reader: &mut Reader, card: &Card, friction: Friction) {
    match reader.position.context.clone() {
        Context::Interaction(name) => {
            if let Some(i) = reader.deck.contact.interactions.get_mut(&name) {
                i.friction = Some(friction);
            }
        }
        Context::ChangeFriction(name) => {
            if let Some(step) = reader.deck.steps.last_mut() {
                step.actions
                    .push(Action::ChangeFriction(name, friction, card.place));
            }
        }
        _ => reader.messages.error(
            card.place,
            "*FRICTION belongs to no interaction",
            "write it beneath *SURFACE INTERACTION or *CHANGE FRICTION",
        ),
    }
}

pub(super) fn friction(reader: &mut Reader, card: &Card) {
    let messages = &mut reader.messages;
    let rough = card.has("ROUGH");
    let decaying = card.has("EXPONENTIALDECAY");
    let (mut v, mut table, mut plain) = ([0.0; 3], Vec::new(), false);
    if !rough {
        let Some(data) = line(messages, card) else {
            return;
        };
        v = [0, 1, 2].map(|i| number(messages, data, i, 0.0));
        if decaying {
            only(
                messages,
                card,
                1,
                &["static coefficient", "kinetic coefficient", "decay"],
            );
        } else {
            table = friction_table(messages, card);
            plain = table.is_empty() && data.fields.len() < 3;
        }
    }
    if v[0] < 0.0 || table.iter().any(|row| row[0] < 0.0) {
        let message = "the coefficient of friction is negative";
        messages.error(card.place, message, "write 0 or more");
    }
    let decay = decaying.then_some([v[1], v[2]]);
    let slope = parameter(messages, card, "SHEARTRACTIONSLOPE");
    // CalculiX's stiffness of sticking stands where Abaqus has the slip rate, which says nothing in a single row.
    let second = plain.then_some(v[1]);
    let friction = Friction {
        mu: v[0],
        stick: slope.or(second).filter(|k| *k > 0.0),
        cap: parameter(messages, card, "TAUMAX"),
        decay,
        rough,
        table,
    };
    if friction.cap.is_some() && !friction.table.is_empty() {
        let message = "*FRICTION, TAUMAX is not supported for coefficients that depend on slip rate or pressure";
        let help = "let the coefficients of the table fall with the pressure as the limit does";
        messages.error(card.place, message, help);
    }
    give_friction(reader, card, friction);
}

/// The rows of a coefficient that depends on slip rate or pressure; empty if it does not.
pub(super) fn friction_table(messages: &mut Messages, card: &Card) -> Vec<[f64; 3]> {
    let mut rows: Vec<[f64; 3]> = Vec::new();
    if card.data.len() < 2 {
        // One row says the same at every slip rate, pressure and temperature.
        return rows;
    }
    only(
        messages,
        card,
        usize::MAX,
        &["coefficient", "slip rate", "pressure"],
    );
    for data in &card.data {
        let row = [0, 1, 2].map(|i| number(messages, data, i, 0.0));
        if rows.iter().any(|r| r[1..] == row[1..]) {
            let message = "there is a coefficient for this slip rate and pressure already";
            let help = "write coefficient, slip rate, pressure";
            messages.error(data.place, message, help);
        }
        rows.push(row);
    }
    let count = |k: usize| {
        let values: BTreeSet<u64> = rows.iter().map(|r| r[k].to_bits()).collect();
        values.len()
    };
    if count(1) * count(2) != rows.len() {
        let help = "give a coefficient for each slip rate at each pressure";
        messages.error(card.place, "the table of coefficients has gaps", help);
    }
    rows
}

pub(super) fn contact_damping(reader: &mut Reader, card: &Card) {
    let messages = &mut reader.messages;
    if card
        .get("DEFINITION")
        .is_some_and(|d| d != "DAMPINGCOEFFICIENT")
    {
        let message = "*CONTACT DAMPING: only DEFINITION=DAMPING COEFFICIENT is read";
        messages.error(card.place, message, "give pressure per closing velocity");
        return;
    }
    let Some(data) = line(messages, card) else {
        return;
    };
    let value = number(messages, data, 0, 0.0);
    let tangent = parameter(messages, card, "TANGENTFRACTION").unwrap_or(0.0);
    if tangent != 0.0 {
        let message = "*CONTACT DAMPING, TANGENT FRACTION is not supported";
        let help = "damping acts against approach only: write TANGENT FRACTION=0., or leave it out";
        messages.error(card.place, message, help);
    }
    match reader.position.context.clone() {
        Context::Interaction(name) => {
            if let Some(i) = reader.deck.contact.interactions.get_mut(&name) {
                i.damping = Some([value, tangent]);
            }
        }
        _ => messages.error(
            card.place,
            "*CONTACT DAMPING belongs to no interaction",
            "write it beneath *SURFACE INTERACTION",
        ),
    }
}

pub(super) fn change(reader: &mut Reader, card: &Card, context: fn(String) -> Context) {
    let messages = &mut reader.messages;
    let Some(name) = required(messages, card, "INTERACTION") else {
        return;
    };
    if !reader.position.in_step {
        let message = format!("{} stands before the first step", card.written);
        let help = "write it in the *STEP from which it holds";
        messages.error(card.place, message, help);
        return;
    }
    reader.position.context = context(name);
}
