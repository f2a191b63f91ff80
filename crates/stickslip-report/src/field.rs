//! Fields as single numbers on points: names, components, and what they are called.

use std::collections::BTreeMap;

use stickslip::io::vtu::PointArray;
use stickslip::math::symmetric_eigen;

/// A number on every point, made of an array of a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Field {
    /// Its name: `CPRESS`, `U` for the magnitude, `U1` for a component.
    pub name: String,
    /// The array it is made of.
    pub array: String,
    /// Which number of it.
    pub part: Part,
}

/// Which number is made of an array.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Part {
    /// One of its components.
    Component(usize),
    /// The magnitude of a vector.
    Magnitude,
    /// An invariant of the stress, by its place in the table of them.
    Invariant(usize),
}

/// An invariant of the stress: name, words, and the number, of principal stresses in descending order.
type Invariant = (&'static str, &'static str, fn([f64; 3]) -> f64);

/// Invariants of the stress beside that of von Mises, which files have.
const INVARIANTS: &[Invariant] = &[
    ("S1", "largest principal stress", |s| s[0]),
    ("S2", "middle principal stress", |s| s[1]),
    ("S3", "smallest principal stress", |s| s[2]),
    ("TRESCA", "Tresca stress, S1 - S3", |s| s[0] - s[2]),
    ("PRESS", "hydrostatic pressure", |s| {
        -(s[0] + s[1] + s[2]) / 3.0
    }),
];

/// The principal stresses, the largest first, of the components 11, 22, 33, 12, 23, 13.
fn principal(s: &[f64]) -> [f64; 3] {
    let matrix = [[s[0], s[3], s[5]], [s[3], s[1], s[4]], [s[5], s[4], s[2]]];
    let (values, _) = symmetric_eigen(&matrix.map(Vec::from));
    [values[2], values[1], values[0]]
}

/// What is known of a field by the name of its array.
const WORDS: &[(&str, &str)] = &[
    ("CPRESS", "contact pressure"),
    ("CSTATUS", "contact status"),
    ("CSHEAR", "shear traction"),
    ("COPEN", "gap"),
    ("CSLIP", "slip"),
    ("CDISS", "dissipated per area"),
    ("CWEAR", "depth worn off"),
    ("TNORMAL", "normal traction of a tie"),
    ("TSHEAR", "shear traction of a tie"),
    ("CFORCE", "contact force"),
    ("MISES", "von Mises stress"),
    ("RF", "reaction"),
    ("S", "stress"),
    ("U", "displacement"),
    ("V", "velocity"),
    ("A", "acceleration"),
];

/// Names of fields and components that results mostly have.
pub const NAMES: &[&str] = &[
    "CPRESS", "CSTATUS", "COPEN", "CSHEAR1", "CSHEAR2", "CSLIP1", "CSLIP2", "CDISS", "CWEAR",
    "CFORCE", "TNORMAL", "TSHEAR1", "TSHEAR2", "MISES", "S11", "S22", "S33", "S12", "S23", "S13",
    "S1", "S2", "S3", "TRESCA", "PRESS", "U", "UMAG", "U1", "U2", "U3", "V", "A", "RF",
];

/// The field that holds the status of contact: 0 open, 1 stick, 2 slip.
pub const STATUS: &str = "CSTATUS";

/// Fields of contact that begin at zero and grow with what a surface carries.
const CARRIED_FIELDS: &[&str] = &["CPRESS", "CDISS", "CWEAR"];

/// The time of interest of a field.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Interest {
    /// That at which contact presses most.
    Pressure,
    /// The end: it grows all the time.
    End,
    /// That at which it is largest.
    Largest,
}

impl Field {
    /// Its time of interest.
    pub fn interest(&self) -> Interest {
        match self.stem() {
            "CPRESS" | "CSTATUS" | "CSHEAR" | "COPEN" => Interest::Pressure,
            "CDISS" | "CWEAR" => Interest::End,
            _ => Interest::Largest,
        }
    }

    /// Whether surfaces of contact have it and nothing else.
    pub fn of_contact(&self) -> bool {
        self.array.starts_with('C')
            && self.array != "CFORCE"
            && WORDS.iter().any(|(name, _)| self.stem() == *name)
    }

    /// Whether it begins at zero and grows with what a surface carries.
    pub fn carried(&self) -> bool {
        CARRIED_FIELDS.contains(&self.name.as_str())
    }

    /// Whether its sign changes where the model is mirrored along an axis. Directions along a surface are x laid into it, and the one across.
    pub fn turns(&self, axis: usize) -> bool {
        match (self.stem(), self.part) {
            ("CSHEAR" | "CSLIP" | "TSHEAR", _) => self.name.ends_with('1') == (axis == 0),
            ("U" | "V" | "A" | "RF" | "CFORCE", Part::Component(c)) => c == axis,
            ("S", Part::Component(c)) => [[3, 5], [3, 4], [4, 5]][axis].contains(&c),
            _ => false,
        }
    }

    /// The name of its array without the number of a direction.
    pub fn stem(&self) -> &str {
        self.array.trim_end_matches(['1', '2', '3'])
    }

    /// The name with what it means: `CPRESS, contact pressure`.
    pub fn label(&self) -> String {
        let stem = self.stem();
        let words = WORDS.iter().find(|(name, _)| *name == stem);
        match (words, self.part) {
            (_, Part::Invariant(i)) => format!("{}, {}", self.name, INVARIANTS[i].1),
            (None, _) => self.name.clone(),
            (Some((_, words)), Part::Magnitude)
                if self.array != self.name || WIDE.contains(&stem) =>
            {
                format!("{}, {words} (magnitude)", self.name)
            }
            (Some((_, words)), _) => format!("{}, {words}", self.name),
        }
    }

    /// The value at a point; NaN where the array has none.
    pub fn value(&self, array: &PointArray, point: usize) -> f64 {
        let n = array.components;
        let values = &array.values[n * point..n * (point + 1)];
        match self.part {
            Part::Component(c) => values.get(c).copied().unwrap_or(f64::NAN),
            Part::Invariant(_) if n != 6 => f64::NAN,
            Part::Invariant(i) => INVARIANTS[i].2(principal(values)),
            Part::Magnitude => values.iter().map(|v| v * v).sum::<f64>().sqrt(),
        }
    }
}

/// Vectors whose magnitude has the name of the array.
const WIDE: &[&str] = &["U", "V", "A", "RF", "CFORCE"];

/// The fields of a file: what belongs to contact first, then the displacement and stresses, then the rest.
pub fn fields(arrays: &BTreeMap<String, PointArray>) -> Vec<Field> {
    let mut all = Vec::new();
    for (name, array) in arrays {
        if name == "NODE_ID" {
            continue;
        }
        let mut push = |name: String, array: &str, part| {
            all.push(Field {
                name,
                array: array.to_string(),
                part,
            });
        };
        match array.components {
            1 => push(name.clone(), name, Part::Component(0)),
            6 => {
                for (c, which) in ["11", "22", "33", "12", "23", "13"].into_iter().enumerate() {
                    push(format!("{name}{which}"), name, Part::Component(c));
                }
            }
            n => {
                push(name.clone(), name, Part::Magnitude);
                for c in 0..n {
                    push(format!("{name}{}", c + 1), name, Part::Component(c));
                }
            }
        }
    }
    let order = |field: &Field| {
        let places = [
            "CPRESS", "CSHEAR1", "CSHEAR2", "CSTATUS", "COPEN", "CSLIP1", "CSLIP2", "CDISS",
            "CWEAR", "U", "MISES", "TNORMAL", "TSHEAR1", "TSHEAR2", "S", "V", "A", "RF", "CFORCE",
        ];
        let found = places.iter().position(|p| *p == field.array);
        found.unwrap_or(places.len())
    };
    all.sort_by_key(order);
    all
}

/// The fields of a file and the invariants of its stress.
pub fn with_invariants(arrays: &BTreeMap<String, PointArray>) -> Vec<Field> {
    let mut all = fields(arrays);
    if arrays.get("S").is_some_and(|s| s.components == 6) {
        let invariants = INVARIANTS.iter().enumerate().map(|(i, (name, ..))| Field {
            name: (*name).into(),
            array: "S".into(),
            part: Part::Invariant(i),
        });
        let place = all.iter().rposition(|f| f.array == "S").unwrap_or(0) + 1;
        all.splice(place..place, invariants);
    }
    all
}

/// The field of this name, in capitals or not; magnitudes have a longer name, too, as `UMAG`.
pub fn named(fields: &[Field], name: &str) -> Option<Field> {
    let vectors = fields.iter().filter(|f| f.part == Part::Magnitude);
    let long = |f: &Field| format!("{}MAG", f.name).eq_ignore_ascii_case(name);
    if let Some(field) = vectors.clone().find(|f| long(f)) {
        return Some(field.clone());
    }
    let same = |f: &&Field| f.name == name;
    let alike = |f: &&Field| f.name.eq_ignore_ascii_case(name);
    let mut all = fields.iter();
    let found = all.clone().find(same).or_else(|| all.find(alike));
    found.cloned()
}

/// The range of values; `None` if none is a number.
pub fn range(values: impl Iterator<Item = f64>) -> Option<[f64; 2]> {
    let mut range = [f64::INFINITY, f64::NEG_INFINITY];
    for v in values.filter(|v| v.is_finite()) {
        range = [range[0].min(v), range[1].max(v)];
    }
    (range[0] <= range[1]).then_some(range)
}

/// What colours of a field should span, and whether zero is in the middle.
pub fn span_of(field: Option<&Field>, range: [f64; 2]) -> ([f64; 2], bool) {
    let ([low, high], signed) = span(range);
    match field.is_some_and(Field::carried) && !signed {
        true => ([low.min(0.0), high.max(0.0)], false),
        false => ([low, high], signed),
    }
}

/// The range that colours should span: zero in the middle where there are values on both sides of it.
pub fn span([low, high]: [f64; 2]) -> ([f64; 2], bool) {
    let wide = low.abs().max(high.abs());
    if low < -0.05 * wide && high > 0.05 * wide {
        return ([-wide, wide], true);
    }
    ([low, high], false)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn array(components: usize, values: &[f64]) -> PointArray {
        PointArray {
            components,
            values: values.to_vec(),
        }
    }

    #[test]
    fn arrays_become_numbers_with_names() {
        let arrays = BTreeMap::from([
            ("NODE_ID".to_string(), array(1, &[1.])),
            ("U".to_string(), array(3, &[3., 0., 4.])),
            ("S".to_string(), array(6, &[1., 2., 3., 4., 5., 6.])),
            ("CPRESS".to_string(), array(1, &[7.])),
            ("XYZ".to_string(), array(1, &[8.])),
        ]);
        let all = fields(&arrays);
        let names: Vec<&str> = all.iter().map(|f| f.name.as_str()).collect();
        assert_eq!(
            names,
            [
                "CPRESS", "U", "U1", "U2", "U3", "S11", "S22", "S33", "S12", "S23", "S13", "XYZ"
            ]
        );
        let values: Vec<f64> = all.iter().map(|f| f.value(&arrays[&f.array], 0)).collect();
        assert_eq!(values, [7., 5., 3., 0., 4., 1., 2., 3., 4., 5., 6., 8.]);
        assert_eq!(all[0].label(), "CPRESS, contact pressure");
        assert_eq!(all[1].label(), "U, displacement (magnitude)");
        assert_eq!(all[2].label(), "U1, displacement");
        assert_eq!(all[11].label(), "XYZ");
        assert!(
            all[0].of_contact()
                && all[0].carried()
                && !all[1].of_contact()
                && !all[11].of_contact()
        );
        // What is odd under a mirror along x: U1, S12 and S13.
        let odd: Vec<&str> = all
            .iter()
            .filter(|f| f.turns(0))
            .map(|f| f.name.as_str())
            .collect();
        assert_eq!(odd, ["U1", "S12", "S13"]);
        assert_eq!(
            [0, 1].map(|i| all[i].interest()),
            [Interest::Pressure, Interest::Largest]
        );
        assert_eq!(span_of(Some(&all[0]), [2., 3.]), ([0., 3.], false));
        assert_eq!(span_of(Some(&all[1]), [2., 3.]), ([2., 3.], false));
    }

    #[test]
    fn stress_has_invariants_and_magnitudes_have_two_names() {
        // Shear of 3 about the third axis, and 2 along it, turned: principal stresses 3, 2, -3.
        let arrays = BTreeMap::from([
            ("U".to_string(), array(3, &[3., 0., 4.])),
            ("S".to_string(), array(6, &[0., 0., 2., 3., 0., 0.])),
        ]);
        let all = with_invariants(&arrays);
        let value = |name: &str| {
            let field = named(&all, name).unwrap();
            let value = field.value(&arrays[&field.array], 0);
            (value * 1e9).round() / 1e9
        };
        let values = ["S1", "S2", "S3", "TRESCA", "PRESS", "s12", "UMAG", "U"].map(value);
        assert_eq!(
            values,
            [3., 2., -3., 6., -2. / 3., 3., 5., 5.].map(|v: f64| (v * 1e9).round() / 1e9)
        );
        let s1 = named(&all, "S1").unwrap();
        assert_eq!(s1.label(), "S1, largest principal stress");
        assert!((0..3).all(|axis| !s1.turns(axis)) && !s1.of_contact());
        assert_eq!(s1.stem(), "S");
        assert!(named(&all, "S").is_none() && named(&all, "SMAG").is_none());
    }

    #[test]
    fn colours_are_centred_where_signs_differ() {
        assert_eq!(span([0., 2.]), ([0., 2.], false));
        assert_eq!(span([-1., 2.]), ([-2., 2.], true));
        assert_eq!(span([-0.01, 2.]), ([-0.01, 2.], false));
        assert_eq!(
            range([f64::NAN, 1., -2., f64::INFINITY].into_iter()),
            Some([-2., 1.])
        );
        assert_eq!(range([f64::NAN].into_iter()), None);
    }
}
