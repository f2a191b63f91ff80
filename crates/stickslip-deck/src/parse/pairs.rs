//! Pairs of surfaces that touch or are tied.

use super::fields::parameter;
use super::reader::Reader;
use crate::card::{Card, Data};
use crate::deck::{Action, Adjust, Clearance, Pair, Tie};
use crate::text::{clip, number};

impl Reader<'_> {
    /// Slave and master, in the first data line.
    pub(super) fn surfaces(&mut self, card: &Card) -> Option<(String, String)> {
        let data = self.line(card)?;
        match data.fields.as_slice() {
            [slave, master, ..] if !slave.is_empty() && !master.is_empty() => {
                Some((self.name(slave), self.name(master)))
            }
            _ => {
                self.error(
                    data.place,
                    "two surfaces are expected",
                    "write slave surface, master surface; self-contact is not computed",
                );
                None
            }
        }
    }

    pub(super) fn contact_pair(&mut self, card: &Card) {
        let Some(interaction) = self.required(card, "INTERACTION") else {
            return;
        };
        let by_nodes = match card.get("TYPE").unwrap_or("SURFACETOSURFACE") {
            "NODETOSURFACE" => true,
            "SURFACETOSURFACE" | "MORTAR" | "LINMORTAR" | "PGLINMORTAR" => false,
            // Nodes that may touch lose their mass there without their neighbours getting it: of a body of one cell a third is left, and
            // the answer of a coarse mesh is another one than with all of it.
            "MASSLESS" => {
                self.error(
                    card.place,
                    "*CONTACT PAIR of type MASSLESS is not supported: it leaves out the mass of the nodes that may touch, which bodies keep here",
                    "write TYPE=SURFACE TO SURFACE if the mass of the bodies is to count; the motion is another one unless the layer of cells at \
                     the surface is a small part of the body",
                );
                return;
            }
            other => {
                let message = format!("*CONTACT PAIR of type {} is not supported", clip(other));
                self.error(
                    card.place,
                    message,
                    "types are NODE TO SURFACE and SURFACE TO SURFACE",
                );
                return;
            }
        };
        let adjust = card.get("ADJUST").map(|text| match number(text) {
            Some(distance) => Adjust::Within(distance),
            None => Adjust::Set(self.scoped(text)),
        });
        if adjust == Some(Adjust::Set(String::new()))
            || matches!(adjust, Some(Adjust::Within(d)) if d < 0.0)
        {
            self.error(
                card.place,
                "*CONTACT PAIR: ADJUST needs a distance of 0 or more, or a set of nodes",
                "write ADJUST=0.01, or the name of an *NSET",
            );
        }
        let pairs: Vec<&Data> = card.data.iter().collect();
        if pairs.is_empty() {
            self.line(card);
        }
        for data in pairs {
            let one = Card {
                data: vec![data.clone()],
                ..card.clone()
            };
            let Some((slave, master)) = self.surfaces(&one) else {
                continue;
            };
            if card.has("TIED") {
                self.tied_pair(card, data, slave, master, &adjust);
                continue;
            }
            self.deck.contact.pairs.push(Pair {
                slave,
                master,
                interaction: interaction.clone(),
                by_nodes,
                small_sliding: card.has("SMALLSLIDING"),
                adjust: adjust.clone(),
                place: data.place,
            });
        }
    }

    /// `TIED`: the nodes that ADJUST moves onto the master are tied for good.
    fn tied_pair(
        &mut self,
        card: &Card,
        data: &Data,
        slave: String,
        master: String,
        adjust: &Option<Adjust>,
    ) {
        let Some(Adjust::Within(distance)) = adjust else {
            self.error(
                card.place,
                "*CONTACT PAIR, TIED does not say how far the surfaces may be apart",
                "write ADJUST with that distance, or *TIE, NAME=..., POSITION TOLERANCE=... in its place",
            );
            return;
        };
        self.deck.connectors.ties.push(Tie {
            name: format!("{slave}-{master}"),
            slave,
            master,
            tolerance: Some(*distance),
            adjust: true,
            place: data.place,
        });
    }

    /// Contact pairs that act from this step on, or no longer.
    pub(super) fn model_change(&mut self, card: &Card) {
        if self.own_step(card).is_none() {
            return;
        }
        match card.get("TYPE").unwrap_or("ELEMENT") {
            "CONTACTPAIR" => {}
            "ELEMENT" => {
                self.error(
                    card.place,
                    "*MODEL CHANGE of elements is not supported",
                    "contact pairs can be removed and added (TYPE=CONTACT PAIR), elements cannot: leave them out of the deck, or make a body of \
                     their own of them that a contact pair holds in some steps",
                );
                return;
            }
            other => {
                let message = format!("*MODEL CHANGE of type {} is not supported", clip(other));
                self.error(card.place, message, "the type is CONTACT PAIR");
                return;
            }
        }
        if card.get("ADD").is_some_and(|v| !v.is_empty()) {
            let message = "*MODEL CHANGE: contact pairs are added as they are";
            self.error(card.place, message, "write ADD without a value");
            return;
        }
        let add = card.has("ADD");
        if add == card.has("REMOVE") {
            self.error(
                card.place,
                "*MODEL CHANGE needs either ADD or REMOVE",
                "write *MODEL CHANGE, TYPE=CONTACT PAIR, REMOVE, or ADD",
            );
            return;
        }
        if card.data.is_empty() {
            self.line(card);
        }
        for data in &card.data {
            let one = Card {
                data: vec![data.clone()],
                ..card.clone()
            };
            if let Some((slave, master)) = self.surfaces(&one) {
                self.act(Action::ChangePair {
                    slave,
                    master,
                    add,
                    place: data.place,
                });
            }
        }
    }

    pub(super) fn clearance(&mut self, card: &Card) {
        let (Some(slave), Some(master)) = (
            self.required_name(card, "SLAVE"),
            self.required_name(card, "MASTER"),
        ) else {
            return;
        };
        if self.required(card, "VALUE").is_none() {
            return;
        }
        let value = parameter(self, card, "VALUE").unwrap_or(0.0);
        self.deck.contact.clearances.push(Clearance {
            slave,
            master,
            value,
            place: card.place,
        });
    }

    pub(super) fn tie(&mut self, card: &Card) {
        let tolerance = parameter(self, card, "POSITIONTOLERANCE");
        if tolerance.is_some_and(|t| t < 0.0) {
            self.error(
                card.place,
                "*TIE: the position tolerance is negative",
                "nodes of the slave surface are tied that are no farther from the master: write a distance",
            );
        }
        let adjust = match card.get("ADJUST").unwrap_or("YES") {
            "NO" => false,
            "YES" | "" => true,
            other => {
                let message = format!("*TIE: ADJUST={} is not known", clip(other));
                self.error(card.place, message, "ADJUST is YES or NO");
                return;
            }
        };
        for data in &card.data {
            let one = Card {
                data: vec![data.clone()],
                ..card.clone()
            };
            let Some((slave, master)) = self.surfaces(&one) else {
                continue;
            };
            let name = card.get("NAME").map_or_else(
                || format!("TIE-{}", self.deck.connectors.ties.len() + 1),
                str::to_string,
            );
            self.deck.connectors.ties.push(Tie {
                name,
                slave,
                master,
                // CalculiX takes none for the default.
                tolerance: tolerance.filter(|t| *t >= 1e-10),
                adjust,
                place: data.place,
            });
        }
    }
}
