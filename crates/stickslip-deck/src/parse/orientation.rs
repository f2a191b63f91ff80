//! Axes of materials: the same everywhere, about a cylinder, or by element.

use std::collections::BTreeMap;

use super::known::absent;
use super::reader::Reader;
use crate::card::{Card, Data};
use crate::deck::{Distribution, DistributionLine, Local, Orientation, Target};
use crate::taken::Taken;
use crate::text::{number, squeeze};

impl Reader<'_> {
    /// Two points and the origin, from a field on.
    fn points(&mut self, data: &Data, from: usize) -> [[f64; 3]; 3] {
        let mut at = |k: usize| [0, 1, 2].map(|i| self.number(data, from + 3 * k + i, 0.0));
        [at(0), at(1), at(2)]
    }

    pub(super) fn orientation(&mut self, card: &Card) {
        let Some(name) = self.required_name(card, "NAME") else {
            return;
        };
        let cylindrical = match card.get("SYSTEM").unwrap_or("RECTANGULAR") {
            "RECTANGULAR" | "" => false,
            "CYLINDRICAL" => true,
            other => {
                self.error(
                    card.place,
                    format!("*ORIENTATION: the system {other} is not supported"),
                    "systems are RECTANGULAR and CYLINDRICAL",
                );
                return;
            }
        };
        if card.get("DEFINITION").is_some_and(|d| d != "COORDINATES") {
            self.error(
                card.place,
                "*ORIENTATION: only DEFINITION=COORDINATES is read",
                "give a point on the axis 1 and one in the plane 1-2",
            );
            return;
        }
        let Some(data) = self.line(card) else { return };
        let first = data.fields.first().map_or("", String::as_str);
        let distribution = (!first.is_empty() && number(first).is_none()).then(|| self.name(first));
        let Ok(turn) = self.further_turn(card) else {
            return;
        };
        let taken = Taken {
            cylindrical,
            turn,
            motion: self.motion(),
            distribution,
        };
        let found = match taken.distribution {
            Some(_) => Some(Local::Axes([[0.0; 3]; 3])),
            None => {
                let points = self.points(data, 0);
                taken.local(points)
            }
        };
        let Some(local) = found else {
            self.no_axes(data, cylindrical);
            return;
        };
        let orientation = Orientation {
            local,
            elements: BTreeMap::new(),
            taken,
            place: card.place,
        };
        if self
            .deck
            .properties
            .orientations
            .insert(name.clone(), orientation)
            .is_some()
        {
            self.error(
                card.place,
                format!("the orientation {name} is given twice"),
                "give each orientation a name of its own",
            );
        }
    }

    /// The second line: a further rotation. An error if it cannot be read, which has been said.
    fn further_turn(&mut self, card: &Card) -> Result<Option<(usize, f64)>, ()> {
        if let Some(more) = card.data.get(2).filter(|d| !d.fields.is_empty()) {
            self.error(
                more.place,
                "*ORIENTATION: this line is not read",
                "the lines are: two points and the origin; axis and angle of a further rotation",
            );
        }
        let Some(line) = card.data.get(1).filter(|d| !d.fields.is_empty()) else {
            return Ok(None);
        };
        let about = self.whole(line, 0).unwrap_or(0) as usize;
        let angle = self.number(line, 1, 0.0).to_radians();
        if !(1..=3).contains(&about) {
            self.error(
                line.place,
                "the axis of the further rotation is 1, 2 or 3",
                "write axis, angle in degrees",
            );
            return Err(());
        }
        if angle != 0.0 && card.get("SYSTEM") == Some("CYLINDRICAL") {
            self.error(
                line.place,
                "a further rotation of cylindrical axes is not supported",
                "leave the line out, and turn the constants of the material",
            );
            return Err(());
        }
        Ok(Some((about - 1, angle)))
    }

    fn no_axes(&mut self, data: &Data, cylindrical: bool) {
        match cylindrical {
            true => self.error(
                data.place,
                "the two points of the axis of the cylinder are one",
                "give two points of the axis",
            ),
            false => self.error(
                data.place,
                "the two points do not span a plane",
                "give a point on the axis 1 and one in the plane 1-2, beside the axis",
            ),
        }
    }

    /// `*DISTRIBUTION TABLE`: what the numbers of a distribution are.
    pub(super) fn distribution_table(&mut self, card: &Card) {
        if self.required_name(card, "NAME").is_none() {
            return;
        }
        let Some(data) = self.line(card) else { return };
        let kinds: Vec<String> = data.fields.iter().map(|f| squeeze(f)).collect();
        if kinds.iter().any(|k| k != "COORD3D") || kinds.len() != 2 {
            self.error(
                data.place,
                format!("distributions of {} are not supported", kinds.join(", ")),
                "*DISTRIBUTION gives axes by element: COORD3D, COORD3D",
            );
        }
    }

    /// Points of axes by element.
    pub(super) fn distribution(&mut self, card: &Card) {
        let Some(name) = self.required_name(card, "NAME") else {
            return;
        };
        if card.get("LOCATION").is_some_and(|l| l != "ELEMENT") {
            self.error(
                card.place,
                "*DISTRIBUTION: only LOCATION=ELEMENT is read",
                "give axes by element",
            );
            return;
        }
        let Some(first) = self.line(card) else { return };
        if first.fields.first().is_some_and(|f| !f.is_empty()) {
            self.error(
                first.place,
                "the first line of a *DISTRIBUTION has the axes of all other elements",
                "begin the line with a comma: , ax, ay, az, bx, by, bz",
            );
            return;
        }
        let mut lines = Vec::new();
        for data in &card.data {
            self.no_more(data, 7, "*DISTRIBUTION");
            let first = data.fields.first().filter(|f| !f.is_empty());
            let elements = first.map(|text| match self.number_of(text) {
                Some(element) => Target::One(element),
                None => Target::Set(self.name(text)),
            });
            lines.push(DistributionLine {
                elements,
                points: self.points(data, 1),
                data: data.clone(),
            });
        }
        let distribution = Distribution {
            lines,
            place: card.place,
        };
        if self
            .deck
            .properties
            .distributions
            .insert(name.clone(), distribution)
            .is_some()
        {
            self.error(
                card.place,
                format!("the distribution {name} is given twice"),
                "give each distribution a name of its own",
            );
        }
    }

    /// Gives orientations the axes of their distributions, which may stand behind them.
    pub(super) fn settle_distributions(&mut self) {
        let orientations: Vec<_> = (self.deck.properties.orientations.iter())
            .map(|(key, o)| (key.clone(), o.place, o.taken.clone()))
            .collect();
        for (key, place, taken) in orientations {
            let Some(name) = taken.distribution.clone() else {
                continue;
            };
            let bare = self.deck.numbering.bare(&name).to_string();
            let distributions = &self.deck.properties.distributions;
            let known = distributions
                .get(&name)
                .or_else(|| distributions.get(&bare));
            let Some(lines) = known.map(|distribution| distribution.lines.clone()) else {
                let all = distributions.keys();
                let (message, help) = absent(&self.deck.numbering, "distribution", &name, all);
                self.error(place, message, &help);
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
                    None => self.no_axes(data, taken.cylindrical),
                    Some(local) if i == 0 => general = Some(local),
                    Some(local) => {
                        // Sets may stand behind the distribution.
                        let all = match elements {
                            Some(Target::Set(name)) => self.elements_named(name, name, data.place),
                            Some(Target::One(e)) if self.deck.elements.contains_key(e) => vec![*e],
                            Some(Target::One(e)) => {
                                let message =
                                    format!("there is no element {}", self.deck.label(*e));
                                let help = "*DISTRIBUTION names elements by number or set";
                                self.error(data.place, message, help);
                                Vec::new()
                            }
                            None => Vec::new(),
                        };
                        single.extend(all.into_iter().map(|e| (e, local.clone())));
                    }
                }
            }
            if let Some(o) = self.deck.properties.orientations.get_mut(&key) {
                o.local = general.unwrap_or_else(|| o.local.clone());
                o.elements.extend(single);
            }
        }
    }
}
