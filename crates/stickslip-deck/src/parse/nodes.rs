//! Nodes, their axes and normals.

use super::fields::Nodes;
use super::reader::Reader;
use super::sets::add;
use crate::card::Card;
use crate::deck::Transform;

impl Reader<'_> {
    pub(super) fn nodes(&mut self, card: &Card) {
        if card
            .get("SYSTEM")
            .is_some_and(|s| !s.is_empty() && s != "R")
        {
            self.error(
                card.place,
                "*NODE: only rectangular coordinates are read",
                "give x, y and z",
            );
        }
        let mut set = Vec::new();
        for data in &card.data {
            let Some(id) = self.whole(data, 0) else {
                continue;
            };
            let x = [1, 2, 3].map(|i| self.number(data, i, 0.0));
            if let Some(before) = self.deck.nodes.insert(id, x)
                && before != x
            {
                self.warn(
                    data.place,
                    format!("node {id} is given twice; the last one counts"),
                    "",
                );
            }
            set.push(id);
        }
        if let Some(name) = card.get("NSET") {
            add(
                self.deck.node_sets.entry(name.to_string()).or_default(),
                set,
            );
        }
    }

    /// Normals of nodes are for shells and beams, unless they are those of contact.
    pub(super) fn normal(&mut self, card: &Card) {
        match card.get("TYPE").unwrap_or("ELEMENT") {
            "CONTACTSURFACE" => self.error(
                card.place,
                "normals of contact surfaces are those of their faces",
                "leave *NORMAL, TYPE=CONTACT SURFACE out, or refine the mesh",
            ),
            _ => self.note(
                card.place,
                format!(
                    "{} is left out: normals at nodes are for shells and beams",
                    card.written
                ),
            ),
        }
    }

    pub(super) fn transform(&mut self, card: &Card) {
        let Some(set) = self.required(card, "NSET") else {
            return;
        };
        let cylindrical = match card.get("TYPE").unwrap_or("R") {
            "R" | "" => false,
            "C" => true,
            other => {
                self.error(
                    card.place,
                    format!("*TRANSFORM of type {other} is not supported"),
                    "types are R (rectangular) and C (cylindrical)",
                );
                return;
            }
        };
        let Some(data) = self.line(card) else { return };
        let v: Vec<f64> = (0..6).map(|i| self.number(data, i, 0.0)).collect();
        let transform = Transform {
            cylindrical,
            a: [v[0], v[1], v[2]],
            b: [v[3], v[4], v[5]],
        };
        let nodes = match self.named_nodes(&set, set.clone()) {
            Nodes::One(n) | Nodes::Absent(n) => vec![n],
            Nodes::Set(name) => self.deck.node_sets[&name].clone(),
            Nodes::NoSet => {
                self.error(
                    card.place,
                    format!("there is no set of nodes {set}"),
                    "*NSET must stand before *TRANSFORM",
                );
                return;
            }
        };
        for n in nodes {
            self.deck.transforms.insert(n, transform);
        }
    }
}
