//! Numbers as engineers write them, for everything that people read; files have all digits.

use std::borrow::Borrow;

/// A number with four digits, see [`digits`].
pub fn figure(x: impl Borrow<f64>) -> String {
    digits(x, 4)
}

/// A number with so many digits that count: 0.001 and more up to one place more than there are digits as it is, all others with an exponent
/// that is a multiple of three. Zeros at the end of decimals are left out.
pub fn digits(x: impl Borrow<f64>, count: usize) -> String {
    let x = *x.borrow();
    if x == 0.0 {
        return "0".into();
    }
    if !x.is_finite() {
        return x.to_string();
    }
    let last = count.saturating_sub(1);
    // Rounded first: 9.9999 has two places before the point with four digits.
    let text = format!("{x:.last$e}");
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let power: i32 = exponent.parse().unwrap_or(0);
    let shift = match (-3..=count as i32).contains(&power) {
        true => 0,
        false => 3 * power.div_euclid(3),
    };
    let value = match (shift, mantissa.parse::<f64>()) {
        (0, _) | (_, Err(_)) => x,
        (_, Ok(mantissa)) => mantissa * 10f64.powi(power - shift),
    };
    let places = (last as i32 - (power - shift)).max(0) as usize;
    let shown = format!("{value:.places$}");
    let trimmed = match shown.contains('.') {
        true => shown.trim_end_matches('0').trim_end_matches('.'),
        false => &shown,
    };
    match shift == 0 {
        true => trimmed.to_string(),
        false => format!("{trimmed}e{shift}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_the_digits_that_count_and_engineering_exponents() {
        for (x, text) in [
            (0.0, "0"),
            (-0.0, "0"),
            (1.0, "1"),
            (0.5, "0.5"),
            (-0.12345, "-0.1235"),
            (0.001234, "0.001234"),
            (0.0001234, "123.4e-6"),
            (601.2422, "601.2"),
            (9999.6, "10000"),
            (12345.6, "12346"),
            (123_456.0, "123.5e3"),
            (999_960.0, "1e6"),
            (2.1e11, "210e9"),
            (-8.4321e9, "-8.432e9"),
            (1.9594e-15, "1.959e-15"),
            (5e-324, "4.941e-324"),
            (f64::MAX, "179.8e306"),
            (f64::INFINITY, "inf"),
        ] {
            assert_eq!(figure(x), text);
        }
        assert_eq!(digits(1.0 / 3.0, 6), "0.333333");
    }

    #[test]
    fn what_is_printed_reads_back_as_the_rounded_number() {
        let mut x = 1.234_567e-300;
        while x < 1e300 {
            let read: f64 = figure(x).parse().expect("a number");
            assert!((read - x).abs() <= 5.1e-4 * x, "{x} {read}");
            x *= 7.3;
        }
    }
}
