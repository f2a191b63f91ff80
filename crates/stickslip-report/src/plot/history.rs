//! Columns of the history, or of another table, as lines.

use stickslip::Error;
use stickslip::io::csv::Table;
use stickslip::results::compare::near;

use super::chart::Chart;
use crate::draw::Canvas;
use crate::results::{Results, fault};

/// Draws columns against another.
///
/// # Errors
/// [`Error::Io`] if there is no history or no such column.
pub fn draw(
    results: &Results,
    (table, file): (&Table, &str),
    names: &[String],
    against: &str,
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
    let x = find(against)?;
    let lines: Vec<(&str, &[f64])> = names
        .iter()
        .map(|name| Ok((name.as_str(), find(name)?)))
        .collect::<Result<_, Error>>()?;
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
        along: against,
        from: low,
        to: high,
        lines,
        statuses: &[],
    };
    chart.draw(size, canvas).ok_or_else(nothing)
}
