//! Axes of materials: the same everywhere, about a cylinder, or by element.

use std::collections::BTreeMap;

use super::fields::{elements_named, line, no_more, number, required_name, whole};
use super::known::absent;
use super::messages::Messages;
use super::reader::Reader;
use crate::card::{Card, Data};
use crate::deck::{Distribution, DistributionLine, Local, Orientation, Target};
use crate::taken::Taken;
use crate::text::{self, squeeze};

/// Two points and the origin, from a field on.
fn points(messages: &mut Messages, data: &Data, from: usize) -> [[f64; 3]; 3] {
    let mut at = |k: usize| [0, 1, 2].map(|i| number(messages, data, from + 3 * k + i, 0.0));
    [at(0), at(1), at(2)]
}

pub(super) fn orientation(reader: &mut Reader, card: &Card) {
    let Some(name) = required_name(reader, card, "NAME") else {
        return;
    };
    let messages = &mut reader.messages;
    let cylindrical = match card.get("SYSTEM").unwrap_or("RECTANGULAR") {
        "RECTANGULAR" | "" => false,
        "CYLINDRICAL" => true,
        other => {
            let message = format!("*ORIENTATION: the system {other} is not supported");
            let help = "systems are RECTANGULAR and CYLINDRICAL";
            messages.error(card.place, message, help);
            return;
        }
    };
    if card.get("DEFINITION").is_some_and(|d| d != "COORDINATES") {
        let message = "*ORIENTATION: only DEFINITION=COORDINATES is read";
        let help = "give a point on the axis 1 and one in the plane 1-2";
        messages.error(card.place, message, help);
        return;
    }
    let Some(data) = line(messages, card) else {
        return;
    };
    let first = data.fields.first().map_or("", String::as_str);
    let distribution =
        (!first.is_empty() && text::number(first).is_none()).then(|| reader.scope.name(first));
    let Ok(turn) = further_turn(messages, card) else {
        return;
    };
    let taken = Taken {
        cylindrical,
        turn,
        motion: reader.scope.motion(),
        distribution,
    };
    let found = match taken.distribution {
        Some(_) => Some(Local::Axes([[0.0; 3]; 3])),
        None => {
            let points = points(messages, data, 0);
            taken.local(points)
        }
    };
    let Some(local) = found else {
        no_axes(messages, data, cylindrical);
        return;
    };
    let orientation = Orientation {
        local,
        elements: BTreeMap::new(),
        taken,
        place: card.place,
    };
    if reader
        .deck
        .properties
        .orientations
        .insert(name.clone(), orientation)
        .is_some()
    {
        let message = format!("the orientation {name} is given twice");
        let help = "give each orientation a name of its own";
        messages.error(card.place, message, help);
    }
}

/// The second line: a further rotation. An error if it cannot be read, which has been said.
fn further_turn(messages: &mut Messages, card: &Card) -> Result<Option<(usize, f64)>, ()> {
    if let Some(more) = card.data.get(2).filter(|d| !d.fields.is_empty()) {
        let help = "the lines are: two points and the origin; axis and angle of a further rotation";
        messages.error(more.place, "*ORIENTATION: this line is not read", help);
    }
    let Some(line) = card.data.get(1).filter(|d| !d.fields.is_empty()) else {
        return Ok(None);
    };
    let about = whole(messages, line, 0).unwrap_or(0) as usize;
    let angle = number(messages, line, 1, 0.0).to_radians();
    if !(1..=3).contains(&about) {
        let message = "the axis of the further rotation is 1, 2 or 3";
        messages.error(line.place, message, "write axis, angle in degrees");
        return Err(());
    }
    if angle != 0.0 && card.get("SYSTEM") == Some("CYLINDRICAL") {
        let message = "a further rotation of cylindrical axes is not supported";
        let help = "leave the line out, and turn the constants of the material";
        messages.error(line.place, message, help);
        return Err(());
    }
    Ok(Some((about - 1, angle)))
}

fn no_axes(messages: &mut Messages, data: &Data, cylindrical: bool) {
    match cylindrical {
        true => messages.error(
            data.place,
            "the two points of the axis of the cylinder are one",
            "give two points of the axis",
        ),
        false => messages.error(
            data.place,
            "the two points do not span a plane",
            "give a point on the axis 1 and one in the plane 1-2, beside the axis",
        ),
    }
}

/// `*DISTRIBUTION TABLE`: what the numbers of a distribution are.
pub(super) fn distribution_table(reader: &mut Reader, card: &Card) {
    if required_name(reader, card, "NAME").is_none() {
        return;
    }
    let messages = &mut reader.messages;
    let Some(data) = line(messages, card) else {
        return;
    };
    let kinds: Vec<String> = data.fields.iter().map(|f| squeeze(f)).collect();
    if kinds.iter().any(|k| k != "COORD3D") || kinds.len() != 2 {
        let message = format!("distributions of {} are not supported", kinds.join(", "));
        let help = "*DISTRIBUTION gives axes by element: COORD3D, COORD3D";
        messages.error(data.place, message, help);
    }
}

/// Points of axes by element.
pub(super) fn distribution(reader: &mut Reader, card: &Card) {
    let Some(name) = required_name(reader, card, "NAME") else {
        return;
    };
    let messages = &mut reader.messages;
    if card.get("LOCATION").is_some_and(|l| l != "ELEMENT") {
        let message = "*DISTRIBUTION: only LOCATION=ELEMENT is read";
        messages.error(card.place, message, "give axes by element");
        return;
    }
    let Some(first) = line(messages, card) else {
        return;
    };
    if first.fields.first().is_some_and(|f| !f.is_empty()) {
        let message = "the first line of a *DISTRIBUTION has the axes of all other elements";
        let help = "begin the line with a comma: , ax, ay, az, bx, by, bz";
        messages.error(first.place, message, help);
        return;
    }
    let mut lines = Vec::new();
    for data in &card.data {
        no_more(messages, data, 7, "*DISTRIBUTION");
        let first = data.fields.first().filter(|f| !f.is_empty());
        let elements = first.map(|text| match reader.scope.number_of(text) {
            Some(element) => Target::One(element),
            None => Target::Set(reader.scope.name(text)),
        });
        lines.push(DistributionLine {
            elements,
            points: points(messages, data, 1),
            data: data.clone(),
        });
    }
    let distribution = Distribution {
        lines,
        place: card.place,
    };
    if reader
        .deck
        .properties
        .distributions
        .insert(name.clone(), distribution)
        .is_some()
    {
        let message = format!("the distribution {name} is given twice");
        let help = "give each distribution a name of its own";
        messages.error(card.place, message, help);
    }
}

/// Gives orientations the axes of their distributions, which may stand behind them.
pub(super) fn settle_distributions(reader: &mut Reader) {
    let orientations: Vec<_> = (reader.deck.properties.orientations.iter())
        .map(|(key, o)| (key.clone(), o.place, o.taken.clone()))
        .collect();
    for (key, place, taken) in orientations {
        let Some(name) = taken.distribution.clone() else {
            continue;
        };
        let bare = reader.scope.numbering.bare(&name).to_string();
        let distributions = &reader.deck.properties.distributions;
        let known = distributions
            .get(&name)
            .or_else(|| distributions.get(&bare));
        let Some(lines) = known.map(|distribution| distribution.lines.clone()) else {
            let all = distributions.keys();
            let (message, help) = absent(&reader.scope.numbering, "distribution", &name, all);
            reader.messages.error(place, message, &help);
            continue;
        };
        let (mut general, mut single) = (None, Vec::new());
        for (i, line) in lines.iter().enumerate() {
            let DistributionLine {
                elements,
                points,
                data,
            } = line;
            match taken.local(*points) {
                None => no_axes(&mut reader.messages, data, taken.cylindrical),
                Some(local) if i == 0 => general = Some(local),
                Some(local) => {
                    // Sets may stand behind the distribution.
                    let all = match elements {
                        Some(Target::Set(name)) => elements_named(reader, name, name, data.place),
                        Some(Target::One(e)) if reader.deck.elements.contains_key(e) => vec![*e],
                        Some(Target::One(e)) => {
                            let message = format!("there is no element {}", reader.scope.label(*e));
                            let help = "*DISTRIBUTION names elements by number or set";
                            reader.messages.error(data.place, message, help);
                            Vec::new()
                        }
                        None => Vec::new(),
                    };
                    single.extend(all.into_iter().map(|e| (e, local.clone())));
                }
            }
        }
        if let Some(o) = reader.deck.properties.orientations.get_mut(&key) {
            o.local = general.unwrap_or_else(|| o.local.clone());
            o.elements.extend(single);
        }
    }
}
