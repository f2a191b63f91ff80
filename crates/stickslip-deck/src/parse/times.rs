//! Amplitudes and time points.

use super::fields::{number, parameter, required};
use super::reader::Reader;
use crate::card::Card;
use crate::deck::{Amplitude, TimePoints};

pub(super) fn amplitude(reader: &mut Reader, card: &Card) {
    let messages = &mut reader.messages;
    let Some(name) = required(messages, card, "NAME") else {
        return;
    };
    if card.get("VALUE").is_some_and(|v| v != "RELATIVE") {
        let message = "*AMPLITUDE, VALUE=ABSOLUTE is not supported";
        let help = "amplitudes multiply the values they belong to: give factors";
        messages.error(card.place, message, help);
    }
    if card.get("DEFINITION").is_some_and(|d| d != "TABULAR") {
        let message = "only tabular amplitudes are read";
        messages.error(card.place, message, "give time, factor pairs");
        return;
    }
    let shift = [
        parameter(messages, card, "SHIFTX").unwrap_or(0.0),
        parameter(messages, card, "SHIFTY").unwrap_or(0.0),
    ];
    let mut rows: Vec<[f64; 2]> = Vec::new();
    for data in &card.data {
        for k in (0..data.fields.len()).step_by(2) {
            let row = [
                number(messages, data, k, 0.0) + shift[0],
                number(messages, data, k + 1, 0.0) + shift[1],
            ];
            if rows.last().is_some_and(|last| last[0] >= row[0]) {
                let message = format!(
                    "time {} does not follow {}",
                    row[0],
                    rows[rows.len() - 1][0]
                );
                messages.error(data.place, message, "times of an amplitude increase");
                return;
            }
            rows.push(row);
        }
    }
    if rows.is_empty() {
        let message = "the amplitude is empty";
        messages.error(card.place, message, "give time, factor pairs");
    }
    let amplitude = Amplitude {
        rows,
        total_time: card.get("TIME") == Some("TOTALTIME"),
        place: card.place,
    };
    if reader
        .deck
        .tables
        .amplitudes
        .insert(name.clone(), amplitude)
        .is_some()
    {
        let message = format!("the amplitude {name} is given twice");
        messages.error(card.place, message, "give each amplitude a name of its own");
    }
}

pub(super) fn time_points(reader: &mut Reader, card: &Card) {
    let messages = &mut reader.messages;
    let Some(name) = required(messages, card, "NAME") else {
        return;
    };
    let mut times = Vec::new();
    for data in &card.data {
        if card.has("GENERATE") {
            let [from, to, by] = [0, 1, 2].map(|i| number(messages, data, i, 0.0));
            let count = (to - from) / by;
            if !(0.0..=1e6 - times.len() as f64).contains(&count) {
                let help = "write first, last, increment; at most a million";
                messages.error(data.place, "these times cannot be made", help);
                return;
            }
            times.extend((0..=(count + 1e-9) as usize).map(|i| from + by * i as f64));
            continue;
        }
        for i in 0..data.fields.len() {
            times.push(number(messages, data, i, 0.0));
        }
    }
    let points = TimePoints {
        times,
        total_time: card.get("TIME") == Some("TOTALTIME"),
    };
    if reader
        .deck
        .tables
        .time_points
        .insert(name.clone(), points)
        .is_some()
    {
        let message = format!("the time points {name} are given twice");
        messages.error(card.place, message, "give each a name of its own");
    }
}
