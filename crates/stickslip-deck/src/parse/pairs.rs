//! Pairs of surfaces that touch or are tied.

use super::fields::{line, parameter, required, required_name};
use super::reader::Reader;
use super::step;
use crate::card::{Card, Data};
use crate::deck::{Action, Adjust, Clearance, Pair, Tie};
use crate::text::{self, clip};

/// Slave and master, in the first data line.
pub(super) fn surfaces(reader: &mut Reader, card: &Card) -> Option<(String, String)> {
    let messages = &mut reader.messages;
    let data = line(messages, card)?;
    match data.fields.as_slice() {
        [slave, master, ..] if !slave.is_empty() && !master.is_empty() => {
            Some((reader.scope.name(slave), reader.scope.name(master)))
        }
        _ => {
            let help = "write slave surface, master surface; self-contact is not computed";
            messages.error(data.place, "two surfaces are expected", help);
            None
        }
    }
}

pub(super) fn contact_pair(reader: &mut Reader, card: &Card) {
    let messages = &mut reader.messages;
    let Some(interaction) = required(messages, card, "INTERACTION") else {
        return;
    };
    let by_nodes = match card.get("TYPE").unwrap_or("SURFACETOSURFACE") {
        "NODETOSURFACE" => true,
        "SURFACETOSURFACE" | "MORTAR" | "LINMORTAR" | "PGLINMORTAR" => false,
        // Nodes that may touch lose their mass there without their neighbours getting it: of a body of one cell a third is left, and
        // the answer of a coarse mesh is another one than with all of it.
        "MASSLESS" => {
            messages.error(
                card.place,
                "*CONTACT PAIR of type MASSLESS is not supported: it leaves out the mass of the nodes that may touch, which bodies keep here",
                "write TYPE=SURFACE TO SURFACE if the mass of the bodies is to count; the motion is another one unless the layer of cells at \
                 the surface is a small part of the body",
            );
            return;
        }
        other => {
            let message = format!("*CONTACT PAIR of type {} is not supported", clip(other));
            let help = "types are NODE TO SURFACE and SURFACE TO SURFACE";
            messages.error(card.place, message, help);
            return;
        }
    };
    let adjust = card.get("ADJUST").map(|text| match text::number(text) {
        Some(distance) => Adjust::Within(distance),
        None => Adjust::Set(reader.scope.scoped(text)),
    });
    if adjust == Some(Adjust::Set(String::new()))
        || matches!(adjust, Some(Adjust::Within(d)) if d < 0.0)
    {
        let message = "*CONTACT PAIR: ADJUST needs a distance of 0 or more, or a set of nodes";
        let help = "write ADJUST=0.01, or the name of an *NSET";
        messages.error(card.place, message, help);
    }
    let pairs: Vec<&Data> = card.data.iter().collect();
    if pairs.is_empty() {
        line(messages, card);
    }
    for data in pairs {
        let one = Card {
            data: vec![data.clone()],
            ..card.clone()
        };
        let Some((slave, master)) = surfaces(reader, &one) else {
            continue;
        };
        if card.has("TIED") {
            tied_pair(reader, card, data, slave, master, &adjust);
            continue;
        }
        reader.deck.contact.pairs.push(Pair {
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
    reader: &mut Reader,
    card: &Card,
    data: &Data,
    slave: String,
    master: String,
    adjust: &Option<Adjust>,
) {
    let Some(Adjust::Within(distance)) = adjust else {
        let message = "*CONTACT PAIR, TIED does not say how far the surfaces may be apart";
        let help = "write ADJUST with that distance, or *TIE, NAME=..., POSITION TOLERANCE=... in its place";
        reader.messages.error(card.place, message, help);
        return;
    };
    reader.deck.connectors.ties.push(Tie {
        name: format!("{slave}-{master}"),
        slave,
        master,
        tolerance: Some(*distance),
        adjust: true,
        place: data.place,
    });
}

/// Contact pairs that act from this step on, or no longer.
pub(super) fn model_change(reader: &mut Reader, card: &Card) {
    if step::own_step(reader, card).is_none() {
        return;
    }
    match card.get("TYPE").unwrap_or("ELEMENT") {
        "CONTACTPAIR" => {}
        "ELEMENT" => {
            reader.messages.error(
                card.place,
                "*MODEL CHANGE of elements is not supported",
                "contact pairs can be removed and added (TYPE=CONTACT PAIR), elements cannot: leave them out of the deck, or make a body of \
                 their own of them that a contact pair holds in some steps",
            );
            return;
        }
        other => {
            let message = format!("*MODEL CHANGE of type {} is not supported", clip(other));
            let help = "the type is CONTACT PAIR";
            reader.messages.error(card.place, message, help);
            return;
        }
    }
    if card.get("ADD").is_some_and(|v| !v.is_empty()) {
        let message = "*MODEL CHANGE: contact pairs are added as they are";
        let help = "write ADD without a value";
        reader.messages.error(card.place, message, help);
        return;
    }
    let add = card.has("ADD");
    if add == card.has("REMOVE") {
        let message = "*MODEL CHANGE needs either ADD or REMOVE";
        let help = "write *MODEL CHANGE, TYPE=CONTACT PAIR, REMOVE, or ADD";
        reader.messages.error(card.place, message, help);
        return;
    }
    if card.data.is_empty() {
        line(&mut reader.messages, card);
    }
    for data in &card.data {
        let one = Card {
            data: vec![data.clone()],
            ..card.clone()
        };
        if let Some((slave, master)) = surfaces(reader, &one) {
            reader.deck.act(Action::ChangePair {
                slave,
                master,
                add,
                place: data.place,
            });
        }
    }
}

pub(super) fn clearance(reader: &mut Reader, card: &Card) {
    let (Some(slave), Some(master)) = (
        required_name(reader, card, "SLAVE"),
        required_name(reader, card, "MASTER"),
    ) else {
        return;
    };
    let messages = &mut reader.messages;
    if required(messages, card, "VALUE").is_none() {
        return;
    }
    let value = parameter(messages, card, "VALUE").unwrap_or(0.0);
    reader.deck.contact.clearances.push(Clearance {
        slave,
        master,
        value,
        place: card.place,
    });
}

pub(super) fn tie(reader: &mut Reader, card: &Card) {
    let messages = &mut reader.messages;
    let tolerance = parameter(messages, card, "POSITIONTOLERANCE");
    if tolerance.is_some_and(|t| t < 0.0) {
        let help = "nodes of the slave surface are tied that are no farther from the master: write a distance";
        messages.error(card.place, "*TIE: the position tolerance is negative", help);
    }
    let adjust = match card.get("ADJUST").unwrap_or("YES") {
        "NO" => false,
        "YES" | "" => true,
        other => {
            let message = format!("*TIE: ADJUST={} is not known", clip(other));
            messages.error(card.place, message, "ADJUST is YES or NO");
            return;
        }
    };
    for data in &card.data {
        let one = Card {
            data: vec![data.clone()],
            ..card.clone()
        };
        let Some((slave, master)) = surfaces(reader, &one) else {
            continue;
        };
        let name = card.get("NAME").map_or_else(
            || format!("TIE-{}", reader.deck.connectors.ties.len() + 1),
            str::to_string,
        );
        reader.deck.connectors.ties.push(Tie {
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
