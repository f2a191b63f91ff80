//! What is printed and written, and when.

use stickslip::io::frd::Encoding;
use stickslip::results::Quantity;

use super::fields::{keys, parameter};
use super::known::absent;
use super::reader::Reader;
use crate::card::Card;
use crate::deck::{Deck, FieldsOf, Filed, Print, SurfaceParts, Totals, When};
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

    /// The quantities of a card that are printed; notes on the others.
    fn known_keys(&mut self, card: &Card) -> Vec<String> {
        let known: &[&str] = match card.keyword.as_str() {
            "NODEPRINT" => &["U", "RF", "V", "A", "UR", "RM", "NT", "NT11"],
            "ELPRINT" => &["S", "E", "ME", "ELSE", "EVOL"],
            _ => &[
                "CDIS", "CDISP", "CSTR", "CSTRESS", "CELS", "CF", "CNUM", "CFN", "CFS",
            ],
        };
        let (printed, others): (Vec<String>, Vec<String>) = keys(card)
            .into_iter()
            .partition(|k| known.contains(&k.as_str()));
        for key in others {
            let message = format!(
                "{}: {} is left out: it is not printed",
                card.written,
                clip(&key)
            );
            self.note(card.place, message);
        }
        printed
    }

    /// The set that is printed, of nodes or of elements.
    fn printed_set(
        &mut self,
        card: &Card,
        parameter: &str,
        what: &str,
        known: impl Fn(&Deck, &str) -> bool,
    ) -> Option<String> {
        let Some(set) = card.get(parameter).map(|s| self.scoped(s)) else {
            let message = format!("{} names no set: nothing is printed", card.written);
            self.note(card.place, message);
            return None;
        };
        if !known(&self.deck, &set) {
            self.error(
                card.place,
                format!("there is no set of {what} {set}"),
                &format!("define it with *{parameter} before it is printed"),
            );
            return None;
        }
        Some(set)
    }

    pub(super) fn print(&mut self, card: &Card) {
        if self.own_step(card).is_none() {
            return;
        }
        let kind = |p: &Print| match p {
            Print::Node { .. } => "NODEPRINT",
            Print::Element { .. } => "ELPRINT",
            Print::Contact { .. } => "CONTACTPRINT",
            Print::Section { .. } => "SECTIONPRINT",
        };
        if self.position.asked.insert(card.keyword.clone())
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
        let keys = self.known_keys(card);
        let sums = match card.keyword.as_str() {
            "NODEPRINT" => card.get("NSET").map(|s| (0, self.scoped(s))),
            "ELPRINT" => card.get("ELSET").map(|s| (1, self.scoped(s))),
            _ => None,
        };
        if let (true, Some((kind, set))) = (totals != Totals::No, sums) {
            self.once(kind, &set, card.place);
        }
        let global = || card.get("GLOBAL") == Some("YES");
        let print = match card.keyword.as_str() {
            "NODEPRINT" => self
                .printed_set(card, "NSET", "nodes", |d, set| {
                    d.node_sets.contains_key(set)
                })
                .map(|set| Print::Node {
                    set,
                    keys,
                    totals,
                    global: global(),
                    when,
                }),
            "ELPRINT" => self
                .printed_set(card, "ELSET", "elements", |d, set| {
                    d.element_sets.contains_key(set)
                })
                .map(|set| Print::Element {
                    set,
                    keys,
                    totals,
                    global: global(),
                    when,
                }),
            _ => {
                let pair = card.get("SLAVE").zip(card.get("MASTER"));
                Some(Print::Contact {
                    pair: pair.map(|(s, m)| (self.scoped(s), self.scoped(m))),
                    keys,
                    totals,
                    when,
                })
            }
        };
        if let (Some(print), Some(step)) = (print, self.deck.steps.last_mut()) {
            step.prints.push(print);
        }
    }

    /// What surfaces carry. A card takes the place of those in earlier steps.
    pub(super) fn section_print(&mut self, card: &Card) {
        if self.own_step(card).is_none() {
            return;
        }
        let first = self.position.asked.insert(card.keyword.clone());
        if let (true, Some(step)) = (first, self.deck.steps.last_mut()) {
            step.prints.retain(|p| !matches!(p, Print::Section { .. }));
        }
        let Some(surface) = self.required_name(card, "SURFACE") else {
            return;
        };
        let (sums, others): (Vec<String>, Vec<String>) = keys(card)
            .into_iter()
            .partition(|k| ["SOF", "SOM", "SOAREA"].contains(&k.as_str()));
        for key in others {
            let message = format!(
                "{}: {} is left out: it is not printed",
                card.written,
                clip(&key)
            );
            self.note(card.place, message);
        }
        match self.deck.surfaces.get(&surface).map(|s| &s.parts) {
            Some(SurfaceParts::Faces(_)) => {}
            Some(SurfaceParts::Nodes(_)) => {
                self.error(
                    card.place,
                    format!("the surface {surface} consists of nodes"),
                    "*SECTION PRINT sums up what faces carry",
                );
                return;
            }
            None => {
                let known = self.deck.surfaces.keys();
                let (message, help) = absent(&self.deck.numbering, "surface", &surface, known);
                self.error(card.place, message, &help);
                return;
            }
        }
        // Each of the keys prints all of it.
        if let (false, Some(when)) = (sums.is_empty(), self.when(card))
            && let Some(step) = self.deck.steps.last_mut()
        {
            step.prints.push(Print::Section { surface, when });
        }
    }

    pub(super) fn output(&mut self, card: &Card) {
        if self.own_step(card).is_none() {
            return;
        }
        if self.position.asked.insert("OUTPUT".into())
            && let Some(step) = self.deck.steps.last_mut()
        {
            step.output_every = None;
        }
        let when = self.when(card);
        self.file(card, when.clone());
        if let (Some(When::Every(n)), Some(step)) = (when, self.deck.steps.last_mut()) {
            step.output_every = Some(step.output_every.map_or(n, |e| e.min(n)));
        }
    }

    /// What a card asks for in the `.frd` file. A card takes the place of those of its kind in earlier steps.
    fn file(&mut self, card: &Card, when: Option<When>) {
        let of = match card.keyword.as_str() {
            "NODEFILE" | "NODEOUTPUT" => FieldsOf::Nodes,
            "ELFILE" | "ELEMENTOUTPUT" => FieldsOf::Elements,
            "CONTACTFILE" | "CONTACTOUTPUT" => FieldsOf::Contact,
            _ => {
                self.position.history = Some(card.has("HISTORY"));
                return;
            }
        };
        // Histories are of single nodes and elements, which are no fields.
        if self.position.history == Some(true) {
            return;
        }
        if self.position.asked.insert(format!("FILE {of:?}"))
            && let Some(step) = self.deck.steps.last_mut()
        {
            step.filed.retain(|f| f.of != of);
        }
        let quantities = self.quantities(card, of);
        if self.deck.output.frd.is_none() {
            // In CalculiX cards with OUTPUT are for a binary file; in Abaqus, where they stand under *OUTPUT, they say nothing of it.
            let binary = card.keyword.ends_with("OUTPUT") && self.position.history.is_none();
            self.deck.output.frd = Some(match binary {
                true => Encoding::Binary,
                false => Encoding::Text,
            });
        }
        if let (Some(when), Some(step)) = (when, self.deck.steps.last_mut()) {
            step.filed.push(Filed {
                of,
                quantities,
                when,
            });
        }
    }

    /// The quantities of a card that are written; notes on the others.
    fn quantities(&mut self, card: &Card, of: FieldsOf) -> Vec<Quantity> {
        let mut out = Vec::new();
        let asked = keys(card);
        for key in &asked {
            match quantity(of, key) {
                Some(quantity) => out.push(quantity),
                None => {
                    let message = format!(
                        "{}: {} is left out: it is not written to the .frd file",
                        card.written,
                        clip(key)
                    );
                    self.note(card.place, message);
                }
            }
        }
        // A choice of Abaqus's own, such as VARIABLE=PRESELECT.
        if asked.is_empty() && self.position.history.is_some() {
            out.extend(match of {
                FieldsOf::Nodes => vec![Quantity::Displacement, Quantity::Force],
                FieldsOf::Elements => vec![Quantity::Stress, Quantity::Strain],
                FieldsOf::Contact => vec![Quantity::Contact],
            });
        }
        out
    }
}

/// The block of the `.frd` file that has what a key asks for. Gap and pressure of contact are one block, as in CalculiX.
fn quantity(of: FieldsOf, key: &str) -> Option<Quantity> {
    Some(match (of, key) {
        (FieldsOf::Nodes, "U") => Quantity::Displacement,
        (FieldsOf::Nodes, "V") => Quantity::Velocity,
        (FieldsOf::Nodes, "RF") => Quantity::Force,
        (FieldsOf::Nodes, "NT" | "NT11") => Quantity::Temperature,
        (FieldsOf::Elements, "S") => Quantity::Stress,
        (FieldsOf::Elements, "E" | "LE") => Quantity::Strain,
        (FieldsOf::Elements, "ENER") => Quantity::Energy,
        (FieldsOf::Contact, "CDIS" | "CDISP" | "CSTR" | "CSTRESS") => Quantity::Contact,
        _ => return None,
    })
}
