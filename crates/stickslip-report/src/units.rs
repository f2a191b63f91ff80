//! Units as a legend says them: names for lengths and for stresses, where the problem or the user gives them.

use std::str::FromStr;

use crate::field::Field;
use crate::results::Results;

/// Names of units; empty where they are not given.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Units {
    /// Of lengths.
    pub length: String,
    /// Of pressures and stresses.
    pub stress: String,
}

impl FromStr for Units {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let plain = |name: &str| !name.is_empty() && name.chars().count() <= 12;
        match text.split_once(',').map(|(l, s)| (l.trim(), s.trim())) {
            Some((length, stress)) if plain(length) && plain(stress) => Ok(Units {
                length: length.into(),
                stress: stress.into(),
            }),
            _ => Err(
                "the units of length and of stress with a comma between them, as `mm,MPa`".into(),
            ),
        }
    }
}

impl Units {
    /// Those that the problem gives: a law that is in metres and pascals settles them.
    pub fn of(results: &Results) -> Units {
        let interfaces = results
            .problem
            .get("interface")
            .and_then(toml::Value::as_table);
        let metres = |table: &toml::Value| {
            let normal = table.get("normal");
            normal.is_some_and(|normal| normal.get("micro-contact").is_some())
        };
        match interfaces.is_some_and(|all| all.values().any(metres)) {
            true => Units {
                length: "m".into(),
                stress: "Pa".into(),
            },
            false => Units::default(),
        }
    }

    /// The unit of a field; empty if it is not known.
    pub fn of_field(&self, field: &Field) -> &str {
        match field.stem() {
            "CPRESS" | "CSHEAR" | "TNORMAL" | "TSHEAR" | "MISES" | "S" => &self.stress,
            "U" | "COPEN" | "CSLIP" | "CWEAR" => &self.length,
            _ => "",
        }
    }
}

/// What stands behind a name: ` [mm]`, or nothing.
pub fn behind(unit: &str) -> String {
    match unit {
        "" => String::new(),
        unit => format!(" [{unit}]"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::field::Part;

    #[test]
    fn units_are_those_that_are_said() {
        let units: Units = "mm, MPa".parse().unwrap();
        let field = |name: &str| Field {
            name: name.into(),
            array: name.into(),
            part: Part::Component(0),
        };
        assert_eq!(units.of_field(&field("CPRESS")), "MPa");
        assert_eq!(units.of_field(&field("CSLIP1")), "mm");
        assert_eq!(units.of_field(&field("CSTATUS")), "");
        assert_eq!(behind(Units::default().of_field(&field("CPRESS"))), "");
        for wrong in ["mm", "mm,", ",MPa", ""] {
            assert!(
                wrong.parse::<Units>().unwrap_err().contains("mm,MPa"),
                "{wrong}"
            );
        }
    }
}
