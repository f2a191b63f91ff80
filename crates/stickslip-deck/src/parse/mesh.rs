//! Nodes, elements, sets, surfaces, and what ties nodes together.

use stickslip::io::abaqus;

use super::{Reader, clip, parameter, whole};
use crate::deck::{
    Element, Equation, InitialCondition, Rigid, SpringSection, Surface, SurfaceParts, Term,
    TimePoints, Transform,
};
use crate::source::{Card, Data, Place, label, squeeze};

/// Numbers of nodes that elements have.
const NODES: [usize; 10] = [1, 2, 3, 4, 5, 6, 8, 10, 15, 20];

/// Nodes of element types that are not cells.
fn other_nodes(kind: &str) -> Option<usize> {
    match kind {
        "SPRINGA" | "SPRING2" => Some(2),
        "SPRING1" | "MASS" => Some(1),
        _ => None,
    }
}

/// Nodes of lines and faces, which generators of meshes write beside the cells that they bound.
fn bounding(kind: &str) -> Option<usize> {
    let (start, rest) = ["T2D", "T3D", "STRI", "S", "M3D", "B3", "B2"]
        .into_iter()
        .find_map(|start| Some((start, kind.strip_prefix(start)?)))?;
    let digits = rest.bytes().take_while(u8::is_ascii_digit).count();
    match (start, &rest[..digits]) {
        ("T2D" | "T3D", n @ ("2" | "3")) => n.parse().ok(),
        ("STRI", "3") => Some(3),
        ("STRI", "65") => Some(6),
        ("S" | "M3D", n @ ("3" | "4" | "6" | "8")) => n.parse().ok(),
        ("B2" | "B3", "1") => Some(2),
        ("B2" | "B3", "2") => Some(3),
        _ => None,
    }
}

impl Reader<'_> {
    /// Lines and faces without a section bound the cells beside them, and are there for their sets: Gmsh writes them. Without such cells,
    /// or with a section, they are meant to be computed.
    pub(super) fn judge_bounding(&mut self) {
        for (kind, place) in std::mem::take(&mut self.bounding) {
            let flat = kind.starts_with("T") || kind.starts_with("B");
            let cells = self.deck.elements.values().any(|e| {
                abaqus::element_type(&e.kind).is_ok_and(|t| flat || t.space == abaqus::Space::Solid)
            });
            let deck = &self.deck;
            let sectioned = deck.sections.iter().any(|s| {
                let mut all = deck.element_sets.get(&s.set).into_iter().flatten();
                all.any(|e| deck.elements.get(e).is_some_and(|e| e.kind == kind))
            });
            if cells && !sectioned {
                self.note(place, format!("elements of type {kind} have no section: they are taken as lines or faces of the cells, for their sets"));
            } else if let Err(why) = abaqus::element_type(&kind) {
                let message = format!("elements of type {kind} ({}) are not supported", why.what);
                self.error(place, message, why.help);
            }
        }
    }

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

    pub(super) fn elements(&mut self, card: &Card) {
        let Some(kind) = self.required(card, "TYPE") else {
            return;
        };
        let count = match (other_nodes(&kind), abaqus::element_type(&kind)) {
            (Some(n), _) => n,
            (None, Ok(t)) => {
                for note in &t.notes {
                    self.note(card.place, format!("{kind}: {note}"));
                }
                t.kind.node_count()
            }
            (None, Err(_)) if bounding(&kind).is_some() => {
                if !self.bounding.iter().any(|(k, _)| *k == kind) {
                    self.bounding.push((kind.clone(), card.place));
                }
                bounding(&kind).unwrap_or_default()
            }
            (None, Err(why)) => {
                let message = format!("elements of type {kind} ({}) are not supported", why.what);
                self.error(card.place, message, why.help);
                let ids = card.data.iter().filter_map(|d| whole(d.fields.first()?));
                self.skipped.extend(ids);
                self.skipped_sets
                    .extend(card.get("ELSET").map(str::to_string));
                return;
            }
        };
        let mut set = Vec::new();
        let mut forgiven = false;
        let mut lines = card.data.iter();
        while let Some(data) = lines.next() {
            let Some(id) = self.whole(data, 0) else {
                continue;
            };
            let mut nodes = Vec::with_capacity(count);
            self.members(data, 1, &mut nodes);
            // An element goes on until it has its nodes.
            while nodes.len() < count {
                let Some(more) = lines.next() else { break };
                self.members(more, 0, &mut nodes);
            }
            // CalculiX reads as many numbers as the type has nodes. As many as another type has say that the type is another.
            if nodes.len() > count && !NODES.contains(&nodes.len()) {
                if !forgiven {
                    let message = format!(
                        "{kind} has {count} nodes: further numbers in the lines of its elements are left out"
                    );
                    self.note(data.place, message);
                }
                forgiven = true;
                nodes.truncate(count);
            }
            if nodes.len() != count {
                let message = format!("element {id} has {} nodes; {kind} has {count}", nodes.len());
                self.error(
                    data.place,
                    message,
                    "an element goes on in the next line until it has all its nodes",
                );
                continue;
            }
            let missing = nodes
                .iter()
                .find(|n| !self.deck.nodes.contains_key(n))
                .copied();
            if let Some(n) = missing {
                self.error(
                    data.place,
                    format!("element {id} uses node {n}, which does not exist"),
                    "*NODE must stand before *ELEMENT",
                );
                continue;
            }
            let element = Element {
                kind: kind.clone(),
                nodes,
                place: data.place,
            };
            if self.deck.elements.insert(id, element).is_some() {
                self.error(
                    data.place,
                    format!("element {id} is given twice"),
                    "numbers of elements are unique in the whole deck",
                );
            }
            set.push(id);
        }
        if let Some(name) = card.get("ELSET") {
            add(
                self.deck.element_sets.entry(name.to_string()).or_default(),
                set,
            );
        }
    }

    fn members(&mut self, data: &Data, from: usize, out: &mut Vec<u64>) {
        for i in from..data.fields.len() {
            if let Some(n) = self.whole(data, i) {
                out.push(n);
            }
        }
    }

    /// `start, end, step` as those of the numbers that exist.
    fn generated<T>(
        &mut self,
        data: &Data,
        known: impl Fn(&Self) -> &std::collections::BTreeMap<u64, T>,
    ) -> Vec<u64> {
        let (Some(from), Some(to)) = (self.whole(data, 0), self.whole(data, 1)) else {
            return Vec::new();
        };
        let by = match data.fields.len() {
            0..=2 => 1,
            _ => self.whole(data, 2).unwrap_or(1),
        };
        if to < from {
            self.error(
                data.place,
                format!("the range runs from {from} down to {to}"),
                "write first, last, increment",
            );
            return Vec::new();
        }
        let all = known(self).range(from..=to).map(|(n, _)| *n);
        all.filter(|n| (n - from).is_multiple_of(by)).collect()
    }

    pub(super) fn node_set(&mut self, card: &Card) {
        let Some(name) = self.required(card, "NSET") else {
            return;
        };
        let mut out = Vec::new();
        if let Some(set) = card.get("ELSET").map(str::to_string) {
            // Elements share nodes, which is not meant to count.
            let mut of_cells = std::collections::BTreeSet::new();
            for e in self.elements_of(&set, card.place) {
                of_cells.extend(self.deck.elements[&e].nodes.iter().copied());
            }
            out.extend(of_cells);
        }
        for data in &card.data {
            if card.has("GENERATE") {
                out.extend(self.generated(data, |r| &r.deck.nodes));
                continue;
            }
            for field in data.fields.iter().filter(|f| !f.is_empty()) {
                match whole(field) {
                    Some(n) if self.deck.nodes.contains_key(&n) => out.push(n),
                    Some(n) => {
                        let absent = (name.clone(), format!("node {n}"), data.place);
                        self.absent.push(absent);
                    }
                    None => match self.deck.node_sets.get(&label(field)) {
                        Some(set) => {
                            out.extend(set);
                            self.inherit(0, &label(field), &name);
                        }
                        None => {
                            self.error(
                                data.place,
                                format!("there is no set of nodes {}", clip(field)),
                                "a set must stand before those it is part of",
                            );
                        }
                    },
                }
            }
        }
        let set = self.deck.node_sets.entry(name.clone()).or_default();
        if let Some(n) = add(set, out) {
            self.doubled[0].entry(name).or_insert(n);
        }
    }

    /// A set of nodes (0) or elements (1) that is part of another makes it name twice what it names twice.
    fn inherit(&mut self, kind: usize, part: &str, whole: &str) {
        if let Some(n) = self.doubled[kind].get(part).copied() {
            self.doubled[kind].entry(whole.to_string()).or_insert(n);
        }
    }

    /// It is an error to add up over a set of nodes (0) or elements (1) that names one of them twice: programs differ in how often it counts.
    pub(super) fn once(&mut self, kind: usize, set: &str, place: Place) {
        let Some(n) = self.doubled[kind].get(set) else {
            return;
        };
        let what = ["node", "element"][kind];
        let message = format!(
            "{what} {n} stands in the set {set} more than once: it counts as often in CalculiX, and once in Abaqus"
        );
        self.error(
            place,
            message,
            &format!("let the set name each {what} once"),
        );
    }

    /// Nodes of sets that are not there: CalculiX leaves them out, which changes nothing where the set is only printed.
    pub(super) fn judge_absent(&mut self) {
        for (set, what, place) in std::mem::take(&mut self.absent) {
            let (mut printed, mut used) = (false, false);
            for card in self.source.cards.iter().filter(|c| c.keyword != "NSET") {
                let named = card
                    .parameters
                    .iter()
                    .any(|p| p.value.as_deref() == Some(&set));
                match card.keyword.as_str() {
                    "NODEPRINT" | "NODEFILE" | "NODEOUTPUT" => printed |= named,
                    _ => used |= named,
                }
            }
            let mut fields = self
                .source
                .cards
                .iter()
                .flat_map(|c| &c.data)
                .flat_map(|d| &d.fields);
            used |= fields.any(|f| label(f) == set);
            match printed && !used {
                false => self.error(
                    place,
                    format!("there is no {what}"),
                    "*NODE must stand before *NSET",
                ),
                true => self.note(
                    place,
                    format!(
                        "there is no {what}: it is left out of the set {set}, which is only printed"
                    ),
                ),
            }
        }
    }

    pub(super) fn element_set(&mut self, card: &Card) {
        let Some(name) = self.required(card, "ELSET") else {
            return;
        };
        let mut out = Vec::new();
        for data in &card.data {
            if card.has("GENERATE") {
                out.extend(self.generated(data, |r| &r.deck.elements));
                continue;
            }
            for field in data.fields.iter().filter(|f| !f.is_empty()) {
                out.extend(self.elements_of(field, data.place));
                self.inherit(1, &label(field), &name);
            }
        }
        let set = self.deck.element_sets.entry(name.clone()).or_default();
        if let Some(n) = add(set, out) {
            self.doubled[1].entry(name).or_insert(n);
        }
    }

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

    /// Whether an element has the face; it is an error if not.
    pub(super) fn has_face(&mut self, element: u64, face: usize, place: Place) -> bool {
        let kind = &self.deck.elements[&element].kind;
        let known = bounding(kind).is_some()
            || abaqus::element_type(kind).is_ok_and(|t| abaqus::face_index(t.kind, face).is_some());
        if !known {
            let message = format!("element {element} ({kind}) has no face {face}");
            self.error(
                place,
                message,
                "faces are numbered as in the manual of CalculiX, from 1",
            );
        }
        known
    }

    pub(super) fn surface(&mut self, card: &Card) {
        let Some(name) = self.required(card, "NAME") else {
            return;
        };
        let outside = |d: &Data| d.fields.len() < 2;
        if card.get("TRIM") == Some("YES") && card.data.iter().any(outside) {
            self.error(
                card.place,
                "*SURFACE, TRIM=YES is not supported",
                "name the faces (S1 to S6) that are meant",
            );
        }
        let parts = match card.get("TYPE").unwrap_or("ELEMENT") {
            "" | "ELEMENT" => {
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
                SurfaceParts::Faces(faces)
            }
            "NODE" => {
                let mut nodes = Vec::new();
                for data in &card.data {
                    let Some(field) = data.fields.first() else {
                        continue;
                    };
                    match whole(field) {
                        Some(n) if self.deck.nodes.contains_key(&n) => nodes.push(n),
                        Some(n) => self.error(
                            data.place,
                            format!("there is no node {n}"),
                            "*NODE must stand before what refers to it",
                        ),
                        None => match self.deck.node_sets.get(&label(field)) {
                            Some(set) => nodes.extend(set),
                            None => self.error(
                                data.place,
                                format!("there is no set of nodes {}", clip(field)),
                                "define it with *NSET before",
                            ),
                        },
                    }
                }
                SurfaceParts::Nodes(nodes)
            }
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
        if empty && self.errors.is_empty() {
            self.error(
                card.place,
                format!("the surface {name} is empty"),
                "name faces of elements, or nodes with TYPE=NODE",
            );
        }
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
        let nodes = match whole(&set) {
            Some(n) => vec![n],
            None => match self.deck.node_sets.get(&set) {
                Some(nodes) => nodes.clone(),
                None => {
                    self.error(
                        card.place,
                        format!("there is no set of nodes {set}"),
                        "*NSET must stand before *TRANSFORM",
                    );
                    return;
                }
            },
        };
        for n in nodes {
            self.deck.transforms.insert(n, transform);
        }
    }

    pub(super) fn equation(&mut self, card: &Card) {
        if self.in_step {
            self.error(
                card.place,
                "equations cannot change from step to step",
                "give *EQUATION before the first *STEP",
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
                        (self.target(line, k), self.direction(line, k + 1, 3))
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
            self.deck.equations.push(Equation {
                terms,
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
        let node = |r: &mut Self, name: &str| {
            let text = card.get(name)?;
            let id = whole(text).or_else(|| match r.deck.node_sets.get(text).map(Vec::as_slice) {
                Some([one]) => Some(*one),
                _ => None,
            });
            if id.is_none_or(|n| !r.deck.nodes.contains_key(&n)) {
                r.error(
                    card.place,
                    format!("*RIGID BODY: {name} is {}, which is no node", clip(text)),
                    "give the number of a node that exists",
                );
            }
            id
        };
        let (reference, rotation) = (node(self, "REFNODE"), node(self, "ROTNODE"));
        let rigid = Rigid {
            elements: card.get("ELSET").map(str::to_string),
            nodes: card.get("NSET").map(str::to_string),
            reference,
            rotation,
            place: card.place,
        };
        self.deck.rigid.push(rigid);
    }

    pub(super) fn spring(&mut self, card: &Card) {
        let Some(set) = self.required(card, "ELSET") else {
            return;
        };
        let kind = self
            .elements_of(&set, card.place)
            .first()
            .map(|e| self.deck.elements[e].kind.clone());
        // The first line has directions; for SPRINGA it is empty, and empty lines are not kept.
        let (mut directions, mut data) = (Vec::new(), card.data.as_slice());
        if matches!(kind.as_deref(), Some("SPRING1" | "SPRING2")) {
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
                "a spring has one stiffness",
                "springs are linear and do not depend on temperature: give one stiffness",
            );
        }
        let Some(line) = line else {
            self.error(
                card.place,
                "*SPRING has no stiffness",
                "the line after the directions has the stiffness",
            );
            return;
        };
        let stiffness = self.number(line, 0, 0.0);
        self.deck.springs.push(SpringSection {
            set,
            directions,
            stiffness,
            place: card.place,
        });
    }

    pub(super) fn mass(&mut self, card: &Card) {
        let Some(set) = self.required(card, "ELSET") else {
            return;
        };
        self.elements_of(&set, card.place);
        let Some(line) = self.line(card) else { return };
        let mass = self.number(line, 0, 0.0);
        if mass < 0.0 {
            self.error(
                line.place,
                "the mass is negative",
                "write the mass of each point",
            );
        }
        self.deck.masses.push((set, mass, card.place));
    }

    pub(super) fn initial_conditions(&mut self, card: &Card) {
        let Some(kind) = self.required(card, "TYPE") else {
            return;
        };
        let velocity = match kind.as_str() {
            "VELOCITY" => true,
            "DISPLACEMENT" => false,
            "TEMPERATURE" => {
                self.initial_temperatures(card);
                return;
            }
            other => {
                let message = format!(
                    "*INITIAL CONDITIONS of type {} are not supported",
                    clip(other)
                );
                self.error(
                    card.place,
                    message,
                    "types are DISPLACEMENT, VELOCITY and TEMPERATURE",
                );
                return;
            }
        };
        for data in &card.data {
            let (Some(target), Some(component)) =
                (self.target(data, 0), self.direction(data, 1, 3))
            else {
                continue;
            };
            let value = self.number(data, 2, 0.0);
            self.deck.initial.push(InitialCondition {
                velocity,
                target,
                component,
                value,
                place: data.place,
            });
        }
    }

    fn initial_temperatures(&mut self, card: &Card) {
        for data in &card.data {
            let Some(target) = self.target(data, 0) else {
                continue;
            };
            let value = self.number(data, 1, 0.0);
            if data.fields.len() > 2 && self.number(data, 2, 0.0) != 0.0 {
                self.error(
                    data.place,
                    "temperatures do not vary across a section",
                    "write node or set, temperature",
                );
            }
            self.deck.temperatures.push(crate::deck::Temperature {
                target,
                value,
                place: data.place,
            });
        }
    }

    pub(super) fn amplitude(&mut self, card: &Card) {
        let Some(name) = self.required(card, "NAME") else {
            return;
        };
        if card.get("VALUE").is_some_and(|v| v != "RELATIVE") {
            self.error(
                card.place,
                "*AMPLITUDE, VALUE=ABSOLUTE is not supported",
                "amplitudes multiply the values they belong to: give factors",
            );
        }
        if card.get("DEFINITION").is_some_and(|d| d != "TABULAR") {
            self.error(
                card.place,
                "only tabular amplitudes are read",
                "give time, factor pairs",
            );
            return;
        }
        let shift = [
            parameter(self, card, "SHIFTX").unwrap_or(0.0),
            parameter(self, card, "SHIFTY").unwrap_or(0.0),
        ];
        let mut rows: Vec<[f64; 2]> = Vec::new();
        for data in &card.data {
            for k in (0..data.fields.len()).step_by(2) {
                let row = [
                    self.number(data, k, 0.0) + shift[0],
                    self.number(data, k + 1, 0.0) + shift[1],
                ];
                if rows.last().is_some_and(|last| last[0] >= row[0]) {
                    self.error(
                        data.place,
                        format!(
                            "time {} does not follow {}",
                            row[0],
                            rows[rows.len() - 1][0]
                        ),
                        "times of an amplitude increase",
                    );
                    return;
                }
                rows.push(row);
            }
        }
        if rows.is_empty() {
            self.error(
                card.place,
                "the amplitude is empty",
                "give time, factor pairs",
            );
        }
        let amplitude = crate::deck::Amplitude {
            rows,
            total_time: card.get("TIME") == Some("TOTALTIME"),
            place: card.place,
        };
        if self
            .deck
            .amplitudes
            .insert(name.clone(), amplitude)
            .is_some()
        {
            self.error(
                card.place,
                format!("the amplitude {name} is given twice"),
                "give each amplitude a name of its own",
            );
        }
    }

    pub(super) fn time_points(&mut self, card: &Card) {
        let Some(name) = self.required(card, "NAME") else {
            return;
        };
        let mut times = Vec::new();
        for data in &card.data {
            if card.has("GENERATE") {
                let [from, to, by] = [0, 1, 2].map(|i| self.number(data, i, 0.0));
                let count = (to - from) / by;
                if !(0.0..=1e6 - times.len() as f64).contains(&count) {
                    self.error(
                        data.place,
                        "these times cannot be made",
                        "write first, last, increment; at most a million",
                    );
                    return;
                }
                times.extend((0..=(count + 1e-9) as usize).map(|i| from + by * i as f64));
                continue;
            }
            for i in 0..data.fields.len() {
                times.push(self.number(data, i, 0.0));
            }
        }
        let points = TimePoints {
            times,
            total_time: card.get("TIME") == Some("TOTALTIME"),
        };
        if self.deck.time_points.insert(name.clone(), points).is_some() {
            self.error(
                card.place,
                format!("the time points {name} are given twice"),
                "give each a name of its own",
            );
        }
    }
}

/// Adds to a set what it does not have yet, in order. The first that it has already.
fn add(set: &mut Vec<u64>, more: Vec<u64>) -> Option<u64> {
    let mut seen: std::collections::BTreeSet<u64> = set.iter().copied().collect();
    let mut again = None;
    for n in more {
        match seen.insert(n) {
            true => set.push(n),
            false => again = again.or(Some(n)),
        }
    }
    again
}
