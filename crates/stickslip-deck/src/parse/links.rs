//! What ties nodes together or acts between them: equations, rigid bodies, pretensions, springs; and masses.

use super::reader::Reader;
use crate::card::Card;
use crate::deck::{Action, Equation, GapSection, Pretension, Rigid, SpringSection, Term};
use crate::text::clip;

impl Reader<'_> {
    pub(super) fn equation(&mut self, card: &Card) {
        if card.has("REMOVE") || card.has("REMOVEALL") {
            self.remove_equations(card);
            return;
        }
        if self.position.in_step {
            self.error(
                card.place,
                "equations begin before the first step",
                "give *EQUATION before the first *STEP; *EQUATION, REMOVE in a step ends them",
            );
            return;
        }
        let mut lines = card.data.iter();
        while let Some(data) = lines.next() {
            let Some(count) = self.whole(data, 0) else {
                return;
            };
            let mut terms = Vec::new();
            while (terms.len() as u64) < count {
                let Some(line) = lines.next() else {
                    self.error(
                        data.place,
                        format!("the equation has {} of its {count} terms", terms.len()),
                        "each term is node, direction, factor",
                    );
                    return;
                };
                for k in (0..line.fields.len()).step_by(3) {
                    let (Some(target), Some(component)) =
                        (self.target(line, k), self.direction(line, k + 1, 6))
                    else {
                        return;
                    };
                    let factor = self.number(line, k + 2, 0.0);
                    terms.push(Term {
                        target,
                        component,
                        factor,
                    });
                }
            }
            if terms.len() as u64 != count {
                self.error(
                    data.place,
                    format!("the equation has {} terms instead of {count}", terms.len()),
                    "each term is node, direction, factor",
                );
                return;
            }
            if terms.first().is_some_and(|t| t.factor == 0.0) {
                self.error(
                    data.place,
                    "the first factor of the equation is zero",
                    "the first term is the one that the others determine",
                );
            }
            self.deck.connectors.equations.push(Equation {
                terms,
                place: data.place,
            });
        }
    }

    /// Equations that hold no longer from this step on.
    fn remove_equations(&mut self, card: &Card) {
        if self.own_step(card).is_none() {
            return;
        }
        let all = card.has("REMOVEALL") || card.get("REMOVE") == Some("ALL");
        if all {
            self.only(card, 0, &[]);
            self.act(Action::RemoveEquations {
                target: None,
                components: Vec::new(),
                place: card.place,
            });
            return;
        }
        if card.data.is_empty() {
            self.line(card);
        }
        for data in &card.data {
            let (Some(target), Some(first)) = (self.target(data, 0), self.direction(data, 1, 3))
            else {
                continue;
            };
            let last = match data.fields.get(2).filter(|f| !f.is_empty()) {
                Some(_) => self.direction(data, 2, 3).unwrap_or(first),
                None => first,
            };
            self.no_more(data, 3, "*EQUATION, REMOVE");
            self.act(Action::RemoveEquations {
                target: Some(target),
                components: (first..=last).collect(),
                place: data.place,
            });
        }
    }

    pub(super) fn rigid_body(&mut self, card: &Card) {
        if card.get("POSITION").is_some_and(|p| p != "INPUT") {
            self.error(
                card.place,
                "*RIGID BODY: the reference node stays where it is",
                "write POSITION=INPUT, and give the node the place that is meant",
            );
        }
        let reference = self.single_node(card, "REFNODE");
        let rotation = self.single_node(card, "ROTNODE");
        let rigid = Rigid {
            elements: card.get("ELSET").map(|s| self.scoped(s)),
            nodes: card.get("NSET").map(|s| self.scoped(s)),
            reference,
            rotation,
            place: card.place,
        };
        self.deck.connectors.rigid.push(rigid);
    }

    /// A parameter that names a node, by its number or by a set of one.
    pub(super) fn single_node(&mut self, card: &Card, name: &str) -> Option<u64> {
        let text = card.get(name)?;
        let of_set = |set: &Vec<u64>| match set.as_slice() {
            [one] => Some(*one),
            _ => None,
        };
        let set = || self.deck.node_sets.get(&self.scoped(text)).and_then(of_set);
        let id = self.number_of(text).or_else(set);
        if id.is_none_or(|n| !self.deck.nodes.contains_key(&n)) {
            self.error(
                card.place,
                format!(
                    "{}: {name} is {}, which is no node",
                    card.written,
                    clip(text)
                ),
                "give the number of a node that exists",
            );
            return None;
        }
        id
    }

    pub(super) fn pretension(&mut self, card: &Card) {
        let surface = self.required_name(card, "SURFACE");
        if card.get("NODE").is_none() {
            self.required(card, "NODE");
        }
        let node = self.single_node(card, "NODE");
        let mut normal = None;
        if let Some(data) = card.data.first() {
            let given: [f64; 3] = std::array::from_fn(|i| self.number(data, i, 0.0));
            normal = (given != [0.0; 3]).then(|| self.motion().vector(given));
        }
        let (Some(surface), Some(node)) = (surface, node) else {
            return;
        };
        if self.deck.pretension(node).is_some() {
            self.error(
                card.place,
                format!("node {} has a pretension already", self.deck.label(node)),
                "give every *PRE-TENSION SECTION a node of its own",
            );
        }
        self.deck.connectors.pretensions.push(Pretension {
            surface,
            node,
            normal,
            place: card.place,
        });
    }

    /// Stiffnesses of springs, or coefficients of dashpots.
    pub(super) fn spring(&mut self, card: &Card) {
        let Some(set) = self.required_name(card, "ELSET") else {
            return;
        };
        let damper = card.keyword == "DASHPOT";
        let (thing, constant) = match damper {
            true => ("a dashpot", "coefficient"),
            false => ("a spring", "stiffness"),
        };
        let kind = self
            .elements_named(&set, &set, card.place)
            .first()
            .map(|e| self.deck.elements[e].kind.clone());
        // The first line has directions; for SPRINGA it is empty, and empty lines are not kept.
        let (mut directions, mut data) = (Vec::new(), card.data.as_slice());
        let along_axes = ["SPRING1", "SPRING2", "DASHPOT1", "DASHPOT2"];
        if kind.as_deref().is_some_and(|k| along_axes.contains(&k)) {
            let Some(line) = self.line(card) else { return };
            for i in 0..line.fields.len() {
                directions.extend(self.direction(line, i, 3));
            }
            data = &data[1..];
        }
        // An empty line of directions has survived as one without fields.
        let mut data = data.iter().filter(|d| !d.fields.is_empty());
        let (line, more) = (data.next(), data.next());
        if let Some(more) = more {
            self.error(
                more.place,
                format!("{thing} has one {constant}"),
                &format!("they are linear and depend on neither frequency nor temperature: give one {constant}"),
            );
        }
        let Some(line) = line else {
            self.error(
                card.place,
                format!("{} has no {constant}", card.written),
                &format!("the line after the directions has the {constant}"),
            );
            return;
        };
        let stiffness = self.number(line, 0, 0.0);
        let section = SpringSection {
            set,
            directions,
            stiffness,
            place: card.place,
        };
        match damper {
            true => self.deck.connectors.dashpots.push(section),
            false => self.deck.connectors.springs.push(section),
        }
    }

    pub(super) fn gap(&mut self, card: &Card) {
        let Some(set) = self.required_name(card, "ELSET") else {
            return;
        };
        self.elements_named(&set, &set, card.place);
        let Some(line) = self.line(card) else { return };
        let v: Vec<f64> = (0..7).map(|i| self.number(line, i, 0.0)).collect();
        let given = [v[1], v[2], v[3]];
        let direction = stickslip::math::normalize(given).unwrap_or_default();
        let length = stickslip::math::norm(given);
        if length > 0.0 && (length - 1.0).abs() > 1e-3 {
            self.warn(
                line.place,
                format!(
                    "the direction of the gap has the length {length:.4}: it is taken with length 1"
                ),
                "write a direction of length 1",
            );
        }
        if v[6] > 0.0 {
            self.warn(
                line.place,
                "the tension of open gaps is left out: force begins where a gap closes, and grows with the stiffness",
                "leave the last field out, or make it small against the forces",
            );
        }
        self.deck.connectors.gaps.push(GapSection {
            set,
            clearance: v[0],
            direction,
            stiffness: Some(v[5]).filter(|k| *k > 0.0),
            place: card.place,
        });
    }

    pub(super) fn mass(&mut self, card: &Card) {
        let Some(set) = self.required_name(card, "ELSET") else {
            return;
        };
        self.elements_named(&set, &set, card.place);
        let Some(line) = self.line(card) else { return };
        let mass = self.number(line, 0, 0.0);
        if mass < 0.0 {
            self.error(
                line.place,
                "the mass is negative",
                "write the mass of each point",
            );
        }
        self.deck.connectors.masses.push((set, mass, card.place));
    }
}
