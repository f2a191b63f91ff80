//! Numbers with units, as people type them: `10mm`, `1kN/mm`, `2.9e-8/MPa`.

/// Exponents of metre, kilogram and second.
type Dimension = [i32; 3];

/// Units by name: what one is in metres, kilograms and seconds.
const UNITS: [(&str, f64, Dimension); 29] = [
    ("m", 1.0, [1, 0, 0]),
    ("cm", 1e-2, [1, 0, 0]),
    ("mm", 1e-3, [1, 0, 0]),
    ("um", 1e-6, [1, 0, 0]),
    ("µm", 1e-6, [1, 0, 0]),
    ("nm", 1e-9, [1, 0, 0]),
    ("in", 0.0254, [1, 0, 0]),
    ("kg", 1.0, [0, 1, 0]),
    ("g", 1e-3, [0, 1, 0]),
    ("t", 1e3, [0, 1, 0]),
    ("s", 1.0, [0, 0, 1]),
    ("ms", 1e-3, [0, 0, 1]),
    ("min", 60.0, [0, 0, 1]),
    ("h", 3600.0, [0, 0, 1]),
    ("N", 1.0, [1, 1, -2]),
    ("mN", 1e-3, [1, 1, -2]),
    ("kN", 1e3, [1, 1, -2]),
    ("MN", 1e6, [1, 1, -2]),
    ("lbf", 4.448_221_615_260_5, [1, 1, -2]),
    ("Nm", 1.0, [2, 1, -2]),
    ("J", 1.0, [2, 1, -2]),
    ("Pa", 1.0, [-1, 1, -2]),
    ("kPa", 1e3, [-1, 1, -2]),
    ("MPa", 1e6, [-1, 1, -2]),
    ("GPa", 1e9, [-1, 1, -2]),
    ("bar", 1e5, [-1, 1, -2]),
    ("psi", 6_894.757_293_168, [-1, 1, -2]),
    ("ksi", 6_894_757.293_168, [-1, 1, -2]),
    ("Hz", 1.0, [0, 0, -1]),
];

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
    let text = text.trim();
    let split = number_ends(text);
    let Ok(value) = text[..split].parse::<f64>() else {
        return Err(format!(
            "this does not begin with a number; give {name}, such as {such}"
        ));
    };
    let unit = text[split..].trim();
    if unit.is_empty() {
        return Err(format!("the unit is missing; give {name}, such as {such}"));
    }
    let (factor, dimension) = expression(unit)?;
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

/// Where the number at the start of a text ends: the longest start that is one.
fn number_ends(text: &str) -> usize {
    let mut ends = text.char_indices().map(|(i, c)| i + c.len_utf8());
    ends.rfind(|&end| text[..end].parse::<f64>().is_ok())
        .unwrap_or(0)
}

/// Units with digits as exponents, multiplied by `.`, `*` or spaces; each `/` divides by the one behind it.
fn expression(text: &str) -> Result<(f64, Dimension), String> {
    let (mut factor, mut dimension) = (1.0, [0; 3]);
    let mut sign = 1;
    for part in text.split_inclusive(['/', '*', '.', '·', ' ']) {
        let name = part.trim_end_matches(['/', '*', '.', '·', ' ']);
        if !name.is_empty() {
            let stem = name.trim_end_matches(|c: char| c.is_ascii_digit());
            let stem_unit = stem.trim_end_matches('^');
            let power = sign * name[stem.len()..].parse::<i32>().unwrap_or(1);
            let Some((_, size, dims)) = UNITS.iter().find(|(unit, ..)| *unit == stem_unit) else {
                return Err(format!("`{name}` is no unit that is known here"));
            };
            factor *= f64::powi(*size, power);
            for (d, s) in dimension.iter_mut().zip(dims) {
                *d += power * s;
            }
        }
        sign = if part.ends_with('/') { -1 } else { 1 };
    }
    Ok((factor, dimension))
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
