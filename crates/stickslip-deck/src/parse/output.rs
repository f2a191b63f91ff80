//! What is printed and written, and when.

use super::fields::{keys, parameter};
use super::reader::Reader;
use crate::card::Card;
use crate::deck::{Print, Totals, When};
use crate::text::clip;

impl Reader<'_> {
    /// Every so many increments, or at times; `None` is never.
    pub(super) fn when(&mut self, card: &Card) -> Option<When> {
        if let Some(name) = card.get("TIMEPOINTS").map(str::to_string) {
            if let Some(step) = self.deck.steps.last_mut() {
                step.output_times.push(name.clone());
            }
            return Some(When::Times(name));
        }
        let name = ["FREQUENCY", "FREQUENCYF"]
            .into_iter()
            .find(|n| card.has(n));
        let every = name
            .and_then(|n| parameter(self, card, n))
            .unwrap_or(1.0)
            .max(0.0);
        (every >= 1.0).then_some(When::Every(every.min(1e9) as usize))
    }

    pub(super) fn print(&mut self, card: &Card) {
        if self.own_step(card).is_none() {
            return;
        }
        let kind = |p: &Print| match p {
            Print::Node { .. } => "NODEPRINT",
            Print::Element { .. } => "ELPRINT",
            Print::Contact { .. } => "CONTACTPRINT",
        };
        if self.asked.insert(card.keyword.clone())
            && let Some(step) = self.deck.steps.last_mut()
        {
            step.prints.retain(|p| kind(p) != card.keyword);
        }
        let totals = match card.get("TOTALS") {
            Some("YES") => Totals::Yes,
            Some("ONLY") => Totals::Only,
            _ => Totals::No,
        };
        let Some(when) = self.when(card) else { return };
        let keys = keys(card);
        let known: &[&str] = match card.keyword.as_str() {
            "NODEPRINT" => &["U", "RF", "V", "A"],
            "ELPRINT" => &["S", "E", "ELSE", "EVOL"],
            _ => &[
                "CDIS", "CDISP", "CSTR", "CSTRESS", "CELS", "CF", "CNUM", "CFN", "CFS",
            ],
        };
        for key in &keys {
            if !known.contains(&key.as_str()) {
                let message = format!(
                    "{}: {} is left out: it is not printed",
                    card.written,
                    clip(key)
                );
                self.note(card.place, message);
            }
        }
        let keys: Vec<String> = keys
            .into_iter()
            .filter(|k| known.contains(&k.as_str()))
            .collect();
        let sums = match card.keyword.as_str() {
            "NODEPRINT" => card.get("NSET").map(|s| (0, s.to_string())),
            "ELPRINT" => card.get("ELSET").map(|s| (1, s.to_string())),
            _ => None,
        };
        if let (true, Some((kind, set))) = (totals != Totals::No, sums) {
            self.once(kind, &set, card.place);
        }
        let print = match card.keyword.as_str() {
            "NODEPRINT" => match card.get("NSET").map(str::to_string) {
                Some(set) if !self.deck.node_sets.contains_key(&set) => {
                    self.error(
                        card.place,
                        format!("there is no set of nodes {set}"),
                        "define it with *NSET before it is printed",
                    );
                    return;
                }
                Some(set) => Print::Node {
                    set,
                    keys,
                    totals,
                    global: card.get("GLOBAL") == Some("YES"),
                    when,
                },
                None => {
                    let message = format!("{} names no set: nothing is printed", card.written);
                    self.note(card.place, message);
                    return;
                }
            },
            "ELPRINT" => match card.get("ELSET").map(str::to_string) {
                Some(set) if !self.deck.element_sets.contains_key(&set) => {
                    self.error(
                        card.place,
                        format!("there is no set of elements {set}"),
                        "define it with *ELSET before it is printed",
                    );
                    return;
                }
                Some(set) => Print::Element {
                    set,
                    keys,
                    totals,
                    global: card.get("GLOBAL") == Some("YES"),
                    when,
                },
                None => {
                    let message = format!("{} names no set: nothing is printed", card.written);
                    self.note(card.place, message);
                    return;
                }
            },
            _ => {
                let pair = card.get("SLAVE").zip(card.get("MASTER"));
                Print::Contact {
                    pair: pair.map(|(s, m)| (s.to_string(), m.to_string())),
                    keys,
                    totals,
                    when,
                }
            }
        };
        if let Some(step) = self.deck.steps.last_mut() {
            step.prints.push(print);
        }
    }

    pub(super) fn output(&mut self, card: &Card) {
        if self.own_step(card).is_none() {
            return;
        }
        if self.asked.insert("OUTPUT".into())
            && let Some(step) = self.deck.steps.last_mut()
        {
            step.output_every = None;
        }
        let when = self.when(card);
        if let (Some(When::Every(n)), Some(step)) = (when, self.deck.steps.last_mut()) {
            step.output_every = Some(step.output_every.map_or(n, |e| e.min(n)));
        }
    }
}
