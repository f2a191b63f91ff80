//! Nodes, their axes and normals.

use stickslip::math::{cross, sub};

use super::fields::Nodes;
use super::reader::Reader;
use super::sets::add;
use crate::axes::{frame, polar};
use crate::card::Card;
use crate::deck::Transform;
use crate::motion::Motion;

impl Reader<'_> {
    pub(super) fn nodes(&mut self, card: &Card) {
        let round = match card.get("SYSTEM") {
            None | Some("" | "R") => false,
            Some("C") => true,
            Some(_) => {
                self.error(
                    card.place,
                    "*NODE: only rectangular and cylindrical coordinates are read",
                    "give x, y and z",
                );
                false
            }
        };
        let mut set = Vec::new();
        for data in &card.data {
            let Some(id) = self.own_number(data) else {
                self.messages.unread = true;
                continue;
            };
            let x = [1, 2, 3].map(|i| self.number(data, i, 0.0));
            let x = if round { polar(x) } else { x };
            let x = self.motion().point(self.system.point(x));
            if x.iter().any(|c| !c.is_finite()) {
                self.error(
                    data.place,
                    "the node lies too far away to be moved or turned",
                    "write the mesh near the origin, in units in which it is neither huge nor tiny",
                );
                self.messages.unread = true;
                continue;
            }
            if let Some(before) = self.deck.nodes.insert(id, x)
                && before != x
            {
                self.warn(
                    data.place,
                    format!(
                        "node {} is given twice; the last one counts",
                        self.deck.label(id)
                    ),
                    "",
                );
            }
            set.push(id);
        }
        if let Some(name) = card.get("NSET") {
            let name = self.scoped(name);
            add(self.deck.node_sets.entry(name).or_default(), set);
        }
    }

    /// Axes for the coordinates of the nodes that follow: origin, a point on x, a point in the plane of x and y. Without lines they are the global ones.
    pub(super) fn system(&mut self, card: &Card) {
        self.system = Motion::NONE;
        let Some(first) = card.data.first() else {
            return;
        };
        let a = [0, 1, 2].map(|i| self.number(first, i, 0.0));
        if first.fields.len() <= 3 {
            self.system = Motion::by(a);
            return;
        }
        let b = [3, 4, 5].map(|i| self.number(first, i, 0.0));
        let x = sub(b, a);
        let y = match card.data.get(1) {
            Some(second) => sub([0, 1, 2].map(|i| self.number(second, i, 0.0)), a),
            // The local z axis is the global one.
            None => cross([0.0, 0.0, 1.0], x),
        };
        let beyond = card
            .data
            .get(2)
            .or(card.data.get(1).filter(|d| d.fields.len() > 3));
        match (frame(x, y), beyond) {
            (Some(axes), None) => self.system = Motion::from_axes(axes, a),
            (None, _) => self.error(
                first.place,
                "*SYSTEM: the points do not span a plane",
                "write the origin and a point on the x axis, and in the next line a point in the xy plane beside it",
            ),
            (_, Some(more)) => self.error(
                more.place,
                "*SYSTEM: this line is not read",
                "the lines are: ax, ay, az, bx, by, bz; cx, cy, cz",
            ),
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
        // Those of a part go with its instance: points of an axis move, directions turn.
        let motion = self.motion();
        let [a, b] = [[v[0], v[1], v[2]], [v[3], v[4], v[5]]].map(|x| match cylindrical {
            true => motion.point(x),
            false => motion.vector(x),
        });
        let transform = Transform { cylindrical, a, b };
        let nodes = match self.named_nodes(&set, self.scoped(&set)) {
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
            self.deck.properties.transforms.insert(n, transform);
        }
    }
}
