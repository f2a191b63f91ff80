//! What an interface carries along its surface: lines over the arc in a plane, a map in space, and both as a table.

mod arc;
mod map;
mod over;
mod page;
mod unroll;

use std::path::{Path, PathBuf};

use stickslip::Error;
use stickslip::io::{csv, write_atomically};
use stickslip::results::OPPOSITE;

use self::page::Page;
use super::picture::{Units, When, Zoom};
use super::{axis, files, history};
use crate::draw::{Canvas, Svg};
use crate::field::{Field, Part};
use crate::results::{Results, fault};
use crate::sheet::Sheet;
use crate::units::behind;

/// How an interface is shown.
#[derive(Debug, Clone, PartialEq)]
pub struct Along {
    /// Its name.
    pub interface: String,
    /// One field alone, as lines of all times that are asked for in one file.
    pub field: Option<String>,
    /// Which times; a file each where no field is given.
    pub when: When,
    /// Which part of it.
    pub zoom: Zoom,
    /// Width and height `[pixels]`.
    pub size: [u32; 2],
    /// Units for the legend; those that the problem gives if not given.
    pub units: Option<Units>,
}

/// Draws what an interface carries, or writes it as a table where the name of the file ends with `.csv`; returns the files written.
///
/// # Errors
/// [`Error::Io`] if results are missing or damaged, there is no such interface or time, or a file cannot be written.
pub fn along(directory: &Path, file: Option<&Path>, wanted: &Along) -> Result<Vec<PathBuf>, Error> {
    let results = Results::open(directory)?;
    let names = names(&results)?;
    if !names.contains(&wanted.interface.as_str()) {
        let meant = match stickslip::problem::nearest(&wanted.interface, &names) {
            Some(meant) => format!("did you mean `{meant}`? "),
            None => String::new(),
        };
        return Err(fault(
            directory,
            format!(
                "there is no interface `{}`; {meant}there are {}",
                wanted.interface,
                names.join(", ")
            ),
        ));
    }
    let name = format!("{}.png", wanted.interface);
    let file = file.map_or_else(|| directory.join(name), Path::to_path_buf);
    let table = is_table(&file);
    if !table {
        files::canvas(&file, wanted.size)?;
    }
    if let Some(field) = &wanted.field {
        let mut written = vec![file.clone()];
        lines(&results, &wanted.interface, field, wanted, &file)?;
        // Where something wears there is the other side of the scar as well.
        let opposite = format!("{}{OPPOSITE}", wanted.interface);
        let known = ["CWEAR", "CDISS"].contains(&field.as_str());
        let last = files::chosen(&results, wanted.when, wanted.field.as_deref())?.pop();
        let sheet = last.map(|frame| results.sheet(frame, &opposite));
        let worn = sheet.transpose()?.flatten().is_some_and(|s| s.flat());
        if known && worn {
            let beside = files::beside(&file, "opposite");
            lines(&results, &opposite, field, wanted, &beside)?;
            written.push(beside);
        }
        return Ok(written);
    }
    let mut written = Vec::new();
    for frame in files::chosen(&results, wanted.when, wanted.field.as_deref())? {
        let sheets = results.sheets(frame)?;
        let sheet = sheets.iter().find(|s| s.name == wanted.interface);
        let sheet = sheet.ok_or_else(|| {
            let message = "it has no surface of this interface at this time";
            fault(&directory.join("interfaces.pvd"), message)
        })?;
        let file = match wanted.when {
            When::All => files::numbered(&file, frame + 1),
            _ => file.clone(),
        };
        let time = results.frames[frame].time;
        if table {
            csv::write(&file, &rows(sheet))?;
        } else {
            let mut canvas = files::canvas(&file, wanted.size)?;
            let page = Page {
                title: results.title(),
                words: format!("{}, time {}", sheet.name, axis::number(time, 4)),
                units: wanted.units.clone().unwrap_or_else(|| Units::of(&results)),
                zoom: wanted.zoom,
                size: wanted.size,
            };
            match sheet.flat() {
                true => arc::draw(sheet, &page, canvas.as_mut()),
                false => map::draw(sheet, &page, canvas.as_mut()),
            }
            .map_err(|message| fault(directory, message))?;
            write_atomically(&file, &canvas.finish())?;
        }
        written.push(file);
    }
    Ok(written)
}

/// Draws a field along a surface, a line a time, or writes the table of these.
fn lines(
    results: &Results,
    surface: &str,
    field: &str,
    wanted: &Along,
    file: &Path,
) -> Result<(), Error> {
    let frames = files::chosen(results, wanted.when, Some(field))?;
    let mut lines = over::table(results, surface, field, wanted.zoom, &frames)?;
    if is_table(file) {
        return csv::write(file, &lines);
    }
    let units = wanted.units.clone().unwrap_or_else(|| Units::of(results));
    let single = Field {
        name: field.into(),
        array: field.into(),
        part: Part::Component(0),
    };
    let named = format!("{field}{}", behind(units.of_field(&single)));
    for name in &mut lines.names[1..] {
        *name = name.replacen(field, &named, 1);
    }
    let mut canvas = files::canvas(file, wanted.size)?;
    let columns = history::Columns {
        left: lines.names[1..].to_vec(),
        right: Vec::new(),
        against: "S".into(),
        label: format!("length along the surface{}", behind(&units.length)),
    };
    let (size, drawn_on) = (wanted.size, canvas.as_mut());
    history::draw(results, &lines, surface, &columns, size, drawn_on)?;
    write_atomically(file, &canvas.finish())
}

pub fn is_table(file: &Path) -> bool {
    let ending = file.extension();
    ending.is_some_and(|e| e.eq_ignore_ascii_case("csv"))
}

/// Drawings of at most this many interfaces go into a report.
const MOST_DRAWINGS: usize = 24;

/// What each interface carries when contact presses most, as SVG.
pub(crate) fn drawings(results: &Results) -> Result<Vec<String>, Error> {
    if results.surfaces.is_empty() {
        return Ok(Vec::new());
    }
    let frame = results.of_peak()?;
    let size = [1000, 520];
    let mut out = Vec::new();
    for sheet in results.sheets(frame)?.iter().take(MOST_DRAWINGS) {
        let time = axis::number(results.frames[frame].time, 4);
        let page = Page {
            title: sheet.name.clone(),
            words: format!("at time {time}, that of the largest contact pressure"),
            units: Units::of(results),
            zoom: Zoom::Auto,
            size,
        };
        let mut canvas: Box<dyn Canvas> = Box::new(Svg::new(size));
        let drawn = match sheet.flat() {
            true => arc::draw(sheet, &page, canvas.as_mut()),
            false => map::draw(sheet, &page, canvas.as_mut()),
        };
        // What has nothing to show has no drawing.
        if drawn.is_ok() {
            out.push(String::from_utf8_lossy(&canvas.finish()).into_owned());
        }
    }
    Ok(out)
}

fn names(results: &Results) -> Result<Vec<&str>, Error> {
    let mut names: Vec<&str> = Vec::new();
    for part in &results.surfaces {
        if !part.name.ends_with(OPPOSITE) && !names.contains(&part.name.as_str()) {
            names.push(&part.name);
        }
    }
    match names.is_empty() {
        true => Err(fault(
            &results.directory,
            "the results have no surfaces of interfaces: the problem has no interface, or an older version wrote the results. Run the problem again",
        )),
        false => Ok(names),
    }
}

/// All that is known at the points, in the order of the arc in a plane: where they are along it, or on the map; numbers, places and fields.
fn rows(sheet: &Sheet) -> csv::Table {
    let count = sheet.grid.points.points.len();
    let (order, mut table) = match sheet.flat() {
        true => {
            let arc = arc::Arc::of(sheet);
            let s = arc.s.clone();
            (arc.points, vec![("S".to_string(), s)])
        }
        false => {
            let plan = unroll::plan(sheet);
            let pick = |c: usize| plan.iter().map(|p| p[c]).collect();
            let all = (0..count).collect();
            (
                all,
                vec![("S1".to_string(), pick(0)), ("S2".to_string(), pick(1))],
            )
        }
    };
    let mut push = |name: String, value: &dyn Fn(usize) -> f64| {
        table.push((name, order.iter().map(|&i| value(i)).collect()));
    };
    let points = &sheet.grid.points;
    for (c, name) in ["x", "y", "z"].into_iter().enumerate() {
        push(name.into(), &|i| points.points[i][c]);
    }
    for (name, array) in &points.arrays {
        let n = array.components;
        for c in 0..n {
            let name = match (n, name.as_str()) {
                (1, _) => name.clone(),
                // These have their components along the surface as fields of their own.
                (_, "CSHEAR" | "CSLIP") => format!("{name}_{}", ["x", "y", "z"][c]),
                _ => format!("{name}{}", c + 1),
            };
            push(name, &|i| array.values[n * i + c]);
        }
    }
    let (names, columns) = table.into_iter().unzip();
    csv::Table { names, columns }
}
