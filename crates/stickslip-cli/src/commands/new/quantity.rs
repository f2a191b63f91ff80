//! Numbers with units, as people type them: `10mm`, `1kN/mm`, `2.9e-8/MPa`.

use stickslip::units::{Dimension, in_base_units, split};

/// What a quantity is: its name, its dimension, and units in which people give it.
pub type Kind = (&'static str, Dimension, &'static str);

/// A length above zero `[m]`.
pub const LENGTH: Kind = ("a length", [1, 0, 0], "10mm, 25um");
/// A force above zero `[N]`.
pub const FORCE: Kind = ("a force", [1, 1, -2], "100N, 20kN");
/// A torque above zero `[Nm]`.
pub const TORQUE: Kind = ("a torque", [2, 1, -2], "20Nm, 300N.mm");
/// A force per length above zero, or a stiffness `[N/m]`.
pub const LINE_LOAD: Kind = ("a force per length", [0, 1, -2], "100N/mm, 1kN/m");
/// A stress or a modulus above zero `[Pa]`.
pub const STRESS: Kind = ("a stress", [-1, 1, -2], "210GPa, 250MPa");
/// Worn volume over load and path, above zero `[1/Pa]`.
pub const WEAR: Kind = ("a wear rate", [1, -1, 2], "2.9e-8/MPa, 2.9e-5mm3/Nm");
/// A mass above zero `[kg]`.
pub const MASS: Kind = ("a mass", [0, 1, 0], "1kg, 50g");
/// A velocity above zero `[m/s]`.
pub const SPEED: Kind = ("a velocity", [1, 0, -1], "0.1m/s, 30mm/s");

/// What reads a quantity of a kind.
pub fn of(kind: Kind) -> impl Fn(&str) -> Result<f64, String> + Clone + Send + Sync {
    move |text| read(text, kind)
}

/// A force, or a force per length; told apart by their units.
pub fn load(text: &str) -> Result<Load, String> {
    match read(text, FORCE) {
        Ok(force) => Ok(Load::Force(force)),
        Err(said) => read(text, LINE_LOAD).map(Load::PerLength).map_err(|_| {
            said.replace(
                "a force, such as",
                "a force or a force per length, such as 100N/mm,",
            )
        }),
    }
}

/// What presses bodies together.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Load {
    /// `[N]`
    Force(f64),
    /// `[N/m]`
    PerLength(f64),
}

/// Poisson's ratio of a material that is neither auxetic nor incompressible.
pub fn poisson(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(nu) if (0.0..0.5).contains(&nu) => Ok(nu),
        _ => Err("Poisson's ratio is a number from 0 to below 0.5; steel has 0.3".into()),
    }
}

/// A coefficient of friction.
pub fn friction(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(mu) if mu > 0.0 && mu <= 2.0 => Ok(mu),
        _ => Err("a coefficient of friction is a number above 0 and up to 2".into()),
    }
}

fn read(text: &str, (name, wanted, such): Kind) -> Result<f64, String> {
    let Some((value, unit)) = split(text) else {
        return Err(format!(
            "this does not begin with a number; give {name}, such as {such}"
        ));
    };
    if unit.is_empty() {
        return Err(format!("the unit is missing; give {name}, such as {such}"));
    }
    let (factor, dimension) = in_base_units(unit)?;
    if dimension != wanted {
        return Err(format!(
            "`{unit}` is not the unit of {name}, such as {such}"
        ));
    }
    match value > 0.0 && value.is_finite() {
        true => Ok(value * factor),
        false => Err(format!("{value} is not above zero")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(found: Result<f64, String>, wanted: f64) {
        let found = found.expect("a quantity");
        assert!((found / wanted - 1.0).abs() < 1e-12, "{found} {wanted}");
    }

    #[test]
    fn units_are_those_that_are_typed() {
        near(of(LENGTH)("10mm"), 0.01);
        near(of(LENGTH)(" 2.5e1 µm"), 25e-6);
        near(of(LINE_LOAD)("1kN/mm"), 1e6);
        near(of(TORQUE)("300 N.mm"), 0.3);
        near(of(STRESS)("210GPa"), 210e9);
        near(of(STRESS)("1 N/mm2"), 1e6);
        near(of(WEAR)("2.9e-8/MPa"), 2.9e-14);
        near(of(WEAR)("2.9e-5 mm^3/Nm"), 2.9e-14);
        near(of(WEAR)("1 mm3/N/m"), 1e-9);
        near(of(SPEED)("36 m/min"), 0.6);
        assert_eq!(load("3N/mm"), Ok(Load::PerLength(3e3)));
        assert_eq!(load("3kN"), Ok(Load::Force(3e3)));
    }

    #[test]
    fn what_is_no_quantity_is_told_what_is() {
        for (text, part) in [
            ("10", "the unit is missing"),
            ("-10mm", "-10 is not above zero"),
            ("mm", "does not begin with a number"),
            ("10furlong", "`furlong` is no unit"),
            ("10MPa", "`MPa` is not the unit of a length"),
            ("nan mm", "not above zero"),
        ] {
            let said = of(LENGTH)(text).expect_err(text);
            assert!(said.contains(part), "{text}: {said}");
        }
        assert!(load("3mm").is_err_and(|e| e.contains("a force per length")));
        assert!(poisson("0.5").is_err() && friction("0").is_err());
    }
}
