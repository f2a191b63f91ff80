//! Ticks of axes at round numbers, and numbers as text.

use stickslip::number;

/// At most about `count` round numbers between `low` and `high`.
pub fn ticks(low: f64, high: f64, count: usize) -> Vec<f64> {
    let width = high - low;
    if !(width > 0.0 && width.is_finite()) {
        return vec![low];
    }
    let rough = width / count.max(1) as f64;
    let power = 10f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0]
        .into_iter()
        .map(|lead| lead * power)
        .find(|step| *step >= rough * 0.999_999)
        .unwrap_or(10.0 * power);
    let first = (low / step - 1e-9).ceil() as i64;
    let last = (high / step + 1e-9).floor() as i64;
    // Multiples, not sums: no rounding adds up.
    (first..=last).map(|k| k as f64 * step).collect()
}

/// A number in at most `digits` digits, with an exponent that is a multiple of three where it needs one, and a true minus sign.
pub fn number(value: f64, digits: usize) -> String {
    if !value.is_finite() {
        return "–".into();
    }
    let size = value.abs();
    let text = if value == 0.0 {
        "0".into()
    } else if (1.0..1e5).contains(&size) && !fits(value, digits) {
        // Digits that do not count are zeros: 1860 is read more easily than 1.86e3.
        let unit = 10f64.powi(size.log10().floor() as i32 + 1 - digits as i32);
        format!("{}", (value / unit).round() * unit)
    } else if (1e-4..1e6).contains(&size) && fits(value, digits) {
        let after = (digits as i32 - 1 - size.log10().floor() as i32).clamp(0, 12) as usize;
        trimmed(&format!("{value:.after$}"))
    } else {
        number::digits(value, digits)
    };
    text.replace('-', "−")
}

/// The labels of ticks: all with the exponent of the largest where one of them needs an exponent.
pub fn labels(ticks: &[f64], digits: usize) -> Vec<String> {
    let alone: Vec<String> = ticks.iter().map(|t| number(*t, digits)).collect();
    let largest = ticks.iter().fold(0.0, |m: f64, t| m.max(t.abs()));
    if largest == 0.0 || !alone.iter().any(|text| text.contains('e')) {
        return alone;
    }
    let exponent = 3 * (largest.log10() / 3.0 + 1e-9).floor() as i32;
    let label = |t: &f64| match (*t == 0.0, exponent) {
        (true, _) => "0".to_string(),
        (_, 0) => trimmed(&format!("{t:.digits$}")).replace('-', "−"),
        _ => {
            let value = trimmed(&format!("{:.digits$}", t / 10f64.powi(exponent)));
            format!("{value}e{exponent}").replace('-', "−")
        }
    };
    ticks.iter().map(label).collect()
}

/// The least and the largest value in words.
pub fn between(values: [f64; 2]) -> String {
    values.map(|x| number(x, 3)).join(" … ")
}

/// Whether a number has no digits left of the point beyond those that count.
fn fits(value: f64, digits: usize) -> bool {
    let rounded = format!("{value:.*e}", digits - 1);
    value.abs() < 10f64.powi(digits as i32) || rounded.parse() == Ok(value)
}

fn trimmed(text: &str) -> String {
    match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').into(),
        false => text.into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_within() {
        assert_eq!(
            ticks(0.0, 1.0, 5),
            [0.0, 0.2, 0.4, 0.6000000000000001, 0.8, 1.0]
        );
        assert_eq!(ticks(-3.0, 7.0, 4), [0.0, 5.0]);
        assert_eq!(ticks(2.0, 2.0, 4), [2.0]);
        for (low, high) in [(1e-9, 3e-9), (-5e12, 1e13), (0.1, 0.1001)] {
            let ticks = ticks(low, high, 6);
            assert!((3..=8).contains(&ticks.len()), "{ticks:?}");
        }
    }

    #[test]
    fn labels_of_an_axis_share_their_exponent() {
        let of = |ticks: &[f64]| labels(ticks, 5).join(" ");
        assert_eq!(of(&[0.0, 5e-5, 1e-4, 1.5e-4]), "0 50e−6 100e−6 150e−6");
        assert_eq!(of(&[-5e-5, 0.0, 2.5e-3]), "−0.05e−3 0 2.5e−3");
        assert_eq!(of(&[0.0, 5e5, 1e6]), "0 0.5e6 1e6");
        assert_eq!(of(&[0.0, 0.5, 1.0]), "0 0.5 1");
        assert_eq!(of(&[0.0, 5e-5, 2.0]), "0 0.00005 2");
        assert_eq!(of(&[0.0]), "0");
    }

    #[test]
    fn numbers_are_short() {
        for (value, text) in [
            (0.6000000000000001, "0.6"),
            (-1.25e-5, "−12.5e−6"),
            (1e9, "1e9"),
            (8.4e9, "8.4e9"),
            (123_456.0, "123.5e3"),
            (999_960.0, "1e6"),
            (1.5e-12, "1.5e−12"),
            (601.2422, "601.2"),
            (5e-4, "0.0005"),
            (250_000.0, "250000"),
            (9_876.0, "9876"),
            (0.012_346, "0.01235"),
        ] {
            assert_eq!(number(value, 4), text);
        }
        assert_eq!([number(1859.1, 3), number(99_960.0, 3)], ["1860", "100000"]);
    }
}
