//! One field along a surface at several times, a line each: how a scar grows.

use stickslip::Error;
use stickslip::io::csv::Table;

use super::super::axis;
use super::super::picture::Zoom;
use super::arc::Arc;
use crate::results::{Results, fault};
use crate::sheet::Sheet;

/// Part of the largest value from which on a place is part of what is seen, and how much of the width lies to each side of that.
const SEEN: f64 = 1e-3;
const MARGIN: f64 = 0.1;

/// The table: length along the surface, and a column a time.
///
/// # Errors
/// [`Error::Io`] where the interface is no line, has no such field, or nothing is to be seen.
pub fn table(
    results: &Results,
    (interface, field, zoom): (&str, &str, Zoom),
    frames: &[usize],
) -> Result<Table, Error> {
    let wrong = |message: String| fault(&results.directory, message);
    let mut table = Table::default();
    for &frame in frames {
        let sheets = results.sheets(frame)?;
        let Some(sheet) = sheets.iter().find(|s| s.name == interface) else {
            continue;
        };
        if !sheet.flat() {
            return Err(wrong(format!(
                "interface {interface} is a surface in space: lines of a field are for plane problems; leave --field out for maps"
            )));
        }
        let arc = Arc::of(sheet);
        let values = values(sheet, &arc, field).ok_or_else(|| {
            wrong(format!(
                "interface {interface} has no field `{field}` with one component; there are {}",
                single(sheet).collect::<Vec<_>>().join(", ")
            ))
        })?;
        if table.names.is_empty() {
            table.names.push("S".into());
            table.columns.push(arc.s);
        }
        let time = axis::number(results.frames[frame].time, 5);
        table.names.push(format!("{field} at {time}"));
        table.columns.push(values);
    }
    let seen = match zoom {
        Zoom::Whole => None,
        _ => part(&table),
    };
    if let Some([from, to]) = seen {
        let inside: Vec<bool> = table.columns[0]
            .iter()
            .map(|s| (from..=to).contains(s))
            .collect();
        for column in &mut table.columns {
            let mut kept = inside.iter();
            column.retain(|_| kept.next() == Some(&true));
        }
    }
    match table.columns.len() > 1 {
        true => Ok(table),
        false => Err(wrong(format!(
            "interface {interface} has no surface at these times"
        ))),
    }
}

fn single(sheet: &Sheet) -> impl Iterator<Item = &str> {
    let arrays = sheet.grid.points.arrays.iter();
    arrays
        .filter(|(_, a)| a.components == 1)
        .map(|(name, _)| name.as_str())
}

fn values(sheet: &Sheet, arc: &Arc, field: &str) -> Option<Vec<f64>> {
    let mut arrays = sheet.grid.points.arrays.iter();
    let (_, array) = arrays.find(|(name, a)| *name == field && a.components == 1)?;
    Some(arc.points.iter().map(|&i| array.values[i]).collect())
}

/// Between which lengths the lines are not zero.
fn part(table: &Table) -> Option<[f64; 2]> {
    let (lengths, lines) = table.columns.split_first()?;
    let largest = lines.iter().flatten().fold(0.0, |m: f64, v| m.max(v.abs()));
    let is_seen = |i: usize| lines.iter().any(|line| line[i].abs() > SEEN * largest);
    let first = (0..lengths.len()).find(|&i| is_seen(i))?;
    let last = (0..lengths.len()).rfind(|&i| is_seen(i))?;
    let (from, to) = (lengths[first], lengths[last]);
    let margin = MARGIN * (to - from);
    (margin > 0.0).then_some([from - margin, to + margin])
}
