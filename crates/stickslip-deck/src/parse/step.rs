//! Steps and how they are solved.

use super::fields::{number, parameter};
use super::messages::Messages;
use super::reader::Reader;
use crate::card::{Card, Place};
use crate::deck::{Deck, Procedure, Step};
use crate::text::clip;

pub(super) fn heading(deck: &mut Deck, card: &Card) {
    let first = card.data.first().map(|d| d.fields.join(", "));
    deck.output.title = deck.output.title.take().or(first);
}

pub(super) fn step(reader: &mut Reader, card: &Card) {
    if reader.position.in_step {
        step_without_procedure(reader);
        let message = "the step before has no *END STEP";
        reader.messages.warn(card.place, message, "");
    }
    let messages = &mut reader.messages;
    let nonlinear = card.get("NLGEOM").is_some_and(|v| v != "NO");
    if nonlinear && !reader.deck.steps.iter().any(|s| s.nonlinear) {
        messages.note(
            card.place,
            "NLGEOM: contact follows the surfaces as they move; strains of the bodies are taken as small, and the run says how large strains and rotations become",
        );
    }
    let abrupt = match card.get("AMPLITUDE") {
        None => None,
        Some("STEP") => Some(true),
        Some("RAMP") => Some(false),
        Some(other) => {
            let message = format!("*STEP, AMPLITUDE={} is not known", clip(other));
            messages.error(card.place, message, "AMPLITUDE of *STEP is RAMP or STEP");
            None
        }
    };
    // What is printed and written goes on until cards of the same kind say otherwise.
    let before = reader.deck.steps.last();
    reader.deck.steps.push(Step {
        nonlinear,
        perturbation: card.has("PERTURBATION"),
        abrupt,
        place: card.place,
        prints: before.map_or_else(Vec::new, |s| s.prints.clone()),
        filed: before.map_or_else(Vec::new, |s| s.filed.clone()),
        output_every: before.and_then(|s| s.output_every),
        output_times: before.map_or_else(Vec::new, |s| s.output_times.clone()),
        ..Step::default()
    });
    reader.position.in_step = true;
    reader.position.procedure = false;
    reader.position.touched.clear();
    reader.position.asked.clear();
}

pub(super) fn end_step(reader: &mut Reader, card: &Card) {
    if !reader.position.in_step {
        let message = "*END STEP without *STEP";
        let help = "a step begins with *STEP";
        reader.messages.error(card.place, message, help);
        return;
    }
    step_without_procedure(reader);
    reader.position.in_step = false;
}

/// The step that the card belongs to.
pub(super) fn own_step<'r>(reader: &'r mut Reader, card: &Card) -> Option<&'r mut Step> {
    if !reader.position.in_step {
        let message = format!("{} stands outside of a step", card.written);
        let help = "write it between *STEP and *END STEP";
        reader.messages.error(card.place, message, help);
        return None;
    }
    reader.deck.steps.last_mut()
}

pub(super) fn times(messages: &mut Messages, card: &Card) -> [f64; 4] {
    let Some(data) = card.data.first() else {
        return [0.0; 4];
    };
    let times = [0, 1, 2, 3].map(|i| number(messages, data, i, 0.0));
    if times.iter().any(|t| *t < 0.0) {
        let help = "write initial increment, period, smallest, largest increment";
        messages.error(data.place, "times cannot be negative", help);
        return [0.0; 4];
    }
    if times[1] > 0.0 && times[0] > times[1] {
        let message = "the first increment is longer than the step";
        messages.error(data.place, message, "write initial increment, period");
        return [0.0; 4];
    }
    times
}

pub(super) fn proceed(reader: &mut Reader, card: &Card, procedure: Procedure) {
    let messages = &mut reader.messages;
    if reader.position.procedure && reader.position.in_step {
        let message = "a second procedure in one step";
        messages.error(card.place, message, "a step has one *STATIC or *DYNAMIC");
        return;
    }
    if reader.deck.steps.last().is_some_and(|s| s.perturbation) && !procedure.is_modal() {
        let message = format!(
            "{} in a step with PERTURBATION is not computed",
            card.written
        );
        let help = "take PERTURBATION out of *STEP: a step from the deformed state is computed";
        messages.error(card.place, message, help);
    }
    if let Some(step) = own_step(reader, card) {
        step.procedure = procedure;
        reader.position.procedure = true;
    }
}

pub(super) fn statics(reader: &mut Reader, card: &Card) {
    let times = times(&mut reader.messages, card);
    proceed(
        reader,
        card,
        Procedure::Static {
            times,
            direct: card.has("DIRECT"),
        },
    );
}

pub(super) fn dynamics(reader: &mut Reader, card: &Card) {
    let messages = &mut reader.messages;
    if card
        .get("APPLICATION")
        .is_some_and(|a| a != "TRANSIENTFIDELITY")
    {
        let message = "*DYNAMIC: only APPLICATION=TRANSIENT FIDELITY is read";
        let help = "leave APPLICATION out and give ALPHA, or use *STATIC for what is slow";
        messages.error(card.place, message, help);
    }
    if card.get("INITIAL") == Some("NO") {
        let help = "accelerations at the start follow from what acts then: leave INITIAL out";
        messages.error(card.place, "*DYNAMIC, INITIAL=NO is not supported", help);
    }
    let times = times(messages, card);
    let alpha = parameter(messages, card, "ALPHA");
    if alpha.is_some_and(|a| !(-1.0 / 3.0..=0.0).contains(&a)) {
        let message = "ALPHA must lie between -1/3 and 0";
        messages.error(card.place, message, "the default is -0.05");
    }
    proceed(
        reader,
        card,
        Procedure::Dynamic {
            times,
            direct: card.has("DIRECT"),
            explicit: card.has("EXPLICIT"),
            alpha,
        },
    );
}

pub(super) fn frequency(reader: &mut Reader, card: &Card) {
    let Some(data) = card.data.first() else {
        let message = "*FREQUENCY does not say how many modes";
        let help = "write number of modes, lowest frequency, highest frequency";
        reader.messages.error(card.place, message, help);
        return proceed(reader, card, Procedure::default());
    };
    let [from, to] = [1, 2].map(|i| number(&mut reader.messages, data, i, 0.0));
    let asked = number(
        &mut reader.messages,
        data,
        0,
        if to > 0.0 { 1e4 } else { 0.0 },
    );
    if !(asked >= 1.0 && from >= 0.0 && (to == 0.0 || to > from)) {
        let message = "the number of modes is at least 1, and their frequencies go from a lower to a higher one";
        let help = "write number of modes, lowest frequency, highest frequency";
        reader.messages.error(data.place, message, help);
    }
    if reader.deck.steps.len() > 1 {
        reader.messages.note(
            card.place,
            "*FREQUENCY: vibrations about the state of the step before, with its closed contacts; stress does not stiffen bodies. The run says what it would do to the frequencies, and ends with exit code 2 where that is more than a twentieth",
        );
    }
    let count = asked.clamp(1.0, 1e6) as usize;
    let range = [from, to];
    proceed(reader, card, Procedure::Frequency { count, range });
}

pub(super) fn complex_frequency(reader: &mut Reader, card: &Card) {
    let messages = &mut reader.messages;
    let fields = card.data.first();
    let [asked, from, highest, shift] =
        [0, 1, 2, 3].map(|i| fields.map_or(0.0, |data| number(messages, data, i, 0.0)));
    let place = fields.map_or(card.place, |data| data.place);
    if from != 0.0 || shift != 0.0 {
        let message = "*COMPLEX FREQUENCY: modes are found from the lowest frequency on";
        let help = "leave the lowest frequency and the shift out, and ask for as many modes as reach that far";
        messages.error(place, message, help);
    }
    let known = |s: &Step| match s.procedure {
        Procedure::Frequency { count, .. } => Some(count),
        _ => None,
    };
    let before = reader.deck.steps.iter().rev().find_map(known);
    let count = match (asked == 0.0, before) {
        (true, Some(count)) => count,
        (true, None) => {
            let message =
                "*COMPLEX FREQUENCY does not say how many modes, and no *FREQUENCY before it does";
            messages.error(place, message, "write number of modes, , highest frequency");
            1
        }
        (false, _) => asked.clamp(1.0, 1e6) as usize,
    };
    if asked < 0.0 || highest < 0.0 {
        let message = "the number of modes and their highest frequency are not negative";
        messages.error(place, message, "write number of modes, , highest frequency");
    }
    let friction_damping = match card.get("FRICTIONDAMPING") {
        None | Some("NO") => false,
        Some("YES") => true,
        Some(other) => {
            let message = format!("FRICTION DAMPING={} is not known", clip(other));
            messages.error(card.place, message, "FRICTION DAMPING is YES or NO");
            false
        }
    };
    let procedure = Procedure::ComplexFrequency {
        count,
        highest,
        friction_damping,
    };
    proceed(reader, card, procedure);
}

pub(super) fn step_without_procedure(reader: &mut Reader) {
    if !reader.position.procedure {
        let place = reader
            .deck
            .steps
            .last()
            .map_or(Place::default(), |s| s.place);
        let message = "the step does not say how it is solved";
        let help = "write *STATIC, *DYNAMIC, *FREQUENCY, *COMPLEX FREQUENCY or *STEADY STATE DYNAMICS in it";
        reader.messages.error(place, message, help);
    }
}
