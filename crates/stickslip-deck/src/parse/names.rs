//! Names that may stand before what they name: they are looked up at the end.

use super::fields::listing;
use super::reader::Reader;
use crate::card::Place;
use crate::deck::{Action, Adjust, Boundary, Distributed, Target};

impl Reader<'_> {
    /// Names that may stand before what they name are looked up at the end.
    pub(super) fn check_names(&mut self) {
        let mut findings: Vec<(Place, String, String)> = Vec::new();
        let deck = &self.deck;
        let mut nodes = |target: &Target, place: Place| match target {
            Target::One(n) if !deck.nodes.contains_key(n) => {
                findings.push((
                    place,
                    format!("there is no node {n}"),
                    "nodes are given by *NODE".into(),
                ));
            }
            Target::Set(s) if !deck.node_sets.contains_key(s) => {
                findings.push((
                    place,
                    format!("there is no set of nodes {s}"),
                    listing("sets of nodes", deck.node_sets.keys()),
                ));
            }
            _ => {}
        };
        for b in &deck.supports {
            nodes(&b.target, b.place);
        }
        for i in &deck.initial {
            nodes(&i.target, i.place);
        }
        for t in &deck.temperatures {
            nodes(&t.target, t.place);
        }
        for p in &deck.pairs {
            if let Some(Adjust::Set(name)) = &p.adjust {
                nodes(&Target::Set(name.clone()), p.place);
            }
        }
        for e in &deck.equations {
            e.terms.iter().for_each(|t| nodes(&t.target, e.place));
        }
        for a in deck.steps.iter().flat_map(|s| &s.actions) {
            match a {
                Action::Boundary(b) => nodes(&b.target, b.place),
                Action::Force { target, place, .. } => nodes(target, *place),
                _ => {}
            }
        }
        let mut named = |what: &str, name: &str, place: Place, known: Vec<&String>| {
            if !known.iter().any(|k| *k == name) {
                findings.push((
                    place,
                    format!("there is no {what} {name}"),
                    listing(&format!("known {what}s"), known),
                ));
            }
        };
        let surfaces = || deck.surfaces.keys().collect::<Vec<_>>();
        for p in &deck.pairs {
            named("surface", &p.slave, p.place, surfaces());
            named("surface", &p.master, p.place, surfaces());
            named(
                "surface interaction",
                &p.interaction,
                p.place,
                deck.interactions.keys().collect(),
            );
        }
        for t in &deck.ties {
            named("surface", &t.slave, t.place, surfaces());
            named("surface", &t.master, t.place, surfaces());
        }
        for s in &deck.sections {
            named(
                "set of elements",
                &s.set,
                s.place,
                deck.element_sets.keys().collect(),
            );
            named(
                "material",
                &s.material,
                s.place,
                deck.materials.keys().collect(),
            );
            if let Some(o) = &s.orientation {
                named(
                    "orientation",
                    o,
                    s.place,
                    deck.orientations.keys().collect(),
                );
            }
        }
        let amplitudes = || deck.amplitudes.keys().collect::<Vec<_>>();
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
                } => named("amplitude", name, *place, amplitudes()),
                Action::ChangeFriction(name, _, place) | Action::ChangeBehavior(name, _, place) => {
                    named(
                        "surface interaction",
                        name,
                        *place,
                        deck.interactions.keys().collect(),
                    );
                }
                _ => {}
            }
            if let Action::Distributed {
                load: Distributed::Surface(name, _),
                place,
                ..
            } = a
            {
                named("surface", name, *place, surfaces());
            }
        }
        for (place, message, help) in findings {
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
