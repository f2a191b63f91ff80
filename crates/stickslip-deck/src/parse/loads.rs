//! Supports and loads of a step.

use std::collections::BTreeSet;

use super::fields::parameter;
use super::reader::Reader;
use crate::card::{Card, Data, Place};
use crate::deck::{Action, Boundary, Distributed, SurfaceParts, Target};
use crate::text::{clip, number, squeeze, whole};

impl Reader<'_> {
    /// `OP=NEW` takes away what was prescribed before. It counts on the first card of its kind in a step, as in CalculiX; Abaqus wants it
    /// on all of them, which comes to the same.
    pub(super) fn operation(&mut self, card: &Card, clear: Action) {
        let first = !self.position.touched.contains(&clear);
        if first {
            self.position.touched.push(clear.clone());
        }
        match card.get("OP") {
            Some("NEW") if first => self.act(clear),
            None | Some("MOD" | "NEW") => {}
            Some(other) => self.error(
                card.place,
                format!("OP={other} is not known"),
                "OP is MOD or NEW",
            ),
        }
    }

    /// The amplitude of a card. With TIME DELAY it is one of its own, which is that much later.
    pub(super) fn course(&mut self, card: &Card) -> Option<String> {
        let name = card
            .get("AMPLITUDE")
            .filter(|n| !n.is_empty())
            .map(str::to_string);
        let Some(delay) = parameter(self, card, "TIMEDELAY") else {
            return name;
        };
        let known = name
            .as_ref()
            .and_then(|n| self.deck.tables.amplitudes.get(n))
            .cloned();
        let (Some(name), Some(mut amplitude)) = (name, known) else {
            self.error(
                card.place,
                format!(
                    "{}, TIME DELAY needs an amplitude that it delays",
                    card.written
                ),
                "write AMPLITUDE=..., with the *AMPLITUDE before this card",
            );
            return None;
        };
        for row in &mut amplitude.rows {
            row[0] += delay;
        }
        let later = format!("{name} after {delay}");
        self.deck.tables.amplitudes.insert(later.clone(), amplitude);
        Some(later)
    }

    /// The directions that a line of `*BOUNDARY` prescribes, from 0.
    fn components(&mut self, data: &Data) -> Option<Vec<usize>> {
        match data.fields.get(1).map(|f| squeeze(f)).as_deref() {
            Some("ENCASTRE") => Some((0..6).collect()),
            Some("PINNED") => Some((0..3).collect()),
            Some("XSYMM") => Some(vec![0, 4, 5]),
            Some("YSYMM") => Some(vec![1, 3, 5]),
            Some("ZSYMM") => Some(vec![2, 3, 4]),
            _ => {
                if data.fields.get(1).and_then(|f| whole(f)) == Some(11)
                    || data.fields.get(1).is_some_and(|f| f == "0")
                {
                    self.error(
                        data.place,
                        "temperatures are no unknowns here",
                        "give them by *TEMPERATURE",
                    );
                    return None;
                }
                let first = self.direction(data, 1, 6)?;
                let last = match data.fields.get(2).filter(|f| !f.is_empty()) {
                    Some(_) => self.direction(data, 2, 6).unwrap_or(first),
                    None => first,
                };
                if last < first {
                    self.error(
                        data.place,
                        "the last direction is below the first",
                        "write node, first direction, last direction, value",
                    );
                    return None;
                }
                Some((first..=last).collect())
            }
        }
    }

    pub(super) fn boundary(&mut self, card: &Card) {
        if card.get("TYPE").is_some_and(|t| t != "DISPLACEMENT") {
            self.error(
                card.place,
                "*BOUNDARY: only displacements are prescribed",
                "give a velocity as a displacement that grows over the step",
            );
            return;
        }
        if self.position.in_step {
            self.operation(card, Action::ClearBoundaries);
        }
        let amplitude = self.course(card);
        for data in &card.data {
            let Some(target) = self.target(data, 0) else {
                continue;
            };
            let Some(components) = self.components(data) else {
                continue;
            };
            let value = self.number(data, 3, 0.0);
            let boundary = Boundary {
                target,
                components,
                value,
                amplitude: amplitude.clone(),
                fixed: card.has("FIXED"),
                place: data.place,
            };
            match self.position.in_step {
                true => self.act(Action::Boundary(boundary)),
                false => self.deck.supports.push(boundary),
            }
        }
    }

    pub(super) fn forces(&mut self, card: &Card) {
        if self.own_step(card).is_none() {
            return;
        }
        self.operation(card, Action::ClearForces);
        let amplitude = self.course(card);
        let imaginary = self.imaginary(card);
        for data in &card.data {
            let (Some(target), Some(component)) =
                (self.target(data, 0), self.direction(data, 1, 6))
            else {
                continue;
            };
            if let Target::Set(name) = &target {
                self.once(0, name, data.place);
            }
            let value = self.number(data, 2, 0.0);
            self.act(Action::Force {
                target,
                component,
                value,
                amplitude: amplitude.clone(),
                imaginary,
                place: data.place,
            });
        }
    }

    /// It is an error if a line has more fields than the kind of load reads.
    pub(super) fn no_more(&mut self, data: &Data, count: usize, kind: &str) {
        let means = |text: &String| !text.is_empty() && number(text) != Some(0.0);
        if let Some(at) = data.fields.iter().skip(count).position(means) {
            let field = count + at;
            let message = format!(
                "field {} of this line, `{}`, is not read",
                field + 1,
                clip(&data.fields[field])
            );
            self.error(
                data.place,
                message,
                &format!("a line with {kind} has {count} fields"),
            );
        }
    }

    pub(super) fn distribute(
        &mut self,
        amplitude: Option<&String>,
        imaginary: bool,
        load: Distributed,
        place: Place,
    ) {
        self.act(Action::Distributed {
            load,
            amplitude: amplitude.cloned(),
            imaginary,
            place,
        });
    }

    pub(super) fn distributed(&mut self, card: &Card) {
        if self.own_step(card).is_none() {
            return;
        }
        self.operation(card, Action::ClearDistributed);
        let (course, imaginary) = (self.course(card), self.imaginary(card));
        for data in &card.data {
            let Some(first) = data.fields.first().cloned() else {
                continue;
            };
            let what = data.fields.get(1).map(|f| squeeze(f)).unwrap_or_default();
            // `*DLOAD` of a surface is what some pre-processors write.
            let name = self.name(&first);
            if what == "P" && self.deck.surfaces.contains_key(&name) {
                self.faces_once(&name, data.place);
                let p = self.number(data, 2, 0.0);
                let load = Distributed::Surface(name, p);
                self.distribute(course.as_ref(), imaginary, load, data.place);
                continue;
            }
            let elements = match first.is_empty() && matches!(what.as_str(), "GRAV" | "CENTRIF") {
                true => self.deck.elements.keys().copied().collect(),
                false => self.elements_of(&first, data.place),
            };
            if elements.is_empty() {
                continue;
            }
            self.once(1, &name, data.place);
            let value = self.number(data, 2, 0.0);
            let count = match what.as_str() {
                "GRAV" => 6,
                "CENTRIF" => 9,
                _ => 3,
            };
            self.no_more(data, count, &what);
            if let Some(load) = self.load(data, elements, &what, value) {
                self.distribute(course.as_ref(), imaginary, load, data.place);
            }
        }
    }

    /// A load on elements.
    fn load(
        &mut self,
        data: &Data,
        elements: Vec<u64>,
        what: &str,
        value: f64,
    ) -> Option<Distributed> {
        let set = data.fields.first().map(|f| self.name(f));
        let set = set.unwrap_or_default();
        match what {
            "GRAV" => {
                let d = [3, 4, 5].map(|i| self.number(data, i, 0.0));
                let Some(d) = stickslip::math::normalize(d) else {
                    self.error(
                        data.place,
                        "GRAV needs a direction",
                        "write set, GRAV, acceleration, x, y, z",
                    );
                    return None;
                };
                Some(Distributed::Gravity(elements, set, value, d))
            }
            "CENTRIF" => {
                let p = [3, 4, 5].map(|i| self.number(data, i, 0.0));
                let d = [6, 7, 8].map(|i| self.number(data, i, 0.0));
                if value < 0.0 || d == [0.0; 3] {
                    self.error(data.place, "CENTRIF needs the square of the angular speed, a point and a direction of the axis", "write set, CENTRIF, omega squared, px, py, pz, dx, dy, dz");
                    return None;
                }
                Some(Distributed::Centrifugal(elements, set, value, p, d))
            }
            "BX" => Some(Distributed::Body(elements, 0, value)),
            "BY" => Some(Distributed::Body(elements, 1, value)),
            "BZ" => Some(Distributed::Body(elements, 2, value)),
            "P" => {
                self.error(
                    data.place,
                    "the load `P` is a pressure on a shell or on a surface",
                    "on solid elements name the face, P1 to P6; on a surface use *DSLOAD",
                );
                None
            }
            _ if what.starts_with('P') => {
                let face = self.face(what, 'P', data.place)?;
                let mut faces = Vec::new();
                for e in elements {
                    if self.has_face(e, face, data.place) {
                        faces.push((e, face));
                    }
                }
                Some(Distributed::Pressure(faces, value))
            }
            _ => {
                let message = format!("the distributed load `{}` is not supported", clip(what));
                self.error(
                    data.place,
                    message,
                    "P1 to P6 (pressure), GRAV, CENTRIF and BX, BY, BZ are",
                );
                None
            }
        }
    }

    pub(super) fn surface_loads(&mut self, card: &Card) {
        if self.own_step(card).is_none() {
            return;
        }
        self.operation(card, Action::ClearDistributed);
        let (course, imaginary) = (self.course(card), self.imaginary(card));
        for data in &card.data {
            let name = data.fields.first().map(|f| self.name(f));
            let name = name.unwrap_or_default();
            let what = data.fields.get(1).map(|f| squeeze(f)).unwrap_or_default();
            if what != "P" {
                self.error(
                    data.place,
                    format!("the surface load `{}` is not supported", clip(&what)),
                    "P (pressure) is",
                );
                continue;
            }
            self.faces_once(&name, data.place);
            let p = self.number(data, 2, 0.0);
            let load = Distributed::Surface(name, p);
            self.distribute(course.as_ref(), imaginary, load, data.place);
        }
    }

    /// It is an error to load a surface that names one of its faces twice.
    pub(super) fn faces_once(&mut self, name: &str, place: Place) {
        let Some(SurfaceParts::Faces(faces)) = self.deck.surfaces.get(name).map(|s| &s.parts)
        else {
            return;
        };
        let mut seen = BTreeSet::new();
        let again = faces.iter().copied().find(|f| !seen.insert(*f));
        if let Some((element, Some(face))) = again {
            let element = self.deck.label(element);
            let message = format!(
                "face {face} of element {element} stands in the surface {name} more than once: it is loaded as often in CalculiX, and once in Abaqus"
            );
            self.error(place, message, "let the surface name each face once");
        }
    }
}
