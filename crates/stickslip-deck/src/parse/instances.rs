//! `*PART`, `*ASSEMBLY` and `*INSTANCE`: a deck that is built of instances becomes flat as it is read.
//!
//! The cards of a part are kept, and read for every instance with the numbers, names and place that the instance has. So each card is read
//! by the function that reads it in a flat deck.

use stickslip::io::abaqus::{self, Space};

use super::generate_elements;
use super::known::nearest;
use super::reader::Reader;
use super::structure::{Assembly, Inside, Level, OpenInstance, Part};
use super::table::{self, Row};
use crate::card::{Card, Place};
use crate::motion::Motion;
use crate::numbering::Numbering;
use crate::source::Source;
use crate::text::{clip, squeeze, whole};

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
    let numbers = lines.filter_map(|d| whole(d.fields.first()?));
    let most = numbers.max().unwrap_or(0);
    let made = source.cards.iter().map(generate_elements::farther);
    Numbering::new(count, made.fold(most, u64::saturating_add))
}

impl Reader<'_> {
    /// Closes what has no end of its own where a card can only stand behind it.
    pub(super) fn close_before(&mut self, card: &Card, row: &Row) {
        let keyword = card.keyword.as_str();
        let structure = row.level == Level::Structure;
        let ends = |own: &str| keyword == "STEP" || (keyword != own && structure);
        if self.structure.part.is_some() && ends("ENDPART") {
            self.without_end_part(card.place);
        }
        if self.structure.instance.is_some() && ends("ENDINSTANCE") {
            self.without_end_instance();
        }
        let other = matches!(keyword, "STEP" | "ASSEMBLY");
        if other && self.structure.inside() == Inside::Assembly {
            self.without_end_assembly();
        }
    }

    /// What is still open at the end of the deck.
    pub(super) fn close_all(&mut self) {
        if let Some((_, part)) = &self.structure.part {
            let place = part.place;
            self.without_end_part(place);
        }
        if self.structure.instance.is_some() {
            self.without_end_instance();
        }
        if self.structure.inside() == Inside::Assembly {
            self.without_end_assembly();
        }
        let left: Vec<(String, Place)> = (self.structure.parts.iter())
            .filter(|(_, p)| p.instances == 0)
            .map(|(name, p)| (name.clone(), p.place))
            .collect();
        if let Some((name, place)) = left.first()
            && self.deck.numbering.instances().is_empty()
        {
            // Nothing is in the model; what has been said may be why.
            self.structure.incomplete = true;
            if self.sound() {
                self.error(
                    *place,
                    format!("the part {name} has no instance, nor has any other"),
                    "put it into the model: *ASSEMBLY, *INSTANCE, NAME=..., PART=..., *END INSTANCE, *END ASSEMBLY",
                );
            }
            return;
        }
        for (name, place) in left {
            self.note(
                place,
                format!("the part {name} has no instance: it is left out"),
            );
        }
    }

    fn without_end_part(&mut self, before: Place) {
        let Some((name, part)) = &self.structure.part else {
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
        self.error(place, message, &help);
        self.keep_part();
    }

    fn without_end_instance(&mut self) {
        let (Some(open), Some(i)) = (&self.structure.instance, self.scope) else {
            return;
        };
        let (place, name) = (open.place, self.deck.numbering.instances()[i].clone());
        self.error(
            place,
            format!("the instance {name} has no *END INSTANCE"),
            "write it behind the lines of the instance, even where they are the last",
        );
        self.leave_instance();
    }

    fn without_end_assembly(&mut self) {
        let Some(assembly) = &mut self.structure.assembly else {
            return;
        };
        assembly.open = false;
        let place = assembly.place;
        self.error(
            place,
            "*ASSEMBLY has no *END ASSEMBLY",
            "write it behind the instances, sets and surfaces of the assembly, before materials and steps",
        );
    }

    /// Whether a card may stand where it does; it is an error if not.
    pub(super) fn in_its_place(&mut self, card: &Card, row: &Row) -> bool {
        let inside = self.structure.inside();
        let beneath = row.beneath;
        if inside.allows(row.level) {
            self.structure.misplaced = false;
            return true;
        }
        if beneath && self.structure.misplaced {
            // It goes with the card above.
            return false;
        }
        self.structure.misplaced = !beneath;
        let (whose, help) = match inside {
            Inside::Assembly => (
                "the assembly".to_string(),
                "write it behind *END ASSEMBLY: the assembly has instances, nodes, elements, sets, surfaces, ties and equations",
            ),
            _ => (
                match (&self.structure.part, self.scope) {
                    (Some((name, _)), _) => format!("the part {name}"),
                    (None, Some(i)) => {
                        format!("the instance {}", self.deck.numbering.instances()[i])
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
        self.error(
            card.place,
            format!("{} stands in {whose}", card.written),
            help,
        );
        false
    }

    /// Keeps a card of a part for its instances; `false` if it is to be read now.
    pub(super) fn record(&mut self, row: &Row) -> bool {
        match &mut self.structure.part {
            Some((_, part)) if row.level != Level::Structure => {
                part.cards.push(self.structure.at);
                true
            }
            _ => false,
        }
    }

    pub(super) fn part(&mut self, card: &Card) {
        let name = self.required(card, "NAME").unwrap_or_default();
        if self.structure.inside() != Inside::Model {
            self.error(
                card.place,
                format!("{} stands in the assembly", card.written),
                "write the parts before *ASSEMBLY",
            );
        }
        if self.structure.parts.contains_key(&name) {
            self.error(
                card.place,
                format!("the part {name} is given twice"),
                "names of parts are unique: blanks and case do not count",
            );
        }
        let part = Part {
            place: card.place,
            ..Part::default()
        };
        self.structure.part = Some((name, part));
    }

    fn keep_part(&mut self) {
        if let Some((name, part)) = self.structure.part.take() {
            self.structure.parts.entry(name).or_insert(part);
        }
    }

    pub(super) fn end_part(&mut self, card: &Card) {
        if self.structure.part.is_none() {
            let message = format!("{} without *PART", card.written);
            self.error(card.place, message, "a part begins with *PART, NAME=...");
        }
        self.keep_part();
    }

    pub(super) fn assembly(&mut self, card: &Card) {
        let name = self.required(card, "NAME").unwrap_or_default();
        if self.structure.assembly.is_some() {
            self.error(
                card.place,
                "there is an *ASSEMBLY already",
                "a deck has one: put all instances into it",
            );
        }
        self.system = Motion::NONE;
        self.structure.assembly = Some(Assembly {
            name,
            open: true,
            place: card.place,
        });
    }

    pub(super) fn end_assembly(&mut self, card: &Card) {
        match &mut self.structure.assembly {
            Some(assembly) if assembly.open => assembly.open = false,
            _ => {
                let message = format!("{} without *ASSEMBLY", card.written);
                self.error(
                    card.place,
                    message,
                    "an assembly begins with *ASSEMBLY, NAME=...",
                );
            }
        }
        self.system = Motion::NONE;
    }

    pub(super) fn instance(&mut self, card: &Card) {
        let name = self.required(card, "NAME").unwrap_or_default();
        if self.structure.inside() != Inside::Assembly {
            self.error(
                card.place,
                format!("{} stands outside of *ASSEMBLY", card.written),
                "write it between *ASSEMBLY and *END ASSEMBLY, behind the parts",
            );
        }
        if self.deck.numbering.find(&name).is_some() {
            self.error(
                card.place,
                format!("the instance {name} is given twice"),
                "names of instances are unique: blanks and case do not count",
            );
        }
        let motion = self.placed(card);
        self.structure.motions.push(motion);
        self.scope = Some(self.deck.numbering.add(name));
        self.structure.instance = Some(OpenInstance {
            place: card.place,
            system: self.system,
        });
        self.system = Motion::NONE;
        if let Some(part) = card.get("PART").map(str::to_string) {
            self.read_part(&part, card.place);
        }
    }

    /// Where an instance is put: a translation, and behind it a rotation.
    fn placed(&mut self, card: &Card) -> Motion {
        if let Some(data) = card.data.first().filter(|d| d.fields.len() > 3) {
            self.error(
                data.place,
                format!("{}: the first line has three numbers", card.written),
                "write the translation x, y, z, and the rotation in the line behind it: two points of the axis and the angle in degrees",
            );
            return Motion::NONE;
        }
        if let Some(more) = card.data.get(2) {
            self.error(
                more.place,
                format!("{}: this line is not read", card.written),
                "the lines are: translation x, y, z; rotation ax, ay, az, bx, by, bz, angle",
            );
        }
        let mut motion = Motion::NONE;
        if let Some(data) = card.data.first() {
            motion = Motion::by([0, 1, 2].map(|i| self.number(data, i, 0.0)));
        }
        let Some(data) = card.data.get(1).filter(|d| !d.fields.is_empty()) else {
            return motion;
        };
        if data.fields.len() != 7 {
            self.error(
                data.place,
                format!("{}: a rotation has seven numbers", card.written),
                "write two points of the axis and the angle in degrees: ax, ay, az, bx, by, bz, angle",
            );
            return motion;
        }
        let v: [f64; 7] = std::array::from_fn(|i| self.number(data, i, 0.0));
        let turned = motion.then_turned([v[0], v[1], v[2]], [v[3], v[4], v[5]], v[6]);
        if turned.is_none() {
            self.error(
                data.place,
                format!("{}: the points of the axis are one", card.written),
                "write two points that differ: ax, ay, az, bx, by, bz, angle",
            );
        }
        turned.unwrap_or(motion)
    }

    /// Reads the cards of a part for the instance that is open.
    fn read_part(&mut self, name: &str, place: Place) {
        let parts = &mut self.structure.parts;
        let exact = parts.contains_key(name).then(|| name.to_string());
        let alike = || parts.keys().find(|p| squeeze(p) == squeeze(name)).cloned();
        let Some(part) = exact.or_else(alike).and_then(|n| parts.get_mut(&n)) else {
            let known: Vec<&String> = self.structure.parts.keys().collect();
            let help = nearest(name, "parts", &known);
            self.structure.incomplete = true;
            self.error(place, format!("there is no part {}", clip(name)), &help);
            return;
        };
        let again = part.instances > 0;
        part.instances += 1;
        let list = part.cards.clone();
        let source = self.source;
        self.structure.lines += list
            .iter()
            .map(|i| 1 + source.cards[*i].data.len())
            .sum::<usize>();
        if self.structure.lines > MOST_LINES {
            self.structure.incomplete = true;
            self.error(
                place,
                format!("the instances have more than {MOST_LINES} lines"),
                "write fewer or smaller parts",
            );
            return;
        }
        self.structure.again = again;
        for i in list {
            if let Some(read) = table::row(&source.cards[i].keyword).and_then(|r| r.reader) {
                read(self, &source.cards[i]);
            }
        }
        self.structure.again = false;
        // Axes of the part are not those of what the instance adds.
        self.system = Motion::NONE;
    }

    pub(super) fn end_instance(&mut self, card: &Card) {
        if self.structure.instance.is_none() {
            let message = format!("{} without *INSTANCE", card.written);
            self.error(
                card.place,
                message,
                "an instance begins with *INSTANCE, NAME=..., PART=...",
            );
            return;
        }
        self.leave_instance();
    }

    fn leave_instance(&mut self) {
        if let (Some(open), Some(i)) = (self.structure.instance.take(), self.scope) {
            self.judge_plane(i, open.place);
            self.system = open.system;
        }
        self.scope = None;
    }

    /// Plane elements that were turned out of their plane would be flattened: it is an error.
    fn judge_plane(&mut self, instance: usize, place: Place) {
        if self.motion().in_plane() {
            return;
        }
        let Some((first, last)) = self.deck.numbering.span(Some(instance), 0, u64::MAX) else {
            return;
        };
        let mut plane = None;
        for (_, e) in self.deck.elements.range(first..=last) {
            match abaqus::element_type(&e.kind) {
                // Plane elements beside solid ones only carry sets.
                Ok(t) if t.space == Space::Solid => return,
                Ok(_) => plane = plane.or(Some(e.kind.clone())),
                Err(_) => {}
            }
        }
        if let Some(kind) = plane {
            let name = &self.deck.numbering.instances()[instance];
            let message = format!(
                "the instance {name} is turned out of the plane in which its elements ({kind}) lie"
            );
            self.error(
                place,
                message,
                "plane and axisymmetric elements lie in the plane z = 0: turn them about an axis along z",
            );
        }
    }
}
