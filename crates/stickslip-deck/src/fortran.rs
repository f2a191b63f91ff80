//! Numbers as CalculiX writes them.

/// A number as in CalculiX's files, `1p,e13.6`.
fn e(x: f64) -> String {
    fortran(x, 6, 13)
}

/// A number with so many digits behind the point, right-aligned.
fn fortran(x: f64, digits: usize, width: usize) -> String {
    let text = format!("{:.*e}", digits, x + 0.0);
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    let sign = if exponent < 0 { '-' } else { '+' };
    format!(
        "{:>width$}",
        format!("{mantissa}E{sign}{:02}", exponent.abs())
    )
}

/// A time as CalculiX writes it, `0.1000000E+01`.
pub(crate) fn time(t: f64) -> String {
    if t == 0.0 {
        return " 0.0000000E+00".into();
    }
    let mut exponent = t.abs().log10().floor() as i32 + 1;
    let mut mantissa = t / 10f64.powi(exponent);
    if format!("{mantissa:.7}").starts_with('1') {
        exponent += 1;
        mantissa /= 10.0;
    }
    let sign = if exponent < 0 { '-' } else { '+' };
    format!("{mantissa:>10.7}E{sign}{:02}", exponent.abs())
}

/// A line of numbers behind its head.
pub(crate) fn row(out: &mut String, head: &str, values: &[f64]) {
    out.push_str(head);
    for v in values {
        out.push(' ');
        out.push_str(&e(*v));
    }
    out.push('\n');
}
