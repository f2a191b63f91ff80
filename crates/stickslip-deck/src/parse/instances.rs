//! `*PART`, `*ASSEMBLY` and `*INSTANCE`: a deck that is built of instances becomes flat as it is read.
//!
//! The cards of a part are kept, and read for every instance with the numbers, names and place that the instance has. So each card is read
//! by the function that reads it in a flat deck.

use stickslip::io::abaqus::{self, Space};

use super::fields::{number, required};
use super::generate_elements;
use super::known::nearest;
use super::messages::Messages;
use super::reader::Reader;
use super::structure::{Assembly, Inside, Level, OpenInstance, Part, Structure};
use crate::card::{Card, Place};
use crate::motion::Motion;
use crate::numbering::Numbering;
use crate::source::Source;
use crate::text::{self, clip, squeeze};

/// Most lines that are read for instances: a short deck must not ask for more than there is memory.
const MOST_LINES: usize = 20_000_000;

/// The numbering of a deck: how many instances it has, and its largest number.
pub(super) fn numbering(source: &Source) -> Numbering {
    let of = |keyword: &'static str| source.cards.iter().filter(move |c| c.keyword == keyword);
    let count = of("INSTANCE").count();
    if count == 0 {
        return Numbering::default();
    }
    let lines = of("NODE").chain(of("ELEMENT")).flat_map(|c| &c.data);
    let numbers = lines.filter_map(|d| text::whole(d.fields.first()?));
    let most = numbers.max().unwrap_or(0);
    let made = source.cards.iter().map(generate_elements::farther);
    Numbering::new(count, made.fold(most, u64::saturating_add))
}

/// Closes what has no end of its own where a card can only stand behind it.
pub(super) fn close_before(reader: &mut Reader, card: &Card, level: Level) {
    let keyword = card.keyword.as_str();
    let structure = level == Level::Structure;
    let ends = |own: &str| keyword == "STEP" || (keyword != own && structure);
    if reader.structure.part.is_some() && ends("ENDPART") {
        without_end_part(reader, card.place);
    }
    if reader.structure.instance.is_some() && ends("ENDINSTANCE") {
        without_end_instance(reader);
    }
    let other = matches!(keyword, "STEP" | "ASSEMBLY");
    if other && reader.structure.inside() == Inside::Assembly {
        without_end_assembly(reader);
    }
}

/// What is still open at the end of the deck.
pub(super) fn close_all(reader: &mut Reader) {
    if let Some((_, part)) = &reader.structure.part {
        let place = part.place;
        without_end_part(reader, place);
    }
    if reader.structure.instance.is_some() {
        without_end_instance(reader);
    }
    if reader.structure.inside() == Inside::Assembly {
        without_end_assembly(reader);
    }
    let messages = &mut reader.messages;
    let left: Vec<(String, Place)> = (reader.structure.parts.iter())
        .filter(|(_, p)| p.instances == 0)
        .map(|(name, p)| (name.clone(), p.place))
        .collect();
    if let Some((name, place)) = left.first()
        && reader.scope.numbering.instances().is_empty()
    {
        // Nothing is in the model; what has been said may be why.
        reader.structure.incomplete = true;
        if messages.sound() {
            messages.error(*place,
                format!("the part {name} has no instance, nor has any other"),
                "put it into the model: *ASSEMBLY, *INSTANCE, NAME=..., PART=..., *END INSTANCE, *END ASSEMBLY",
            );
        }
        return;
    }
    for (name, place) in left {
        messages.note(
            place,
            format!("the part {name} has no instance: it is left out"),
        );
    }
}

fn without_end_part(reader: &mut Reader, before: Place) {
    let Some((name, part)) = &reader.structure.part else {
        return;
    };
    let (message, place) = (format!("the part {name} has no *END PART"), part.place);
    let help = match before == place {
        true => "write it behind the last card of the part".to_string(),
        false => format!(
            "write it before line {}: parts do not stand in each other, nor does anything else stand in a part but its mesh and its sections",
            before.line
        ),
    };
    reader.messages.error(place, message, &help);
    keep_part(&mut reader.structure);
}

fn without_end_instance(reader: &mut Reader) {
    let (Some(open), Some(i)) = (&reader.structure.instance, reader.scope.instance) else {
        return;
    };
    let (place, name) = (open.place, reader.scope.numbering.instances()[i].clone());
    let message = format!("the instance {name} has no *END INSTANCE");
    let help = "write it behind the lines of the instance, even where they are the last";
    reader.messages.error(place, message, help);
    leave_instance(reader);
}

fn without_end_assembly(reader: &mut Reader) {
    let Some(assembly) = &mut reader.structure.assembly else {
        return;
    };
    assembly.open = false;
    let place = assembly.place;
    let message = "*ASSEMBLY has no *END ASSEMBLY";
    let help = "write it behind the instances, sets and surfaces of the assembly, before materials and steps";
    reader.messages.error(place, message, help);
}

/// Whether a card may stand where it does; it is an error if not.
pub(super) fn in_its_place(reader: &mut Reader, card: &Card, level: Level, beneath: bool) -> bool {
    let inside = reader.structure.inside();
    if inside.allows(level) {
        reader.structure.misplaced = false;
        return true;
    }
    if beneath && reader.structure.misplaced {
        // It goes with the card above.
        return false;
    }
    reader.structure.misplaced = !beneath;
    let (whose, help) = match inside {
        Inside::Assembly => (
            "the assembly".to_string(),
            "write it behind *END ASSEMBLY: the assembly has instances, nodes, elements, sets, surfaces, ties and equations",
        ),
        _ => (
            match (&reader.structure.part, reader.scope.instance) {
                (Some((name, _)), _) => format!("the part {name}"),
                (None, Some(i)) => {
                    format!("the instance {}", reader.scope.numbering.instances()[i])
                }
                (None, None) => "a part".to_string(),
            },
            match card.keyword.as_str() {
                "TIE" => "write it in *ASSEMBLY, behind the instances",
                _ => {
                    "write it behind *END ASSEMBLY: a part or an instance has nodes, elements, sets, surfaces, sections, orientations and equations"
                }
            },
        ),
    };
    let message = format!("{} stands in {whose}", card.written);
    reader.messages.error(card.place, message, help);
    false
}

/// Keeps a card of a part for its instances; `false` if it is to be read now.
pub(super) fn record(structure: &mut Structure, level: Level) -> bool {
    match &mut structure.part {
        Some((_, part)) if level != Level::Structure => {
            part.cards.push(structure.at);
            true
        }
        _ => false,
    }
}

pub(super) fn part(reader: &mut Reader, card: &Card) {
    let messages = &mut reader.messages;
    let name = required(messages, card, "NAME").unwrap_or_default();
    if reader.structure.inside() != Inside::Model {
        let message = format!("{} stands in the assembly", card.written);
        messages.error(card.place, message, "write the parts before *ASSEMBLY");
    }
    if reader.structure.parts.contains_key(&name) {
        let help = "names of parts are unique: blanks and case do not count";
        messages.error(card.place, format!("the part {name} is given twice"), help);
    }
    let part = Part {
        place: card.place,
        ..Part::default()
    };
    reader.structure.part = Some((name, part));
}

fn keep_part(structure: &mut Structure) {
    if let Some((name, part)) = structure.part.take() {
        structure.parts.entry(name).or_insert(part);
    }
}

pub(super) fn end_part(reader: &mut Reader, card: &Card) {
    if reader.structure.part.is_none() {
        let message = format!("{} without *PART", card.written);
        let help = "a part begins with *PART, NAME=...";
        reader.messages.error(card.place, message, help);
    }
    keep_part(&mut reader.structure);
}

pub(super) fn assembly(reader: &mut Reader, card: &Card) {
    let messages = &mut reader.messages;
    let name = required(messages, card, "NAME").unwrap_or_default();
    if reader.structure.assembly.is_some() {
        let help = "a deck has one: put all instances into it";
        messages.error(card.place, "there is an *ASSEMBLY already", help);
    }
    reader.system = Motion::NONE;
    reader.scope.assembly = Some(name);
    reader.structure.assembly = Some(Assembly {
        open: true,
        place: card.place,
    });
}

pub(super) fn end_assembly(reader: &mut Reader, card: &Card) {
    match &mut reader.structure.assembly {
        Some(assembly) if assembly.open => assembly.open = false,
        _ => {
            let message = format!("{} without *ASSEMBLY", card.written);
            let help = "an assembly begins with *ASSEMBLY, NAME=...";
            reader.messages.error(card.place, message, help);
        }
    }
    reader.system = Motion::NONE;
}

pub(super) fn instance(reader: &mut Reader, card: &Card) {
    let messages = &mut reader.messages;
    let name = required(messages, card, "NAME").unwrap_or_default();
    if reader.structure.inside() != Inside::Assembly {
        let message = format!("{} stands outside of *ASSEMBLY", card.written);
        let help = "write it between *ASSEMBLY and *END ASSEMBLY, behind the parts";
        messages.error(card.place, message, help);
    }
    if reader.scope.numbering.find(&name).is_some() {
        let message = format!("the instance {name} is given twice");
        let help = "names of instances are unique: blanks and case do not count";
        messages.error(card.place, message, help);
    }
    let motion = placed(messages, card);
    reader.scope.motions.push(motion);
    reader.scope.instance = Some(reader.scope.numbering.add(name));
    reader.structure.instance = Some(OpenInstance {
        place: card.place,
        system: reader.system,
    });
    reader.system = Motion::NONE;
    if let Some(part) = card.get("PART") {
        reader.structure.due = ready_part(reader, part, card.place);
    }
}

/// Where an instance is put: a translation, and behind it a rotation.
fn placed(messages: &mut Messages, card: &Card) -> Motion {
    if let Some(data) = card.data.first().filter(|d| d.fields.len() > 3) {
        let message = format!("{}: the first line has three numbers", card.written);
        let help = "write the translation x, y, z, and the rotation in the line behind it: two points of the axis and the angle in degrees";
        messages.error(data.place, message, help);
        return Motion::NONE;
    }
    if let Some(more) = card.data.get(2) {
        let message = format!("{}: this line is not read", card.written);
        let help = "the lines are: translation x, y, z; rotation ax, ay, az, bx, by, bz, angle";
        messages.error(more.place, message, help);
    }
    let mut motion = Motion::NONE;
    if let Some(data) = card.data.first() {
        motion = Motion::by([0, 1, 2].map(|i| number(messages, data, i, 0.0)));
    }
    let Some(data) = card.data.get(1).filter(|d| !d.fields.is_empty()) else {
        return motion;
    };
    if data.fields.len() != 7 {
        let message = format!("{}: a rotation has seven numbers", card.written);
        let help =
            "write two points of the axis and the angle in degrees: ax, ay, az, bx, by, bz, angle";
        messages.error(data.place, message, help);
        return motion;
    }
    let v: [f64; 7] = std::array::from_fn(|i| number(messages, data, i, 0.0));
    let turned = motion.then_turned([v[0], v[1], v[2]], [v[3], v[4], v[5]], v[6]);
    if turned.is_none() {
        let message = format!("{}: the points of the axis are one", card.written);
        let help = "write two points that differ: ax, ay, az, bx, by, bz, angle";
        messages.error(data.place, message, help);
    }
    turned.unwrap_or(motion)
}

/// The part of an instance, if its cards can be read for it.
fn ready_part(reader: &mut Reader, name: &str, place: Place) -> Option<String> {
    let messages = &mut reader.messages;
    let parts = &mut reader.structure.parts;
    let exact = parts.contains_key(name).then(|| name.to_string());
    let alike = || parts.keys().find(|p| squeeze(p) == squeeze(name)).cloned();
    let Some(found) = exact.or_else(alike) else {
        let known: Vec<&String> = parts.keys().collect();
        let help = nearest(name, "parts", &known);
        reader.structure.incomplete = true;
        messages.error(place, format!("there is no part {}", clip(name)), &help);
        return None;
    };
    let part = parts.get_mut(&found)?;
    part.instances += 1;
    let lines = |i: &usize| 1 + reader.source.cards[*i].data.len();
    reader.structure.lines += part.cards.iter().map(lines).sum::<usize>();
    if reader.structure.lines > MOST_LINES {
        reader.structure.incomplete = true;
        let message = format!("the instances have more than {MOST_LINES} lines");
        messages.error(place, message, "write fewer or smaller parts");
        return None;
    }
    Some(found)
}

pub(super) fn end_instance(reader: &mut Reader, card: &Card) {
    if reader.structure.instance.is_none() {
        let message = format!("{} without *INSTANCE", card.written);
        let help = "an instance begins with *INSTANCE, NAME=..., PART=...";
        reader.messages.error(card.place, message, help);
        return;
    }
    leave_instance(reader);
}

fn leave_instance(reader: &mut Reader) {
    if let (Some(open), Some(i)) = (reader.structure.instance.take(), reader.scope.instance) {
        judge_plane(reader, i, open.place);
        reader.system = open.system;
    }
    reader.scope.instance = None;
}

/// Plane elements that were turned out of their plane would be flattened: it is an error.
fn judge_plane(reader: &mut Reader, instance: usize, place: Place) {
    if reader.scope.motion().in_plane() {
        return;
    }
    let Some((first, last)) = reader.scope.numbering.span(Some(instance), 0, u64::MAX) else {
        return;
    };
    let mut plane = None;
    for (_, e) in reader.deck.elements.range(first..=last) {
        match abaqus::element_type(&e.kind) {
            // Plane elements beside solid ones only carry sets.
            Ok(t) if t.space == Space::Solid => return,
            Ok(_) => plane = plane.or(Some(e.kind.clone())),
            Err(_) => {}
        }
    }
    if let Some(kind) = plane {
        let name = &reader.scope.numbering.instances()[instance];
        let message = format!(
            "the instance {name} is turned out of the plane in which its elements ({kind}) lie"
        );
        let help = "plane and axisymmetric elements lie in the plane z = 0: turn them about an axis along z";
        reader.messages.error(place, message, help);
    }
}
