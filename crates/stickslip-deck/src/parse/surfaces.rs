//! Surfaces: faces of elements, or nodes.

use std::collections::BTreeSet;

use super::fields::Nodes;
use super::reader::Reader;
use crate::card::{Card, Data, Place};
use crate::deck::{Surface, SurfaceParts};
use crate::text::{clip, squeeze};

impl Reader<'_> {
    /// `S3` or `P3` as 3.
    pub(super) fn face(&mut self, text: &str, letter: char, place: Place) -> Option<usize> {
        let text = squeeze(text);
        // Sides of shells and membranes.
        let side = matches!(text.as_str(), "SPOS" | "SNEG" | "SP" | "SN") && letter == 'S';
        let text = if side { "S1".to_string() } else { text };
        let n = text
            .strip_prefix(letter)
            .and_then(|n| n.parse().ok())
            .filter(|n| (1..=6).contains(n));
        if n.is_none() {
            let message = format!("`{}` is no face", clip(&text));
            self.error(
                place,
                message,
                &format!("faces of elements are {letter}1 to {letter}6"),
            );
        }
        n
    }

    /// Faces of elements, of which those without a number are all that lie outside.
    fn faces_of(&mut self, card: &Card) -> Vec<(u64, Option<usize>)> {
        let mut faces = Vec::new();
        for data in &card.data {
            let Some(first) = data.fields.first() else {
                continue;
            };
            let elements = self.elements_of(first, data.place);
            let face = match data.fields.get(1).filter(|f| !f.is_empty()) {
                Some(text) => match self.face(&text.clone(), 'S', data.place) {
                    Some(n) => Some(n),
                    None => continue,
                },
                None => None,
            };
            for e in elements {
                if face.is_none_or(|f| self.has_face(e, f, data.place)) {
                    faces.push((e, face));
                }
            }
        }
        faces
    }

    fn nodes_of(&mut self, card: &Card) -> Vec<u64> {
        let mut nodes = Vec::new();
        for data in &card.data {
            let Some(field) = data.fields.first() else {
                continue;
            };
            match self.named_nodes(field, self.name(field)) {
                Nodes::One(n) => nodes.push(n),
                Nodes::Absent(n) => self.error(
                    data.place,
                    format!("there is no node {}", self.deck.label(n)),
                    "*NODE must stand before what refers to it",
                ),
                Nodes::Set(name) => nodes.extend(&self.deck.node_sets[&name]),
                Nodes::NoSet => self.error(
                    data.place,
                    format!("there is no set of nodes {}", clip(field)),
                    "define it with *NSET before",
                ),
            }
        }
        nodes
    }

    pub(super) fn surface(&mut self, card: &Card) {
        let Some(name) = self.required_name(card, "NAME") else {
            return;
        };
        if let Some(how) = card.get("COMBINE").map(str::to_string) {
            self.combine(card, name, &how);
            return;
        }
        let outside = |d: &Data| d.fields.len() < 2;
        if card.get("TRIM") == Some("YES") && card.data.iter().any(outside) {
            self.error(
                card.place,
                "*SURFACE, TRIM=YES is not supported",
                "name the faces (S1 to S6) that are meant",
            );
        }
        let parts = match card.get("TYPE").unwrap_or("ELEMENT") {
            "" | "ELEMENT" => SurfaceParts::Faces(self.faces_of(card)),
            "NODE" => SurfaceParts::Nodes(self.nodes_of(card)),
            other => {
                let message = format!("*SURFACE of type {other} is not supported");
                self.error(card.place, message, "surfaces are of type ELEMENT or NODE; a rigid surface can be a *RIGID BODY of elements");
                return;
            }
        };
        let empty = match &parts {
            SurfaceParts::Faces(f) => f.is_empty(),
            SurfaceParts::Nodes(n) => n.is_empty(),
        };
        if empty && self.sound() {
            self.error(
                card.place,
                format!("the surface {name} is empty"),
                "name faces of elements, or nodes with TYPE=NODE",
            );
        }
        self.put_surface(card, name, parts);
    }

    fn put_surface(&mut self, card: &Card, name: String, parts: SurfaceParts) {
        let surface = Surface {
            parts,
            place: card.place,
        };
        if self.deck.surfaces.insert(name.clone(), surface).is_some() {
            self.error(
                card.place,
                format!("the surface {name} is given twice"),
                "give each surface a name of its own",
            );
        }
    }

    /// A surface of the faces or nodes of others: of all, of those that all have, or of the first without those of the rest.
    fn combine(&mut self, card: &Card, name: String, how: &str) {
        let mut all = Vec::new();
        for field in card.data.iter().flat_map(|d| &d.fields) {
            let part = self.name(field);
            let Some(surface) = self.deck.surfaces.get(&part) else {
                let message = format!("there is no surface {}", clip(field));
                self.error(
                    card.place,
                    message,
                    "define it with *SURFACE before it is combined with others",
                );
                return;
            };
            all.push(surface.parts.clone());
        }
        let combined = match how {
            "UNION" => joined(&all, |_, _| true, true),
            "INTERSECTION" => joined(&all, |i, n| i == n, false),
            "DIFFERENCE" => joined(&all, |i, _| i == 1, false),
            _ => {
                let message = format!("*SURFACE, COMBINE={} is not known", clip(how));
                let help = "COMBINE is UNION, INTERSECTION or DIFFERENCE";
                self.error(card.place, message, help);
                return;
            }
        };
        match combined {
            Some(parts) => self.put_surface(card, name, parts),
            None => self.error(
                card.place,
                format!("the surfaces that {name} combines do not go together, or nothing is left of them"),
                "name surfaces of faces with numbers, or of nodes",
            ),
        }
    }
}

/// The members of surfaces of one kind: of the first surface, or of any, those that so many of all surfaces have. Faces without numbers are not known yet.
fn joined(
    all: &[SurfaceParts],
    wanted: impl Fn(usize, usize) -> bool,
    any: bool,
) -> Option<SurfaceParts> {
    fn members<T: Clone + PartialEq + Ord>(
        all: &[Vec<T>],
        wanted: impl Fn(usize, usize) -> bool,
        any: bool,
    ) -> Option<Vec<T>> {
        let sets: Vec<BTreeSet<&T>> = all.iter().map(|l| l.iter().collect()).collect();
        let from = if any { all } else { all.get(..1)? };
        let mut seen = BTreeSet::new();
        let kept = from.iter().flatten().filter(|m| {
            let count = sets.iter().filter(|s| s.contains(m)).count();
            wanted(count, sets.len()) && seen.insert(*m)
        });
        let kept: Vec<T> = kept.cloned().collect();
        (!kept.is_empty()).then_some(kept)
    }
    let mut faces = Vec::new();
    let mut nodes = Vec::new();
    for parts in all {
        match parts {
            SurfaceParts::Faces(list) => faces.push(list.clone()),
            SurfaceParts::Nodes(list) => nodes.push(list.clone()),
        }
    }
    let open = faces.iter().flatten().any(|(_, face)| face.is_none());
    match (faces.is_empty(), nodes.is_empty()) {
        (false, true) if any || !open => members(&faces, wanted, any).map(SurfaceParts::Faces),
        (true, false) => members(&nodes, wanted, any).map(SurfaceParts::Nodes),
        _ => None,
    }
}
