//! Supports and loads of a step.

use std::collections::BTreeSet;

use super::fields::{direction, elements_of, no_more, number, parameter, target};
use super::messages::Messages;
use super::reader::Reader;
use super::{elements, harmonic, sets, step, surfaces};
use crate::card::{Card, Data, Place};
use crate::deck::{Action, Boundary, Distributed, SurfaceParts, Target};
use crate::text::{self, clip, squeeze};

/// `OP=NEW` takes away what was prescribed before. It counts on the first card of its kind in a step, as in CalculiX; Abaqus wants it
/// on all of them, which comes to the same.
pub(super) fn operation(reader: &mut Reader, card: &Card, clear: Action) {
    let first = !reader.position.touched.contains(&clear);
    if first {
        reader.position.touched.push(clear.clone());
    }
    match card.get("OP") {
        Some("NEW") if first => reader.deck.act(clear),
        None | Some("MOD" | "NEW") => {}
        Some(other) => reader.messages.error(
            card.place,
            format!("OP={other} is not known"),
            "OP is MOD or NEW",
        ),
    }
}

/// The amplitude of a card. With TIME DELAY it is one of its own, which is that much later.
pub(super) fn course(reader: &mut Reader, card: &Card) -> Option<String> {
    let messages = &mut reader.messages;
    let name = card
        .get("AMPLITUDE")
        .filter(|n| !n.is_empty())
        .map(str::to_string);
    let Some(delay) = parameter(messages, card, "TIMEDELAY") else {
        return name;
    };
    let known = name
        .as_ref()
        .and_then(|n| reader.deck.tables.amplitudes.get(n))
        .cloned();
    let (Some(name), Some(mut amplitude)) = (name, known) else {
        let message = format!(
            "{}, TIME DELAY needs an amplitude that it delays",
            card.written
        );
        let help = "write AMPLITUDE=..., with the *AMPLITUDE before this card";
        messages.error(card.place, message, help);
        return None;
    };
    for row in &mut amplitude.rows {
        row[0] += delay;
    }
    let later = format!("{name} after {delay}");
    reader
        .deck
        .tables
        .amplitudes
        .insert(later.clone(), amplitude);
    Some(later)
}

/// The directions that a line of `*BOUNDARY` prescribes, from 0.
fn components(messages: &mut Messages, data: &Data) -> Option<Vec<usize>> {
    match data.fields.get(1).map(|f| squeeze(f)).as_deref() {
        Some("ENCASTRE") => Some((0..6).collect()),
        Some("PINNED") => Some((0..3).collect()),
        Some("XSYMM") => Some(vec![0, 4, 5]),
        Some("YSYMM") => Some(vec![1, 3, 5]),
        Some("ZSYMM") => Some(vec![2, 3, 4]),
        _ => {
            if data.fields.get(1).and_then(|f| text::whole(f)) == Some(11)
                || data.fields.get(1).is_some_and(|f| f == "0")
            {
                let message = "temperatures are no unknowns here";
                messages.error(data.place, message, "give them by *TEMPERATURE");
                return None;
            }
            let first = direction(messages, data, 1, 6)?;
            let last = match data.fields.get(2).filter(|f| !f.is_empty()) {
                Some(_) => direction(messages, data, 2, 6).unwrap_or(first),
                None => first,
            };
            if last < first {
                let help = "write node, first direction, last direction, value";
                messages.error(data.place, "the last direction is below the first", help);
                return None;
            }
            Some((first..=last).collect())
        }
    }
}

pub(super) fn boundary(reader: &mut Reader, card: &Card) {
    if card.get("TYPE").is_some_and(|t| t != "DISPLACEMENT") {
        let message = "*BOUNDARY: only displacements are prescribed";
        let help = "give a velocity as a displacement that grows over the step";
        reader.messages.error(card.place, message, help);
        return;
    }
    if reader.position.in_step {
        operation(reader, card, Action::ClearBoundaries);
    }
    let amplitude = course(reader, card);
    for data in &card.data {
        let Some(target) = target(reader, data, 0) else {
            continue;
        };
        let Some(components) = components(&mut reader.messages, data) else {
            continue;
        };
        let value = number(&mut reader.messages, data, 3, 0.0);
        let boundary = Boundary {
            target,
            components,
            value,
            amplitude: amplitude.clone(),
            fixed: card.has("FIXED"),
            place: data.place,
        };
        match reader.position.in_step {
            true => reader.deck.act(Action::Boundary(boundary)),
            false => reader.deck.supports.push(boundary),
        }
    }
}

pub(super) fn forces(reader: &mut Reader, card: &Card) {
    if step::own_step(reader, card).is_none() {
        return;
    }
    operation(reader, card, Action::ClearForces);
    let amplitude = course(reader, card);
    let imaginary = harmonic::imaginary(&mut reader.messages, card);
    for data in &card.data {
        let (Some(target), Some(component)) = (
            target(reader, data, 0),
            direction(&mut reader.messages, data, 1, 6),
        ) else {
            continue;
        };
        if let Target::Set(name) = &target {
            sets::once(reader, 0, name, data.place);
        }
        let value = number(&mut reader.messages, data, 2, 0.0);
        reader.deck.act(Action::Force {
            target,
            component,
            value,
            amplitude: amplitude.clone(),
            imaginary,
            place: data.place,
        });
    }
}

pub(super) fn distributed(reader: &mut Reader, card: &Card) {
    if step::own_step(reader, card).is_none() {
        return;
    }
    operation(reader, card, Action::ClearDistributed);
    let (amplitude, imaginary) = (
        course(reader, card),
        harmonic::imaginary(&mut reader.messages, card),
    );
    let acting = |load, place| Action::Distributed {
        load,
        amplitude: amplitude.clone(),
        imaginary,
        place,
    };
    for data in &card.data {
        let Some(first) = data.fields.first().cloned() else {
            continue;
        };
        let what = data.fields.get(1).map(|f| squeeze(f)).unwrap_or_default();
        // `*DLOAD` of a surface is what some pre-processors write.
        let name = reader.scope.name(&first);
        if what == "P" && reader.deck.surfaces.contains_key(&name) {
            faces_once(reader, &name, data.place);
            let p = number(&mut reader.messages, data, 2, 0.0);
            reader
                .deck
                .act(acting(Distributed::Surface(name, p), data.place));
            continue;
        }
        let elements = match first.is_empty() && matches!(what.as_str(), "GRAV" | "CENTRIF") {
            true => reader.deck.elements.keys().copied().collect(),
            false => elements_of(reader, &first, data.place),
        };
        if elements.is_empty() {
            continue;
        }
        sets::once(reader, 1, &name, data.place);
        let value = number(&mut reader.messages, data, 2, 0.0);
        let count = match what.as_str() {
            "GRAV" => 6,
            "CENTRIF" => 9,
            _ => 3,
        };
        no_more(&mut reader.messages, data, count, &what);
        if let Some(load) = load(reader, data, elements, &what, value) {
            reader.deck.act(acting(load, data.place));
        }
    }
}

/// A load on elements.
fn load(
    reader: &mut Reader,
    data: &Data,
    elements: Vec<u64>,
    what: &str,
    value: f64,
) -> Option<Distributed> {
    let set = data.fields.first().map(|f| reader.scope.name(f));
    let set = set.unwrap_or_default();
    match what {
        "GRAV" => {
            let d = [3, 4, 5].map(|i| number(&mut reader.messages, data, i, 0.0));
            let Some(d) = stickslip::math::normalize(d) else {
                let message = "GRAV needs a direction";
                let help = "write set, GRAV, acceleration, x, y, z";
                reader.messages.error(data.place, message, help);
                return None;
            };
            Some(Distributed::Gravity(elements, set, value, d))
        }
        "CENTRIF" => {
            let p = [3, 4, 5].map(|i| number(&mut reader.messages, data, i, 0.0));
            let d = [6, 7, 8].map(|i| number(&mut reader.messages, data, i, 0.0));
            if value < 0.0 || d == [0.0; 3] {
                let message = "CENTRIF needs the square of the angular speed, a point and a direction of the axis";
                let help = "write set, CENTRIF, omega squared, px, py, pz, dx, dy, dz";
                reader.messages.error(data.place, message, help);
                return None;
            }
            Some(Distributed::Centrifugal(elements, set, value, p, d))
        }
        "BX" => Some(Distributed::Body(elements, 0, value)),
        "BY" => Some(Distributed::Body(elements, 1, value)),
        "BZ" => Some(Distributed::Body(elements, 2, value)),
        "P" => {
            let message = "the load `P` is a pressure on a shell or on a surface";
            let help = "on solid elements name the face, P1 to P6; on a surface use *DSLOAD";
            reader.messages.error(data.place, message, help);
            None
        }
        _ if what.starts_with('P') => {
            let face = surfaces::face(&mut reader.messages, what, 'P', data.place)?;
            let mut faces = Vec::new();
            for e in elements {
                if elements::has_face(reader, e, face, data.place) {
                    faces.push((e, face));
                }
            }
            Some(Distributed::Pressure(faces, value))
        }
        _ => {
            let message = format!("the distributed load `{}` is not supported", clip(what));
            let help = "P1 to P6 (pressure), GRAV, CENTRIF and BX, BY, BZ are";
            reader.messages.error(data.place, message, help);
            None
        }
    }
}

pub(super) fn surface_loads(reader: &mut Reader, card: &Card) {
    if step::own_step(reader, card).is_none() {
        return;
    }
    operation(reader, card, Action::ClearDistributed);
    let (amplitude, imaginary) = (
        course(reader, card),
        harmonic::imaginary(&mut reader.messages, card),
    );
    let acting = |load, place| Action::Distributed {
        load,
        amplitude: amplitude.clone(),
        imaginary,
        place,
    };
    for data in &card.data {
        let name = data.fields.first().map(|f| reader.scope.name(f));
        let name = name.unwrap_or_default();
        let what = data.fields.get(1).map(|f| squeeze(f)).unwrap_or_default();
        if what != "P" {
            let message = format!("the surface load `{}` is not supported", clip(&what));
            let help = "P (pressure) is";
            reader.messages.error(data.place, message, help);
            continue;
        }
        faces_once(reader, &name, data.place);
        let p = number(&mut reader.messages, data, 2, 0.0);
        reader
            .deck
            .act(acting(Distributed::Surface(name, p), data.place));
    }
}

/// It is an error to load a surface that names one of its faces twice.
pub(super) fn faces_once(reader: &mut Reader, name: &str, place: Place) {
    let Some(SurfaceParts::Faces(faces)) = reader.deck.surfaces.get(name).map(|s| &s.parts) else {
        return;
    };
    let mut seen = BTreeSet::new();
    let again = faces.iter().copied().find(|f| !seen.insert(*f));
    if let Some((element, Some(face))) = again {
        let element = reader.scope.label(element);
        let message = format!(
            "face {face} of element {element} stands in the surface {name} more than once: it is loaded as often in CalculiX, and once in Abaqus"
        );
        let help = "let the surface name each face once";
        reader.messages.error(place, message, help);
    }
}
