//! One field along a surface at several times, a line each: how a scar grows.

use std::collections::HashMap;

use stickslip::Error;
use stickslip::io::csv::Table;

use super::super::axis;
use super::super::picture::Zoom;
use super::arc::Arc;
use crate::results::{Results, fault};
use crate::sheet::Sheet;

/// The table: length along the surface, and a column a time.
///
/// # Errors
/// [`Error::Io`] where the interface is no line, has no such field, or nothing is to be seen.
pub fn table(
    results: &Results,
    interface: &str,
    field: &str,
    zoom: Zoom,
    frames: &[usize],
) -> Result<Table, Error> {
    let wrong = |message: String| fault(&results.directory, message);
    let mut table = Table::default();
    let mut sheets = Vec::new();
    for &frame in frames {
        let time = results.frames[frame].time;
        let sheet = results.sheet(frame, interface)?;
        sheets.extend(sheet.map(|sheet| (time, sheet)));
    }
    // Places that a track is kept at come in as they are worn: the last time has all of them.
    let arc = match sheets.last() {
        Some((_, last)) if last.flat() => Arc::of(last),
        Some(_) => {
            return Err(wrong(format!(
                "interface {interface} is a surface in space: lines of a field are for plane problems; leave --field out for maps"
            )));
        }
        None => {
            return Err(wrong(format!(
                "interface {interface} has no surface at these times"
            )));
        }
    };
    let last = &sheets[sheets.len() - 1].1;
    let places: Vec<[f64; 3]> = arc
        .points
        .iter()
        .map(|&i| last.grid.points.points[i])
        .collect();
    table.names.push("S".into());
    table.columns.push(arc.s);
    for (time, sheet) in &sheets {
        let values = values(sheet, &arc.points, &places, field).ok_or_else(|| {
            wrong(format!(
                "interface {interface} has no field `{field}` with one component; there are {}",
                single(sheet).collect::<Vec<_>>().join(", ")
            ))
        })?;
        table
            .names
            .push(format!("{field} at {}", axis::number(*time, 5)));
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
    Ok(table)
}

fn single(sheet: &Sheet) -> impl Iterator<Item = &str> {
    let arrays = sheet.grid.points.arrays.iter();
    arrays
        .filter(|(_, a)| a.components == 1)
        .map(|(name, _)| name.as_str())
}

/// Values at the points of the last time, zero where there was none yet.
fn values(sheet: &Sheet, points: &[usize], places: &[[f64; 3]], field: &str) -> Option<Vec<f64>> {
    let mut arrays = sheet.grid.points.arrays.iter();
    let (_, array) = arrays.find(|(name, a)| *name == field && a.components == 1)?;
    let bits = |x: &[f64; 3]| x.map(f64::to_bits);
    let here = &sheet.grid.points.points;
    let same = points.iter().zip(places);
    if same
        .clone()
        .all(|(&i, place)| here.get(i).is_some_and(|x| bits(x) == bits(place)))
    {
        return Some(points.iter().map(|&i| array.values[i]).collect());
    }
    let known: HashMap<[u64; 3], f64> = here
        .iter()
        .map(bits)
        .zip(array.values.iter().copied())
        .collect();
    let value = |place: &[f64; 3]| known.get(&bits(place)).copied().unwrap_or(0.0);
    Some(places.iter().map(value).collect())
}

/// Between which lengths the lines are not zero.
fn part(table: &Table) -> Option<[f64; 2]> {
    let (lengths, lines) = table.columns.split_first()?;
    let largest = lines.iter().flatten().fold(0.0, |m: f64, v| m.max(v.abs()));
    // Part of the largest value from which on a place is part of what is seen.
    let is_seen = |i: usize| lines.iter().any(|line| line[i].abs() > 1e-3 * largest);
    let first = (0..lengths.len()).find(|&i| is_seen(i))?;
    let last = (0..lengths.len()).rfind(|&i| is_seen(i))?;
    let (from, to) = (lengths[first], lengths[last]);
    // A tenth of the width lies to each side of that.
    let margin = 0.1 * (to - from);
    (margin > 0.0).then_some([from - margin, to + margin])
}
