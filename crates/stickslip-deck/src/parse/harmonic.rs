//! Steady vibrations: `*STEADY STATE DYNAMICS`, `*MODAL DAMPING`, and which part of a load shakes how.

use super::fields::{number, parameter, whole};
use super::messages::Messages;
use super::reader::Reader;
use super::step;
use crate::card::Card;
use crate::deck::Procedure;
use crate::text::clip;

/// Frequencies from a mode to the next if nothing is said, and how much they crowd.
const POINTS: f64 = 20.0;
const BIAS: f64 = 3.0;

/// Damping ratios are kept for so many modes at most.
const MODES: u64 = 100_000;

pub(super) fn steady_state(reader: &mut Reader, card: &Card) {
    let messages = &mut reader.messages;
    let even = match card.get("INTERVAL") {
        None | Some("EIGENFREQUENCY") => false,
        Some("RANGE") => true,
        Some(other) => {
            let message = format!("INTERVAL={} is not known here", clip(other));
            let help = "INTERVAL is EIGENFREQUENCY or RANGE";
            messages.error(card.place, message, help);
            false
        }
    };
    for (name, known, help) in [
        (
            "FREQUENCYSCALE",
            "LINEAR",
            "frequencies are spread on a linear scale: write FREQUENCY SCALE=LINEAR",
        ),
        (
            "HARMONIC",
            "YES",
            "loads go with the sine of time: leave HARMONIC out",
        ),
    ] {
        if card.get(name).is_some_and(|v| v != known) {
            let value = clip(card.get(name).unwrap_or_default());
            let message = format!("{}: {name}={value} is not supported", card.written);
            messages.error(card.place, message, help);
        }
    }
    let wanted = "write lowest frequency, highest frequency, number of points, bias";
    let Some(data) = card.data.first() else {
        let message = format!("{} does not say at which frequencies", card.written);
        reader.messages.error(card.place, message, wanted);
        return step::proceed(reader, card, Procedure::default());
    };
    let [from, to] = [0, 1].map(|i| number(&mut reader.messages, data, i, 0.0));
    let points = number(&mut reader.messages, data, 2, POINTS);
    let bias = number(&mut reader.messages, data, 3, if even { 1.0 } else { BIAS });
    if !(from >= 0.0 && to > from && points >= 2.0 && bias >= 1.0) {
        let message = "frequencies go from a lower to a higher one, by at least 2 points, with a bias of at least 1";
        reader.messages.error(data.place, message, wanted);
    }
    if even && bias != 1.0 {
        let message = "frequencies of INTERVAL=RANGE are spread evenly";
        let help = "leave the bias out, or INTERVAL";
        reader.messages.error(data.place, message, help);
    }
    let procedure = Procedure::Harmonic {
        range: [from, to],
        points: points.clamp(2.0, 1e6) as usize,
        bias: (!even).then_some(bias.max(1.0)),
    };
    let before = |s: &crate::deck::Step| matches!(s.procedure, Procedure::Frequency { .. });
    if !reader.deck.steps.iter().any(before) {
        let message = format!(
            "{} superposes modes, and no *FREQUENCY before it finds some",
            card.written
        );
        let help = "write a step with *FREQUENCY before this one";
        reader.messages.error(card.place, message, help);
    }
    step::proceed(reader, card, procedure);
}

pub(super) fn modal_damping(reader: &mut Reader, card: &Card) {
    if step::own_step(reader, card).is_none() {
        return;
    }
    let messages = &mut reader.messages;
    if card.get("MODAL").is_some_and(|m| m != "DIRECT") {
        let help = "write MODAL=DIRECT, with lowest mode, highest mode, damping ratio";
        messages.error(card.place, "only MODAL=DIRECT is read", help);
    }
    for data in &card.data {
        if card.has("RAYLEIGH") {
            let rayleigh = [2, 3].map(|i| number(messages, data, i, 0.0));
            if let Some(step) = reader.deck.steps.last_mut() {
                step.damping.rayleigh = rayleigh;
            }
            continue;
        }
        let (Some(first), Some(last)) = (whole(messages, data, 0), whole(messages, data, 1)) else {
            continue;
        };
        let ratio = number(messages, data, 2, 0.0);
        if last < first || last > MODES || ratio < 0.0 {
            let message =
                "modes go from a lower number to a higher one, and their damping is not negative";
            let help = "write lowest mode, highest mode, damping ratio";
            messages.error(data.place, message, help);
            continue;
        }
        let range = first as usize - 1..last as usize;
        if let Some(step) = reader.deck.steps.last_mut() {
            let length = step.damping.ratios.len().max(range.end);
            step.damping.ratios.resize(length, 0.0);
            step.damping.ratios[range].fill(ratio);
        }
    }
}

/// Whether the loads of a card are the imaginary parts of what shakes: `LOAD CASE=2` of CalculiX, `IMAGINARY` of Abaqus.
pub(super) fn imaginary(messages: &mut Messages, card: &Card) -> bool {
    let case = parameter(messages, card, "LOADCASE").unwrap_or(1.0);
    if case != 1.0 && case != 2.0 {
        let message = format!("{}: there is no load case {case}", card.written);
        let help = "LOAD CASE is 1, the real part, or 2, the imaginary part";
        messages.error(card.place, message, help);
    }
    let (real, imaginary) = (card.has("REAL"), card.has("IMAGINARY") || case == 2.0);
    if real && imaginary {
        let message = format!("{}: a load is REAL or IMAGINARY, not both", card.written);
        messages.error(card.place, message, "write a card for each part");
    }
    imaginary
}
