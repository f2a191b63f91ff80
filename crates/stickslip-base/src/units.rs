//! Numbers with units, as people type them: `10mm`, `1kN/mm`, `2.9e-8/MPa`.

/// Exponents of metre, kilogram and second.
pub type Dimension = [i32; 3];

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

/// A number, and the text of the unit behind it; `None` where a text does not begin with a number.
pub fn split(text: &str) -> Option<(f64, &str)> {
    let text = text.trim();
    let mut ends = text.char_indices().map(|(i, c)| i + c.len_utf8());
    let end = ends.rfind(|&end| text[..end].parse::<f64>().is_ok())?;
    Some((text[..end].parse().ok()?, text[end..].trim()))
}

/// Units with digits as exponents, multiplied by `.`, `*` or spaces; each `/` divides by the one behind it: the value in metres, kilograms and
/// seconds, and the dimension.
///
/// # Errors
/// The unit that is not known.
pub fn in_base_units(text: &str) -> Result<(f64, Dimension), String> {
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

    #[test]
    fn units_are_products_of_powers() {
        for (text, value, dimension) in [
            ("mm", 1e-3, [1, 0, 0]),
            ("kN/mm", 1e6, [0, 1, -2]),
            ("N/mm^2", 1e6, [-1, 1, -2]),
            ("m/min", 1.0 / 60.0, [1, 0, -1]),
            ("1/MPa", 1e-6, [1, -1, 2]),
        ] {
            let (found, of) = in_base_units(text.trim_start_matches('1')).expect(text);
            assert!(
                (found / value - 1.0).abs() < 1e-12 && of == dimension,
                "{text}"
            );
        }
        assert!(in_base_units("furlong").is_err_and(|e| e.contains("`furlong`")));
        assert_eq!(split("210 GPa"), Some((210.0, "GPa")));
        assert_eq!(split(" -1e3mm"), Some((-1e3, "mm")));
        assert_eq!(split("mm"), None);
    }
}
