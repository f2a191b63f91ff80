//! Names that may stand before what they name: they are looked up at the end.

use std::collections::BTreeMap;

use super::fields::listing;
use super::reader::Reader;
use crate::card::Place;
use crate::deck::{Action, Adjust, Boundary, Deck, Distributed, Target};

/// Names that are missing: where, what, and what there is.
struct Missing<'a> {
    deck: &'a Deck,
    found: Vec<(Place, String, String)>,
}

impl Reader<'_> {
    /// Looks all names up.
    pub(super) fn check_names(&mut self) {
        let mut missing = Missing {
            deck: &self.deck,
            found: Vec::new(),
        };
        missing.nodes();
        missing.surfaces();
        missing.sections();
        missing.actions();
        for (place, message, help) in missing.found {
            self.error(place, message, &help);
        }
        self.errors.sort_by_key(|f| {
            self.source
                .files
                .iter()
                .position(|p| *p == f.file)
                .map(|p| (p, f.line))
        });
    }
}

impl Missing<'_> {
    /// A node, or a set of nodes.
    fn target(&mut self, target: &Target, place: Place) {
        let (what, help) = match target {
            Target::One(n) if !self.deck.nodes.contains_key(n) => {
                (format!("node {n}"), "nodes are given by *NODE".into())
            }
            Target::Set(s) if !self.deck.node_sets.contains_key(s) => (
                format!("set of nodes {s}"),
                listing("sets of nodes", self.deck.node_sets.keys()),
            ),
            _ => return,
        };
        self.found
            .push((place, format!("there is no {what}"), help));
    }

    /// Something with a name, of those that are known.
    fn named<T>(&mut self, what: &str, name: &str, place: Place, known: &BTreeMap<String, T>) {
        if !known.contains_key(name) {
            self.found.push((
                place,
                format!("there is no {what} {name}"),
                listing(&format!("known {what}s"), known.keys()),
            ));
        }
    }

    fn surface(&mut self, name: &str, place: Place) {
        self.named("surface", name, place, &self.deck.surfaces);
    }

    fn interaction(&mut self, name: &str, place: Place) {
        self.named("surface interaction", name, place, &self.deck.interactions);
    }

    /// Nodes of everything.
    fn nodes(&mut self) {
        let deck = self.deck;
        for b in &deck.supports {
            self.target(&b.target, b.place);
        }
        for i in &deck.initial {
            self.target(&i.target, i.place);
        }
        for t in &deck.temperatures {
            self.target(&t.target, t.place);
        }
        for p in &deck.pairs {
            if let Some(Adjust::Set(name)) = &p.adjust {
                self.target(&Target::Set(name.clone()), p.place);
            }
        }
        for e in &deck.equations {
            e.terms.iter().for_each(|t| self.target(&t.target, e.place));
        }
        for a in deck.steps.iter().flat_map(|s| &s.actions) {
            match a {
                Action::Boundary(b) => self.target(&b.target, b.place),
                Action::Force { target, place, .. } => self.target(target, *place),
                _ => {}
            }
        }
    }

    /// Surfaces and interactions of pairs and ties.
    fn surfaces(&mut self) {
        for p in &self.deck.pairs {
            self.surface(&p.slave, p.place);
            self.surface(&p.master, p.place);
            self.interaction(&p.interaction, p.place);
        }
        for t in &self.deck.ties {
            self.surface(&t.slave, t.place);
            self.surface(&t.master, t.place);
        }
    }

    /// Sets, materials and orientations of sections.
    fn sections(&mut self) {
        let deck = self.deck;
        for s in &deck.sections {
            self.named("set of elements", &s.set, s.place, &deck.element_sets);
            self.named("material", &s.material, s.place, &deck.materials);
            if let Some(o) = &s.orientation {
                self.named("orientation", o, s.place, &deck.orientations);
            }
        }
    }

    /// Amplitudes, interactions and surfaces of what acts in steps.
    fn actions(&mut self) {
        let deck = self.deck;
        for a in deck.steps.iter().flat_map(|s| &s.actions) {
            match a {
                Action::Boundary(Boundary {
                    amplitude: Some(name),
                    place,
                    ..
                })
                | Action::Force {
                    amplitude: Some(name),
                    place,
                    ..
                }
                | Action::Distributed {
                    amplitude: Some(name),
                    place,
                    ..
                } => self.named("amplitude", name, *place, &deck.amplitudes),
                Action::ChangeFriction(name, _, place) | Action::ChangeBehavior(name, _, place) => {
                    self.interaction(name, *place);
                }
                _ => {}
            }
            if let Action::Distributed {
                load: Distributed::Surface(name, _),
                place,
                ..
            } = a
            {
                self.surface(name, *place);
            }
        }
    }
}
