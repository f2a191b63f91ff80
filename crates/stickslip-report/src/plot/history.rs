//! Columns of the history, or of another table, as lines.

use std::path::Path;

use stickslip::Error;
use stickslip::io::csv::Table;
use stickslip::results::compare::near;

use super::chart::Chart;
use super::regimes::column;
use crate::draw::Canvas;
use crate::results::{Results, fault};

/// Which columns are drawn.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Columns {
    /// Those along the axis at the left.
    pub left: Vec<String>,
    /// Those along an axis of their own at the right.
    pub right: Vec<String>,
    /// That along the horizontal axis.
    pub against: String,
    /// What is written along it; the name of the column if empty.
    pub label: String,
}

/// Draws columns against another.
///
/// # Errors
/// [`Error::Io`] if there is no history or no such column.
pub fn draw<'c>(
    results: &Results,
    table: &'c Table,
    file: &str,
    columns: &'c Columns,
    size: [u32; 2],
    canvas: &mut dyn Canvas,
) -> Result<(), Error> {
    if table.rows() == 0 {
        let message = format!("{file} has no rows: there is nothing to plot");
        return Err(fault(&results.directory, message));
    }
    let find = |name: &str| {
        table.column(name).ok_or_else(|| {
            fault(
                &results.directory,
                format!(
                    "{file} has no column `{name}`{}",
                    near(name, table.names.iter().map(String::as_str))
                ),
            )
        })
    };
    let against = columns.against.as_str();
    let x = find(against)?;
    let lines = |names: &'c [String]| -> Result<Vec<(&'c str, &'c [f64])>, Error> {
        let names = names.iter();
        let each = names.map(|name| Ok((name.as_str(), find(name)?)));
        each.collect()
    };
    let nothing = || fault(&results.directory, "the columns hold no numbers");
    let [low, high] = crate::field::range(x.iter().copied()).ok_or_else(nothing)?;
    // A time that begins just after zero begins at zero.
    let low = if low > 0.0 && low < 0.02 * high {
        0.0
    } else {
        low
    };
    let chart = Chart {
        title: &results.title(),
        words: "",
        x,
        along: match columns.label.as_str() {
            "" => against,
            label => label,
        },
        from: low,
        to: high,
        lines: lines(&columns.left)?,
        right: lines(&columns.right)?,
        statuses: &[],
    };
    chart.draw(size, canvas).ok_or_else(nothing)
}

/// The columns of modes in the table of a map, `frequency.3`, or of a sweep, `MODES.3.FREQUENCY`.
fn of_modes<'t>(table: &'t Table, what: &str) -> Vec<(&'t str, &'t [f64])> {
    let number = |name: &str| {
        let of_map = name.strip_prefix(what).and_then(|n| n.strip_prefix('.'));
        let of_sweep = (name.strip_prefix("MODES."))
            .and_then(|n| n.strip_suffix(&format!(".{}", what.to_uppercase())));
        of_map
            .or(of_sweep)
            .is_some_and(|n| n.parse::<usize>().is_ok())
    };
    let names = table.names.iter().filter(|n| number(n));
    let all = names.filter_map(|n| Some((n.as_str(), table.column(n)?)));
    all.filter(|(_, y)| y.iter().any(|v| v.is_finite()))
        .collect()
}

/// Draws frequencies or growth of all modes against a column.
///
/// # Errors
/// [`Error::Io`] if there is no such column, or none of modes.
pub fn modes(
    file: &Path,
    table: &Table,
    what: &str,
    against: &str,
    size: [u32; 2],
    canvas: &mut dyn Canvas,
) -> Result<(), Error> {
    let (along, x) = column(file, table, against)?;
    let lines = of_modes(table, what);
    let nothing = || {
        fault(
            file,
            "there are no columns of modes: a map has `frequency.1`, a sweep of runs with `modes` or `complex-modes` has `MODES.1.FREQUENCY`",
        )
    };
    // Runs come in the order of the axes of the sweep; lines go along this one.
    let mut order: Vec<usize> = (0..x.len()).filter(|&i| x[i].is_finite()).collect();
    order.sort_by(|&a, &b| x[a].total_cmp(&x[b]));
    let sorted = |y: &[f64]| -> Vec<f64> { order.iter().map(|&i| y[i]).collect() };
    let (x, values): (Vec<f64>, Vec<Vec<f64>>) =
        (sorted(x), lines.iter().map(|(_, y)| sorted(y)).collect());
    let (Some(&from), Some(&to)) = (x.first(), x.last()) else {
        return Err(nothing());
    };
    let names = lines.iter().map(|(name, _)| *name);
    let stem = file.file_stem().unwrap_or_default().to_string_lossy();
    let chart = Chart {
        title: &format!("{stem}: {what} of the modes"),
        words: "",
        x: &x,
        along,
        from,
        to,
        lines: names.zip(values.iter().map(Vec::as_slice)).collect(),
        right: Vec::new(),
        statuses: &[],
    };
    chart.draw(size, canvas).ok_or_else(nothing)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_of_modes_are_found_in_maps_and_sweeps() {
        let names = [
            "mu",
            "frequency.1",
            "frequency.12",
            "growth.1",
            "MODES.GROWTH",
            "MODES.2.FREQUENCY",
            "MODES.3.GROWTH",
            "largest-growth",
        ];
        let table = Table {
            names: names.map(String::from).to_vec(),
            columns: vec![vec![1.0, 2.0]; 8],
        };
        let found = |what| {
            of_modes(&table, what)
                .iter()
                .map(|l| l.0)
                .collect::<Vec<_>>()
        };
        assert_eq!(
            found("frequency"),
            ["frequency.1", "frequency.12", "MODES.2.FREQUENCY"]
        );
        assert_eq!(found("growth"), ["growth.1", "MODES.3.GROWTH"]);
    }
}
