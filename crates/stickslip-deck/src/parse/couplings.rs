//! What ties many nodes together: couplings to a reference node, and multi-point constraints.

use super::reader::Reader;
use crate::card::{Card, Data};
use crate::deck::{MultiPoint, NodeCoupling, Target, Tied, Way};
use crate::text::{clip, squeeze, whole};

/// Types of `*MPC`.
const TYPES: [&str; 8] = [
    "BEAM", "DIST", "LINK", "MEANROT", "PIN", "PLANE", "STRAIGHT", "TIE",
];

impl Reader<'_> {
    pub(super) fn coupling(&mut self, card: &Card) {
        if self.required(card, "REFNODE").is_none() {
            return;
        }
        let Some(surface) = self.required_name(card, "SURFACE") else {
            return;
        };
        let Some(reference) = self.single_node(card, "REFNODE") else {
            return;
        };
        let count = self.deck.connectors.couplings.len() + 1;
        let name = card.get("CONSTRAINTNAME");
        self.deck.connectors.couplings.push(NodeCoupling {
            name: name.map_or_else(|| format!("COUPLING-{count}"), str::to_string),
            reference,
            tied: Tied::Surface(surface),
            way: None,
            components: [false; 6],
            orientation: card.get("ORIENTATION").map(|o| self.scoped(o)),
            place: card.place,
        });
    }

    /// `*KINEMATIC` or `*DISTRIBUTING` beneath a `*COUPLING`.
    pub(super) fn way(&mut self, card: &Card, way: Way) {
        if way == Way::Distributing
            && let Some(method) = card.get("WEIGHTINGMETHOD")
            && method != "UNIFORM"
        {
            self.error(
                card.place,
                format!("weights of the method {} are not known", clip(method)),
                "leave WEIGHTING METHOD out: nodes count by their area",
            );
        }
        let mut components = [card.data.is_empty(); 6];
        for data in &card.data {
            let Some(range) = self.directions(data, 0) else {
                return;
            };
            components[range].fill(true);
        }
        let last = self.deck.connectors.couplings.last_mut();
        match last.filter(|c| c.way.is_none()) {
            Some(coupling) => {
                coupling.way = Some(way);
                coupling.components = components;
            }
            None => self.error(
                card.place,
                format!("{} belongs to no *COUPLING", card.written),
                "it stands right after the *COUPLING whose kind it is",
            ),
        }
    }

    /// Directions from one field to the next, from 0; the last is the first if it is not given.
    fn directions(&mut self, data: &Data, field: usize) -> Option<std::ops::Range<usize>> {
        let first = self.direction(data, field, 6)?;
        let last = match data.fields.get(field + 1).filter(|f| !f.is_empty()) {
            Some(_) => self.direction(data, field + 1, 6)?,
            None => first,
        };
        if last < first {
            self.error(
                data.place,
                "the last direction lies before the first",
                "write first direction, last direction",
            );
            return None;
        }
        Some(first..last + 1)
    }

    pub(super) fn kinematic_coupling(&mut self, card: &Card) {
        if self.required(card, "REFNODE").is_none() {
            return;
        }
        let Some(reference) = self.single_node(card, "REFNODE") else {
            return;
        };
        for data in &card.data {
            let Some(target) = self.target(data, 0) else {
                return;
            };
            let range = match data.fields.get(1).filter(|f| !f.is_empty()) {
                None => 0..6,
                Some(_) => match self.directions(data, 1) {
                    Some(range) => range,
                    None => return,
                },
            };
            let mut components = [false; 6];
            components[range].fill(true);
            self.deck.connectors.couplings.push(NodeCoupling {
                name: format!("COUPLING-{}", self.deck.connectors.couplings.len() + 1),
                reference,
                tied: Tied::Nodes(vec![(target, 1.0)]),
                way: Some(Way::Kinematic),
                components,
                orientation: card.get("ORIENTATION").map(|o| self.scoped(o)),
                place: data.place,
            });
        }
    }

    pub(super) fn distributing_coupling(&mut self, card: &Card) {
        let Some(set) = self.required_name(card, "ELSET") else {
            return;
        };
        let elements = self.elements_named(&set, &set, card.place);
        let node = |e: &u64| {
            let e = &self.deck.elements[e];
            e.kind.starts_with("DCOUP").then(|| e.nodes[0])
        };
        let [Some(reference)] = elements.iter().map(node).collect::<Vec<_>>()[..] else {
            self.error(
                card.place,
                format!("the set {} is not one element of type DCOUP3D", clip(&set)),
                "the node of that element is the reference node",
            );
            return;
        };
        let mut nodes = Vec::new();
        for data in &card.data {
            let Some(target) = self.target(data, 0) else {
                return;
            };
            let weight = self.number(data, 1, 1.0);
            if weight < 0.0 {
                self.error(
                    data.place,
                    "the weight is negative",
                    "weights are 0 or more",
                );
            }
            nodes.push((target, weight));
        }
        self.deck.connectors.couplings.push(NodeCoupling {
            name: set,
            reference,
            tied: Tied::Nodes(nodes),
            way: Some(Way::Distributing),
            components: [true; 6],
            orientation: None,
            place: card.place,
        });
    }

    pub(super) fn multi_point(&mut self, card: &Card) {
        for data in &card.data {
            let first = squeeze(data.fields.first().map_or("", String::as_str));
            let goes_on = first.is_empty() || whole(&first).is_some() || first == "0";
            let zero = first.is_empty() || first == "0";
            let mut nodes = Vec::new();
            let from = usize::from(!goes_on || zero);
            for field in from..data.fields.len() {
                let text = &data.fields[field];
                if text.is_empty() || text == "0" {
                    continue;
                }
                match self.target(data, field) {
                    Some(Target::One(n)) if self.deck.nodes.contains_key(&n) => nodes.push(n),
                    Some(Target::Set(s)) if self.deck.node_sets.contains_key(&s) => {
                        nodes.extend(&self.deck.node_sets[&s]);
                    }
                    _ => {
                        self.error(
                            data.place,
                            format!("there is no node and no set of nodes {}", clip(text)),
                            "write the type, then nodes or sets of nodes",
                        );
                        return;
                    }
                }
            }
            if goes_on {
                match self.deck.connectors.constraints.last_mut() {
                    Some(last) if last.place.line >= card.place.line => last.nodes.extend(nodes),
                    _ => self.error(
                        data.place,
                        "the *MPC has no type",
                        "write the type, then nodes",
                    ),
                }
                continue;
            }
            if !TYPES.contains(&first.as_str()) {
                self.error(
                    data.place,
                    format!("*MPC of type {} is not supported", clip(&first)),
                    &format!(
                        "types are {}; *EQUATION says anything linear",
                        TYPES.join(", ")
                    ),
                );
                continue;
            }
            self.deck.connectors.constraints.push(MultiPoint {
                kind: first,
                nodes,
                place: data.place,
            });
        }
    }
}
