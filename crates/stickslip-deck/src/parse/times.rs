//! Amplitudes and time points.

use super::fields::parameter;
use super::reader::Reader;
use crate::card::Card;
use crate::deck::{Amplitude, TimePoints};

impl Reader<'_> {
    pub(super) fn amplitude(&mut self, card: &Card) {
        let Some(name) = self.required(card, "NAME") else {
            return;
        };
        if card.get("VALUE").is_some_and(|v| v != "RELATIVE") {
            self.error(
                card.place,
                "*AMPLITUDE, VALUE=ABSOLUTE is not supported",
                "amplitudes multiply the values they belong to: give factors",
            );
        }
        if card.get("DEFINITION").is_some_and(|d| d != "TABULAR") {
            self.error(
                card.place,
                "only tabular amplitudes are read",
                "give time, factor pairs",
            );
            return;
        }
        let shift = [
            parameter(self, card, "SHIFTX").unwrap_or(0.0),
            parameter(self, card, "SHIFTY").unwrap_or(0.0),
        ];
        let mut rows: Vec<[f64; 2]> = Vec::new();
        for data in &card.data {
            for k in (0..data.fields.len()).step_by(2) {
                let row = [
                    self.number(data, k, 0.0) + shift[0],
                    self.number(data, k + 1, 0.0) + shift[1],
                ];
                if rows.last().is_some_and(|last| last[0] >= row[0]) {
                    self.error(
                        data.place,
                        format!(
                            "time {} does not follow {}",
                            row[0],
                            rows[rows.len() - 1][0]
                        ),
                        "times of an amplitude increase",
                    );
                    return;
                }
                rows.push(row);
            }
        }
        if rows.is_empty() {
            self.error(
                card.place,
                "the amplitude is empty",
                "give time, factor pairs",
            );
        }
        let amplitude = Amplitude {
            rows,
            total_time: card.get("TIME") == Some("TOTALTIME"),
            place: card.place,
        };
        if self
            .deck
            .tables
            .amplitudes
            .insert(name.clone(), amplitude)
            .is_some()
        {
            self.error(
                card.place,
                format!("the amplitude {name} is given twice"),
                "give each amplitude a name of its own",
            );
        }
    }

    pub(super) fn time_points(&mut self, card: &Card) {
        let Some(name) = self.required(card, "NAME") else {
            return;
        };
        let mut times = Vec::new();
        for data in &card.data {
            if card.has("GENERATE") {
                let [from, to, by] = [0, 1, 2].map(|i| self.number(data, i, 0.0));
                let count = (to - from) / by;
                if !(0.0..=1e6 - times.len() as f64).contains(&count) {
                    self.error(
                        data.place,
                        "these times cannot be made",
                        "write first, last, increment; at most a million",
                    );
                    return;
                }
                times.extend((0..=(count + 1e-9) as usize).map(|i| from + by * i as f64));
                continue;
            }
            for i in 0..data.fields.len() {
                times.push(self.number(data, i, 0.0));
            }
        }
        let points = TimePoints {
            times,
            total_time: card.get("TIME") == Some("TOTALTIME"),
        };
        if self
            .deck
            .tables
            .time_points
            .insert(name.clone(), points)
            .is_some()
        {
            self.error(
                card.place,
                format!("the time points {name} are given twice"),
                "give each a name of its own",
            );
        }
    }
}
