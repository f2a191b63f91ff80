//! Pictures of results and plots of histories, as PNG or SVG, made without a browser.

mod along;
mod apart;
mod axis;
mod bodies;
mod camera;
mod chart;
mod facts;
mod files;
mod history;
mod legend;
mod marks;
mod paint;
mod picture;
mod raster;
mod regimes;
mod scene;
mod statistics;
mod symbols;
mod words;
mod zoom;

use std::path::{Path, PathBuf};

use stickslip::Error;
use stickslip::io::write_atomically;

use crate::draw::{Canvas, Svg};
use crate::results::{Results, fault};

pub(crate) use along::drawings;
use files::{canvas, chosen, numbered};

pub use along::{Along, along};
pub use camera::View;
pub use facts::Facts;
pub use picture::{Apart, Colours, Picture, Plane, Units, When, Zoom};
pub use symbols::Acts;
pub(crate) use zoom::scale;

/// Draws the bodies with a field in colour; returns the files written, and what is to be said about them.
///
/// # Errors
/// [`Error::Io`] if results are missing or damaged, there is no such field, time or body, or a file cannot be written.
pub fn picture(
    directory: &Path,
    file: Option<&Path>,
    wanted: &Picture,
) -> Result<(Vec<PathBuf>, Vec<String>), Error> {
    let results = Results::open(directory)?;
    let file = file.map_or_else(|| directory.join("plot.png"), Path::to_path_buf);
    let count = results.frames.len();
    if count == 0 {
        return Err(fault(
            directory,
            "no fields were written: there is nothing to draw",
        ));
    }
    let frames = chosen(&results, wanted.when, wanted.field.as_deref())?;
    // Before anything is read: a wrong ending or size is said at once.
    canvas(&file, wanted.size)?;
    let scene = scene::Scene::new(&results, wanted, &frames)?;
    let mut written = Vec::new();
    for &frame in &frames {
        let file = match wanted.when {
            When::All => numbered(&file, frame + 1),
            _ => file.clone(),
        };
        let mut canvas = canvas(&file, wanted.size)?;
        scene.draw(frame, wanted.size, canvas.as_mut())?;
        write_atomically(&file, &canvas.finish())?;
        written.push(file);
    }
    Ok((written, scene.notes))
}

/// What the pictures of the bodies say, a time each: they are drawn from these.
///
/// # Errors
/// As [`picture`], but that nothing is written.
pub fn facts(directory: &Path, wanted: &Picture) -> Result<Vec<Facts>, Error> {
    let results = Results::open(directory)?;
    let frames = chosen(&results, wanted.when, wanted.field.as_deref())?;
    let scene = scene::Scene::new(&results, wanted, &frames)?;
    let draw = |frame: &usize| {
        let mut canvas = Svg::new(wanted.size);
        scene.draw(*frame, wanted.size, &mut canvas)
    };
    frames.iter().map(draw).collect()
}

/// Plots columns of the history against another; returns the file written.
///
/// # Errors
/// [`Error::Io`] if there is no history or no such column, or the file cannot be written.
pub fn columns(
    directory: &Path,
    file: Option<&Path>,
    names: &[String],
    against: &str,
    size: [u32; 2],
) -> Result<PathBuf, Error> {
    let results = Results::open(directory)?;
    let file = file.map_or_else(|| directory.join("history.png"), Path::to_path_buf);
    let mut canvas = canvas(&file, size)?;
    let table = &results.history;
    let drawn_on = canvas.as_mut();
    history::draw(
        &results,
        table,
        "history.csv",
        names,
        against,
        size,
        drawn_on,
    )?;
    write_atomically(&file, &canvas.finish())?;
    Ok(file)
}

/// Draws columns of another table in the folder of results, such as that of a map, against one of its columns; returns the file written.
///
/// # Errors
/// [`Error::Io`] if there is no such table or column, or the file cannot be written.
pub fn table(
    directory: &Path,
    file: Option<&Path>,
    name: &str,
    names: &[String],
    against: &str,
    size: [u32; 2],
) -> Result<PathBuf, Error> {
    let results = Results::open(directory)?;
    let table = stickslip::io::csv::read(&directory.join(name))?;
    let file = file.map_or_else(
        || directory.join(name).with_extension("png"),
        Path::to_path_buf,
    );
    let mut canvas = canvas(&file, size)?;
    let drawn_on = canvas.as_mut();
    history::draw(&results, &table, name, names, against, size, drawn_on)?;
    write_atomically(&file, &canvas.finish())?;
    Ok(file)
}

/// Draws what the runs of a sweep do, from its table, over two columns; returns the file written, beside the table if none is named.
///
/// # Errors
/// [`Error::Io`] if there is no such table or column, or the file cannot be written.
pub fn regimes(
    table: &Path,
    file: Option<&Path>,
    axes: [&str; 2],
    size: [u32; 2],
) -> Result<PathBuf, Error> {
    map(table, file, &regimes::STICKING, axes, size)
}

/// Draws whether steady sliding is stable in the runs of a sweep, over two columns, with the critical values that it has found; returns the file written, beside
/// the table if none is named.
///
/// # Errors
/// [`Error::Io`] if there is no such table or column, or the file cannot be written.
pub fn stability(
    table: &Path,
    file: Option<&Path>,
    axes: [&str; 2],
    size: [u32; 2],
) -> Result<PathBuf, Error> {
    map(table, file, &regimes::STABILITY, axes, size)
}

/// Draws how strong a vibration is over time and frequency, from the table of its spectra, `modes-3-waterfall.csv`; returns the file written, beside the table if none is
/// named.
///
/// # Errors
/// [`Error::Io`] if there is no such table or column, or the file cannot be written.
pub fn waterfall(table: &Path, file: Option<&Path>, size: [u32; 2]) -> Result<PathBuf, Error> {
    map(table, file, &regimes::WATERFALL, SPECTRA, size)
}

/// The axes of a waterfall.
const SPECTRA: [&str; 2] = ["time", "frequency"];

/// The waterfalls of a folder of results as SVG, by step.
pub(crate) fn waterfalls(results: &Results) -> Result<Vec<String>, Error> {
    let size = [1000, 520];
    let mut out = Vec::new();
    for step in 1..=results.steps() {
        let table = results
            .directory
            .join(format!("modes-{step}-waterfall.csv"));
        if table.is_file() {
            let mut canvas: Box<dyn Canvas> = Box::new(Svg::new(size));
            regimes::draw(&table, &regimes::WATERFALL, SPECTRA, size, canvas.as_mut())?;
            out.push(String::from_utf8_lossy(&canvas.finish()).into_owned());
        }
    }
    Ok(out)
}

fn map(
    table: &Path,
    file: Option<&Path>,
    kind: &regimes::Kind,
    axes: [&str; 2],
    size: [u32; 2],
) -> Result<PathBuf, Error> {
    let file = file.map_or_else(|| table.with_extension("png"), Path::to_path_buf);
    let mut canvas = canvas(&file, size)?;
    regimes::draw(table, kind, axes, size, canvas.as_mut())?;
    write_atomically(&file, &canvas.finish())?;
    Ok(file)
}

/// Draws how modes couple: their frequencies and their growth over a column of the table of a sweep or of a map, a picture each; returns the files written,
/// `FILE.frequency.png` and `FILE.growth.png`.
///
/// # Errors
/// [`Error::Io`] if there is no such table or column, or a file cannot be written.
pub fn coupling(
    table: &Path,
    file: Option<&Path>,
    against: &str,
    size: [u32; 2],
) -> Result<Vec<PathBuf>, Error> {
    let file = file.map_or_else(|| table.with_extension("png"), Path::to_path_buf);
    let ending = file.extension().map(|e| e.to_string_lossy().into_owned());
    let read = stickslip::io::csv::read(table)?;
    let mut written = Vec::new();
    for what in ["frequency", "growth"] {
        let file = file.with_extension(format!("{what}.{}", ending.as_deref().unwrap_or("png")));
        let mut canvas = canvas(&file, size)?;
        history::modes(table, &read, what, against, size, canvas.as_mut())?;
        write_atomically(&file, &canvas.finish())?;
        written.push(file);
    }
    Ok(written)
}
