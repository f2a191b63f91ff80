//! Numbers and curves out of tables and summaries. Failures are sentences for the report.

use std::collections::BTreeMap;

use serde_json::Value;

use crate::io::csv::Table;

use super::expected::Reduce;
use super::near::near;

/// A column by name.
pub(super) fn column<'t>(table: &'t Table, file: &str, name: &str) -> Result<&'t [f64], String> {
    table.column(name).ok_or_else(|| {
        let names = table.names.iter().map(String::as_str);
        format!("no column `{name}` in {file}{}", near(name, names))
    })
}

/// One number of a column. NaN anywhere in what is reduced gives NaN.
pub(super) fn reduce(values: &[f64], how: Reduce) -> Result<f64, String> {
    let fold = |better: fn(f64, f64) -> bool, values: &mut dyn Iterator<Item = f64>| {
        values.reduce(|a, b| if a.is_nan() || better(a, b) { a } else { b })
    };
    let result = match how {
        Reduce::Last => values.last().copied(),
        Reduce::Max => fold(|a, b| a >= b, &mut values.iter().copied()),
        Reduce::Min => fold(|a, b| a <= b, &mut values.iter().copied()),
        Reduce::MaxAbs => fold(|a, b| a >= b, &mut values.iter().map(|v| v.abs())),
    };
    result.ok_or_else(|| "there are no rows".to_string())
}

/// The value at a time of the history; of the last of several rows of that time.
pub(super) fn at_time(times: &[f64], values: &[f64], t: f64) -> Result<f64, String> {
    let span = times.iter().fold(0.0, |m: f64, t| m.max(t.abs()));
    let mut rows = times.iter().zip(values).rev();
    match rows.find(|(time, _)| (*time - t).abs() <= 1e-9 * span) {
        Some((_, &value)) => Ok(value),
        None => {
            let nearest = times
                .iter()
                .min_by(|a, b| (*a - t).abs().total_cmp(&(*b - t).abs()));
            Err(match nearest {
                Some(time) => format!("no row at time {t}; the nearest is at {time}"),
                None => "there are no rows".to_string(),
            })
        }
    }
}

/// A curve: points in order of the abscissa, linear in between.
pub(super) struct Line {
    points: Vec<[f64; 2]>,
    /// Differences of abscissae below this are rounding.
    tolerance: f64,
}

impl Line {
    /// From columns. Several values at one abscissa are refused unless they agree.
    pub fn new(x: &[f64], y: &[f64], along: &str) -> Result<Line, String> {
        let mut points: Vec<[f64; 2]> = x.iter().zip(y).map(|(&x, &y)| [x, y]).collect();
        if points.iter().any(|p| p[0].is_nan()) {
            return Err(format!("`{along}` has entries that are no numbers"));
        }
        points.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let (Some(first), Some(last)) = (points.first(), points.last()) else {
            return Err("there are no rows".to_string());
        };
        let tolerance = 1e-9 * (last[0] - first[0]).max(first[0].abs()).max(last[0].abs());
        for pair in points.windows(2) {
            let [a, b] = [pair[0], pair[1]];
            if b[0] - a[0] <= tolerance && a[1] != b[1] {
                return Err(format!(
                    "several rows have `{along}` = {}: choose some with `where`",
                    a[0]
                ));
            }
        }
        points.dedup_by(|b, a| b[0] - a[0] <= tolerance);
        Ok(Line { points, tolerance })
    }

    /// The value at `x`.
    pub fn at(&self, x: f64) -> Result<f64, String> {
        let i = self.points.partition_point(|p| p[0] < x - self.tolerance);
        match (i.checked_sub(1).map(|j| self.points[j]), self.points.get(i)) {
            (_, Some(&[b, y])) if b - x <= self.tolerance => Ok(y),
            (Some([a, ya]), Some(&[b, yb])) => Ok(ya + (yb - ya) * (x - a) / (b - a)),
            _ => {
                let (first, last) = (self.points[0][0], self.points[self.points.len() - 1][0]);
                Err(format!("{x} is outside the abscissae {first} to {last}"))
            }
        }
    }
}

/// The rows of a table that have the given values in the given columns.
pub(super) fn rows_where(
    table: &Table,
    file: &str,
    only: &BTreeMap<String, f64>,
) -> Result<Vec<usize>, String> {
    let mut rows: Vec<usize> = (0..table.rows()).collect();
    for (name, &wanted) in only {
        let values = column(table, file, name)?;
        let size = values.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
        rows.retain(|&row| (values[row] - wanted).abs() <= 1e-9 * size.max(wanted.abs()));
        if rows.is_empty() {
            return Err(format!("no row of {file} has `{name}` = {wanted}"));
        }
    }
    Ok(rows)
}

/// The number at a path. Keys may contain dots themselves: the longest key that fits is tried first.
pub(super) fn number(summary: &Value, path: &str) -> Result<f64, String> {
    match walk(summary, path) {
        Ok(Value::Number(n)) => n
            .as_f64()
            .ok_or_else(|| format!("`{path}` is too large a number")),
        Ok(Value::Null) => Ok(f64::NAN),
        Ok(_) => Err(format!("`{path}` in summary.json is not a number")),
        Err((here, rest)) => {
            let names: Vec<&str> = match here {
                Value::Object(map) => map.keys().map(String::as_str).collect(),
                _ => Vec::new(),
            };
            let key = rest.split('.').next().unwrap_or(rest);
            let near = near(key, names.into_iter());
            Err(format!("no `{key}` of `{path}` in summary.json{near}"))
        }
    }
}

/// The value at a path, or how far one gets and what remains.
fn walk<'v, 'p>(value: &'v Value, path: &'p str) -> Result<&'v Value, (&'v Value, &'p str)> {
    let mut deepest = (value, path);
    let ends = path.rmatch_indices('.').map(|(i, _)| i);
    for end in std::iter::once(path.len()).chain(ends) {
        let inner = match value {
            Value::Object(map) => map.get(&path[..end]),
            Value::Array(list) => path[..end].parse::<usize>().ok().and_then(|i| list.get(i)),
            _ => None,
        };
        let Some(inner) = inner else { continue };
        if end == path.len() {
            return Ok(inner);
        }
        match walk(inner, &path[end + 1..]) {
            Ok(found) => return Ok(found),
            Err(stop) if stop.1.len() < deepest.1.len() => deepest = stop,
            Err(_) => {}
        }
    }
    Err(deepest)
}
