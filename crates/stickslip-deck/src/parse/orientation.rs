//! Axes of materials.

use super::reader::Reader;
use crate::axes::frame;
use crate::card::Card;
use crate::deck::Orientation;

impl Reader<'_> {
    pub(super) fn orientation(&mut self, card: &Card) {
        let Some(name) = self.required_name(card, "NAME") else {
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
        if let Some(more) = card.data.get(2).filter(|d| !d.fields.is_empty()) {
            self.error(
                more.place,
                "*ORIENTATION: this line is not read",
                "the lines are: two points and the origin; axis and angle of a further rotation",
            );
        }
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
        let motion = self.motion();
        let orientation = Orientation {
            // Those of a part go with its instance.
            axes: axes.map(|axis| motion.vector(axis)),
            uniform,
            place: card.place,
        };
        if self
            .deck
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
}
