//! Materials and sections.

use super::{Context, Reader};
use crate::deck::{Elastic, Material, Orientation, Section};
use crate::source::{Card, Data};

/// Data lines as one list of numbers, as long as asked for.
fn numbers(reader: &mut Reader, card: &Card, count: usize) -> Vec<f64> {
    let mut out = Vec::with_capacity(count);
    for data in &card.data {
        // Eight numbers a line, whatever is missing at its end.
        let here = (count - out.len()).min(8);
        out.extend((0..here).map(|i| reader.number(data, i, 0.0)));
        if out.len() == count {
            break;
        }
    }
    out.resize(count, 0.0);
    out
}

impl Reader<'_> {
    pub(super) fn material(&mut self, card: &Card) {
        self.parameters(card, &["NAME"], &["SRATE"]);
        let Some(name) = self.required(card, "NAME") else {
            return;
        };
        let material = Material {
            place: card.place,
            ..Material::default()
        };
        if self.deck.materials.insert(name.clone(), material).is_some() {
            self.error(
                card.place,
                format!("the material {name} is given twice"),
                "names are unique: blanks and case do not count",
            );
        }
        self.context = Context::Material(name);
    }

    /// The material that the card belongs to.
    fn own(&mut self, card: &Card) -> Option<&mut Material> {
        if let Context::Material(name) = self.context.clone() {
            return self.deck.materials.get_mut(&name);
        }
        self.error(
            card.place,
            format!("{} belongs to no material", card.written),
            "write it beneath *MATERIAL",
        );
        None
    }

    fn first_temperature(&mut self, card: &Card, lines: usize) {
        if card.data.len() > lines {
            self.note(
                card.place,
                format!(
                    "{}: only the values of the first temperature are used",
                    card.written
                ),
            );
        }
    }

    pub(super) fn elastic(&mut self, card: &Card) {
        self.parameters(card, &["TYPE"], &["MODULI"]);
        let kind = card.get("TYPE").unwrap_or("ISO").to_string();
        if self.line(card).is_none() {
            return;
        }
        let elastic = match kind.as_str() {
            "ISO" | "ISOTROPIC" | "" => {
                let v = numbers(self, card, 2);
                self.first_temperature(card, 1);
                Elastic::Isotropic([v[0], v[1]])
            }
            "ENGINEERINGCONSTANTS" => {
                let v = numbers(self, card, 9);
                self.first_temperature(card, 2);
                Elastic::Engineering(std::array::from_fn(|i| v[i]))
            }
            "ORTHO" | "ORTHOTROPIC" => {
                let v = numbers(self, card, 9);
                self.first_temperature(card, 2);
                let mut c = [[0.0; 6]; 6];
                for (k, (i, j)) in [
                    (0, 0),
                    (0, 1),
                    (1, 1),
                    (0, 2),
                    (1, 2),
                    (2, 2),
                    (3, 3),
                    (4, 4),
                    (5, 5),
                ]
                .into_iter()
                .enumerate()
                {
                    c[i][j] = v[k];
                    c[j][i] = v[k];
                }
                Elastic::Full(Box::new(c))
            }
            "ANISO" | "ANISOTROPIC" => {
                let v = numbers(self, card, 21);
                self.first_temperature(card, 3);
                let mut c = [[0.0; 6]; 6];
                // The upper triangle, column by column.
                let upper = (0..6).flat_map(|j| (0..=j).map(move |i| (i, j)));
                for ((i, j), value) in upper.zip(v) {
                    c[i][j] = value;
                    c[j][i] = value;
                }
                Elastic::Full(Box::new(c))
            }
            other => {
                let message = format!("*ELASTIC of type {other} is not supported");
                self.error(
                    card.place,
                    message,
                    "types are ISO, ORTHO, ENGINEERING CONSTANTS and ANISO",
                );
                return;
            }
        };
        if let Some(material) = self.own(card) {
            material.elastic = Some(elastic);
        }
    }

    pub(super) fn density(&mut self, card: &Card) {
        let Some(data) = self.line(card) else { return };
        let value = self.number(data, 0, 0.0);
        self.first_temperature(card, 1);
        if let Some(material) = self.own(card) {
            material.density = Some(value);
        }
    }

    pub(super) fn damping(&mut self, card: &Card) {
        self.parameters(card, &["ALPHA", "BETA"], &["STRUCTURAL", "COMPOSITE"]);
        let [alpha, beta] =
            ["ALPHA", "BETA"].map(|name| super::parameter(self, card, name).unwrap_or(0.0));
        if let Some(material) = self.own(card) {
            material.damping = Some([alpha, beta]);
        }
    }

    pub(super) fn solid_section(&mut self, card: &Card) {
        self.parameters(
            card,
            &["ELSET", "MATERIAL", "ORIENTATION"],
            &["CONTROLS", "STACKDIRECTION", "COMPOSITE"],
        );
        if card.has("COMPOSITE") {
            self.error(
                card.place,
                "composite sections are not supported",
                "give each layer elements and a *SOLID SECTION of its own",
            );
            return;
        }
        let (Some(set), Some(material)) = (
            self.required(card, "ELSET"),
            self.required(card, "MATERIAL"),
        ) else {
            return;
        };
        let thickness = card
            .data
            .first()
            .map(|d: &Data| self.number(d, 0, 0.0))
            .filter(|t| *t > 0.0);
        let orientation = card.get("ORIENTATION").map(str::to_string);
        self.deck.sections.push(Section {
            set,
            material,
            orientation,
            thickness,
            place: card.place,
        });
    }

    pub(super) fn orientation(&mut self, card: &Card) {
        self.parameters(card, &["NAME", "SYSTEM", "DEFINITION"], &[]);
        let Some(name) = self.required(card, "NAME") else {
            return;
        };
        let uniform = match card.get("SYSTEM").unwrap_or("RECTANGULAR") {
            "RECTANGULAR" | "" => true,
            "CYLINDRICAL" => false,
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
        let v: Vec<f64> = (0..9).map(|i| self.number(data, i, 0.0)).collect();
        let (a, b, c) = ([v[0], v[1], v[2]], [v[3], v[4], v[5]], [v[6], v[7], v[8]]);
        let less = |x: [f64; 3]| [x[0] - c[0], x[1] - c[1], x[2] - c[2]];
        // A cylinder is given by two points of its axis.
        let found = match uniform {
            true => frame(less(a), less(b)),
            false => Some([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]),
        };
        let Some(mut axes) = found else {
            self.error(
                data.place,
                "the two points do not span a plane",
                "give a point on the axis 1 and one in the plane 1-2, beside the axis",
            );
            return;
        };
        if let Some(line) = card.data.get(1) {
            let about = self.whole(line, 0).unwrap_or(0) as usize;
            let angle = self.number(line, 1, 0.0).to_radians();
            if !(1..=3).contains(&about) {
                self.error(
                    line.place,
                    "the axis of the further rotation is 1, 2 or 3",
                    "write axis, angle in degrees",
                );
                return;
            }
            let (i, j) = (about % 3, (about + 1) % 3);
            let (s, c) = angle.sin_cos();
            let (p, q) = (axes[i], axes[j]);
            axes[i] = std::array::from_fn(|k| c * p[k] + s * q[k]);
            axes[j] = std::array::from_fn(|k| c * q[k] - s * p[k]);
        }
        self.deck.orientations.insert(
            name,
            Orientation {
                axes,
                uniform,
                place: card.place,
            },
        );
    }
}

/// Orthonormal axes from a vector along the first and one in the plane of the first two.
pub(crate) fn frame(a: [f64; 3], b: [f64; 3]) -> Option<[[f64; 3]; 3]> {
    use stickslip::math::{cross, normalize};
    let one = normalize(a)?;
    let three = normalize(cross(one, b))?;
    Some([one, cross(three, one), three])
}
