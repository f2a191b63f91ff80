//! Names that may stand before what they name: they are looked up at the end.

use std::collections::{BTreeMap, BTreeSet};

use super::known::{absent, listing};
use super::orientation;
use super::reader::Reader;
use crate::card::Place;
use crate::deck::{Action, Adjust, Boundary, Deck, Distributed, Target, Temperature, Tied};

/// Names that are missing: where, what, and what there is.
struct Missing<'a> {
    deck: &'a Deck,
    found: Vec<(Place, String, String)>,
}

/// Looks all names up.
pub(super) fn check_names(reader: &mut Reader) {
    settle_orientations(reader);
    orientation::settle_distributions(reader);
    let messages = &mut reader.messages;
    let mut missing = Missing {
        deck: &reader.deck,
        found: Vec::new(),
    };
    missing.nodes();
    missing.surfaces();
    missing.sections();
    missing.actions();
    let mut said = BTreeSet::new();
    for (place, message, help) in missing.found {
        // What a part lacks its instances lack as well.
        if said.insert((place, reader.scope.without_instances(&message))) {
            messages.error(place, message, &help);
        }
    }
    messages.sort_errors();
}

/// Sections of an instance have the orientation of the instance, or one of the model.
fn settle_orientations(reader: &mut Reader) {
    let sections = reader
        .deck
        .properties
        .sections
        .iter_mut()
        .filter_map(|s| s.orientation.as_mut());
    let couplings = reader
        .deck
        .connectors
        .couplings
        .iter_mut()
        .filter_map(|c| c.orientation.as_mut());
    for o in sections.chain(couplings) {
        let bare = reader.scope.numbering.bare(o);
        if !reader.deck.properties.orientations.contains_key(o)
            && reader.deck.properties.orientations.contains_key(bare)
        {
            *o = bare.to_string();
        }
    }
}

/// Which nodes there are where one is missing.
fn nodes_of(deck: &Deck, number: u64) -> String {
    let instance = deck.numbering.parts(number).0;
    let index = instance.and_then(|i| deck.numbering.find(i));
    let span = deck.numbering.span(index, 0, u64::MAX);
    let all = span.and_then(|(a, b)| {
        let mut all = deck.nodes.range(a..=b).map(|(n, _)| *n);
        let first = all.next()?;
        Some((first, all.next_back().unwrap_or(first)))
    });
    match (instance, all) {
        (Some(instance), Some((first, last))) => format!(
            "the nodes of the instance {instance} run from {} to {}",
            deck.label(first),
            deck.label(last)
        ),
        (None, None) if !deck.numbering.instances().is_empty() => {
            "outside of instances there are no nodes: write instance.number".into()
        }
        _ => "nodes are given by *NODE".into(),
    }
}

impl Missing<'_> {
    /// A node, or a set of nodes.
    fn target(&mut self, target: &Target, place: Place) {
        let deck = self.deck;
        let (message, help) = match target {
            Target::One(n) if !deck.nodes.contains_key(n) => (
                format!("there is no node {}", deck.label(*n)),
                nodes_of(deck, *n),
            ),
            Target::Set(s) if !deck.node_sets.contains_key(s) => {
                absent(&deck.numbering, "set of nodes", s, deck.node_sets.keys())
            }
            _ => return,
        };
        self.found.push((place, message, help));
    }

    /// Something with a name, of those that are known.
    fn named<T>(&mut self, what: &str, name: &str, place: Place, known: &BTreeMap<String, T>) {
        if !known.contains_key(name) {
            let (message, help) = absent(&self.deck.numbering, what, name, known.keys());
            self.found.push((place, message, help));
        }
    }

    fn surface(&mut self, name: &str, place: Place) {
        self.named("surface", name, place, &self.deck.surfaces);
    }

    fn interaction(&mut self, name: &str, place: Place) {
        self.named(
            "surface interaction",
            name,
            place,
            &self.deck.contact.interactions,
        );
    }

    /// The surfaces of a contact pair.
    fn pair(&mut self, slave: &str, master: &str, place: Place) {
        let pairs = &self.deck.contact.pairs;
        if pairs.iter().any(|p| p.slave == slave && p.master == master) {
            return;
        }
        let turned = pairs.iter().any(|p| p.slave == master && p.master == slave);
        let help = match turned {
            true => format!("there is one of {master} and {slave}: the slave surface stands first"),
            false => {
                let all = pairs
                    .iter()
                    .map(|p| format!("{} and {}", p.slave, p.master));
                listing("contact pairs", all)
            }
        };
        let message = format!("no contact pair has the surfaces {slave} and {master}");
        self.found.push((place, message, help));
    }

    /// Nodes of everything.
    fn nodes(&mut self) {
        let deck = self.deck;
        for b in &deck.supports {
            self.target(&b.target, b.place);
        }
        for i in &deck.start.initial {
            self.target(&i.target, i.place);
        }
        for t in &deck.start.temperatures {
            self.target(&t.target, t.place);
        }
        for p in &deck.contact.pairs {
            if let Some(Adjust::Set(name)) = &p.adjust {
                self.target(&Target::Set(name.clone()), p.place);
            }
        }
        for e in &deck.connectors.equations {
            e.terms.iter().for_each(|t| self.target(&t.target, e.place));
        }
        for c in &deck.connectors.couplings {
            if let Tied::Nodes(list) = &c.tied {
                list.iter().for_each(|(t, _)| self.target(t, c.place));
            }
        }
        for a in deck.steps.iter().flat_map(|s| &s.actions) {
            match a {
                Action::Boundary(b) => self.target(&b.target, b.place),
                Action::Force { target, place, .. }
                | Action::RemoveEquations {
                    target: Some(target),
                    place,
                    ..
                } => self.target(target, *place),
                Action::Temperature { of, .. } => self.target(&of.target, of.place),
                Action::Motion(motion) => self.target(&motion.target, motion.place),
                _ => {}
            }
        }
    }

    /// Surfaces and interactions of pairs, ties and couplings.
    fn surfaces(&mut self) {
        for c in &self.deck.connectors.couplings {
            if let Tied::Surface(name) = &c.tied {
                self.surface(name, c.place);
            }
            if let Some(o) = &c.orientation {
                self.named(
                    "orientation",
                    o,
                    c.place,
                    &self.deck.properties.orientations,
                );
            }
        }
        for p in &self.deck.contact.pairs {
            self.surface(&p.slave, p.place);
            self.surface(&p.master, p.place);
            self.interaction(&p.interaction, p.place);
        }
        for p in &self.deck.connectors.pretensions {
            self.surface(&p.surface, p.place);
        }
        for t in &self.deck.connectors.ties {
            self.surface(&t.slave, t.place);
            self.surface(&t.master, t.place);
        }
    }

    /// Sets, materials and orientations of sections.
    fn sections(&mut self) {
        let deck = self.deck;
        for s in &deck.properties.sections {
            self.named("set of elements", &s.set, s.place, &deck.element_sets);
            self.named("material", &s.material, s.place, &deck.properties.materials);
            if let Some(o) = &s.orientation {
                self.named("orientation", o, s.place, &deck.properties.orientations);
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
                | Action::Temperature {
                    amplitude: Some(name),
                    of: Temperature { place, .. },
                }
                | Action::Force {
                    amplitude: Some(name),
                    place,
                    ..
                }
                | Action::Distributed {
                    amplitude: Some(name),
                    place,
                    ..
                } => self.named("amplitude", name, *place, &deck.tables.amplitudes),
                Action::ChangeFriction(name, _, place) | Action::ChangeBehavior(name, _, place) => {
                    self.interaction(name, *place);
                }
                Action::ChangePair {
                    slave,
                    master,
                    place,
                    ..
                } => self.pair(slave, master, *place),
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
