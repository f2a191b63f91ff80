//! Numbers in columns.

/// Characters of a value.
pub(super) const VALUE_WIDTH: usize = 12;

/// Adds a value in twelve columns, ` 1.23450E-01`; beyond `1e100` it has fewer digits.
pub(super) fn push_value(out: &mut Vec<u8>, x: f64) {
    let text = match x {
        _ if x.is_nan() => "NaN".to_string(),
        _ if x.is_infinite() => if x > 0.0 { "Inf" } else { "-Inf" }.to_string(),
        // What is smaller has an exponent that takes one column more than there is.
        _ if x.abs() < 1e-99 => scientific(0.0, 5),
        _ => (0..=5)
            .rev()
            .map(|digits| scientific(x, digits))
            .find(|text| text.len() <= VALUE_WIDTH)
            .unwrap_or_default(),
    };
    out.extend(std::iter::repeat_n(b' ', VALUE_WIDTH - text.len()));
    out.extend(text.bytes());
}

/// A number with so many digits behind the point and an exponent of two digits or more.
fn scientific(x: f64, digits: usize) -> String {
    let text = format!("{x:.digits$e}");
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let (sign, size) = match exponent.strip_prefix('-') {
        Some(size) => ('-', size),
        None => ('+', exponent),
    };
    format!("{mantissa}E{sign}{size:0>2}")
}

/// A time in twelve columns of which the first is blank: what of these two ways to write it is nearer, ` 5.00000E-01` or ` 1.234567890`.
pub(super) fn time(t: f64) -> String {
    let plain = (0..=9)
        .rev()
        .map(|digits| format!("{t:.digits$}"))
        .find(|text| text.len() < VALUE_WIDTH);
    let short = scientific(t, 5);
    let error = |text: &str| (text.parse::<f64>().unwrap_or(f64::INFINITY) - t).abs();
    let text = match plain {
        Some(plain) if error(&plain) < error(&short) => plain,
        _ => short,
    };
    format!("{text:>VALUE_WIDTH$}")
}

/// A whole number in no more columns than it has: what is beyond is cut to the largest that fits, as a number that is too long would move all that follows.
pub(super) fn whole(n: usize, width: usize) -> String {
    let largest = 10usize.saturating_pow(width as u32) - 1;
    format!("{:>width$}", n.min(largest))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_have_twelve_columns() {
        for (x, text) in [
            (0.0, " 0.00000E+00"),
            (-0.0, " 0.00000E+00"),
            (0.5, " 5.00000E-01"),
            (-1.0 / 3.0, "-3.33333E-01"),
            (-9.999_999e99, "-1.0000E+100"),
            (1e-120, " 0.00000E+00"),
            (-2.5e300, "-2.5000E+300"),
            (f64::NAN, "         NaN"),
            (f64::NEG_INFINITY, "        -Inf"),
        ] {
            let mut out = Vec::new();
            push_value(&mut out, x);
            assert_eq!(String::from_utf8(out).unwrap(), text);
        }
    }

    #[test]
    fn times_keep_the_digits_there_is_room_for() {
        for (t, text) in [
            (0.5, " 5.00000E-01"),
            (1.0, " 1.00000E+00"),
            (1.25e-9, " 1.25000E-09"),
            (0.123456789, " 0.123456789"),
            (1234.5678912, " 1234.567891"),
            (3.5e12, " 3.50000E+12"),
        ] {
            assert_eq!(time(t), text);
        }
        assert_eq!(whole(100_000, 5), "99999");
        assert_eq!(whole(7, 5), "    7");
    }
}
