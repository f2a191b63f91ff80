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
mod path;
mod picture;
mod raster;
mod regimes;
mod scene;
mod script;
mod statistics;
mod symbols;
mod words;
mod zoom;

use std::path::{Path, PathBuf};

use stickslip::Error;
use stickslip::io::write_atomically;

use crate::draw::{Canvas, Format, Motion, Png, Svg};
use crate::results::{Results, fault};
use crate::shapes;

pub(crate) use along::drawings;
use bodies::Arrangement;
use files::{canvas, chosen, numbered};

pub use along::{Along, along};
pub use camera::View;
pub use facts::Facts;
pub use history::Columns;
pub use path::Line;
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
    // Before anything is read: a wrong ending or size is said at once.
    canvas(file.unwrap_or(Path::new("plot.png")), wanted.size)?;
    for_times(directory, file, wanted, &|scene, frame, file| {
        let mut canvas = canvas(&file, wanted.size)?;
        scene.draw(frame, wanted.size, canvas.as_mut())?;
        write_atomically(&file, &canvas.finish())?;
        Ok(file)
    })
}

/// Writes scripts that draw the pictures of the bodies with PyVista, beside them: `plot.py` for `plot.png`; returns the files written.
///
/// # Errors
/// As [`picture`].
pub fn scripts(
    directory: &Path,
    file: Option<&Path>,
    wanted: &Picture,
) -> Result<Vec<PathBuf>, Error> {
    let written = for_times(directory, file, wanted, &|scene, frame, file| {
        let file = file.with_extension("py");
        let text = scene.script(frame, wanted, &file);
        write_atomically(&file, text.as_bytes())?;
        Ok(file)
    });
    written.map(|(files, _)| files)
}

/// Makes a file for each time of a picture, with the name of the picture, by `make`.
fn for_times(
    directory: &Path,
    file: Option<&Path>,
    wanted: &Picture,
    make: &dyn Fn(&scene::Scene, usize, PathBuf) -> Result<PathBuf, Error>,
) -> Result<(Vec<PathBuf>, Vec<String>), Error> {
    let results = opened(directory, wanted)?;
    let file = file.map_or_else(|| directory.join("plot.png"), Path::to_path_buf);
    let frames = chosen(&results, wanted.when, wanted.field.as_deref())?;
    let scene = scene::Scene::new(&results, wanted, &frames)?;
    let written = frames.iter().map(|&frame| {
        let file = match wanted.when {
            When::All => numbered(&file, frame + 1),
            _ => file.clone(),
        };
        make(&scene, frame, file)
    });
    let written = written.collect::<Result<_, Error>>()?;
    Ok((written, scene.notes))
}

/// What the pictures of the bodies say, a time each: they are drawn from these.
///
/// # Errors
/// As [`picture`], but that nothing is written.
pub fn facts(directory: &Path, wanted: &Picture) -> Result<Vec<Facts>, Error> {
    let results = opened(directory, wanted)?;
    let frames = chosen(&results, wanted.when, wanted.field.as_deref())?;
    let scene = scene::Scene::new(&results, wanted, &frames)?;
    let draw = |frame: &usize| {
        let mut canvas = Svg::new(wanted.size);
        scene.draw(*frame, wanted.size, &mut canvas)
    };
    frames.iter().map(draw).collect()
}

/// How the picture of the contact pressure at one of the times shows the bodies; `None` where there is no such picture in space.
pub(crate) fn arrangement(results: &Results, frame: usize) -> Result<Option<Arrangement>, Error> {
    let grid = results.grid(frame)?;
    if !grid.points.arrays.contains_key("CPRESS") {
        return Ok(None);
    }
    let wanted = Picture {
        field: Some("CPRESS".into()),
        ..Picture::default()
    };
    Ok(scene::Scene::new(results, &wanted, &[frame])?.arrangement())
}

/// Results with something to draw: fields, or the shape of a mode.
fn opened(directory: &Path, wanted: &Picture) -> Result<Results, Error> {
    let results = Results::open(directory)?;
    let results = match &wanted.mode {
        Some(name) => shapes::at_phases(&results, name, PHASES)?,
        None => results,
    };
    if results.frames.is_empty() {
        return Err(fault(
            directory,
            "no fields were written: there is nothing to draw",
        ));
    }
    Ok(results)
}

/// Pictures of a cycle of a mode.
const PHASES: usize = 24;

/// Draws the bodies in motion, a picture for each time at which fields were written or for each phase of a mode, into an animated PNG or a GIF that shows so many
/// pictures a second; returns what is to be said about it.
///
/// # Errors
/// As [`picture`]; and if there is only one time.
pub fn animate(
    directory: &Path,
    file: &Path,
    wanted: &Picture,
    rate: f64,
) -> Result<Vec<String>, Error> {
    let Some(format) = Format::of(file) else {
        let name = file.with_extension("png");
        return Err(fault(
            file,
            format!(
                "motion is written as .png (animated PNG) or .gif; other programs make films of that: `ffmpeg -i {0} {1}`",
                name.display(),
                name.with_extension("mp4").display()
            ),
        ));
    };
    let results = opened(directory, wanted)?;
    let count = results.frames.len();
    if count < 2 {
        return Err(fault(
            directory,
            "fields were written at one time only: there is no motion to draw. `output.every = 1` writes them after every increment",
        ));
    }
    let frames: Vec<usize> = (0..count).collect();
    // A wrong size is said at once.
    canvas(&file.with_extension("png"), wanted.size)?;
    let scene = scene::Scene::new(&results, wanted, &frames)?;
    let mut motion = Motion::new(format, wanted.size, rate);
    for &frame in &frames {
        let mut picture = Png::new(wanted.size).expect("its size was checked");
        scene.draw(frame, wanted.size, &mut picture)?;
        motion.push(&picture);
    }
    write_atomically(file, &motion.finish())?;
    Ok(scene.notes)
}

/// Plots columns of the history against another; returns the file written.
///
/// # Errors
/// [`Error::Io`] if there is no history or no such column, or the file cannot be written.
pub fn columns(
    directory: &Path,
    file: Option<&Path>,
    columns: &Columns,
    size: [u32; 2],
) -> Result<PathBuf, Error> {
    let results = Results::open(directory)?;
    let file = file.map_or_else(|| directory.join("history.png"), Path::to_path_buf);
    let mut canvas = canvas(&file, size)?;
    let table = &results.history;
    let drawn_on = canvas.as_mut();
    history::draw(&results, table, "history.csv", columns, size, drawn_on)?;
    write_atomically(&file, &canvas.finish())?;
    Ok(file)
}

/// Draws a field along a line through the bodies, a line a time, or writes the table of these where the name ends with .csv; returns the file written.
///
/// # Errors
/// [`Error::Io`] if there is no such field or time, the line meets no body, or the file cannot be written.
pub fn path(
    directory: &Path,
    file: Option<&Path>,
    line: &Line,
    size: [u32; 2],
) -> Result<PathBuf, Error> {
    let results = opened(directory, &Picture::default())?;
    let file = file.map_or_else(|| directory.join("path.png"), Path::to_path_buf);
    let table = path::table(&results, line)?;
    if along::is_table(&file) {
        stickslip::io::csv::write(&file, &table)?;
        return Ok(file);
    }
    let mut canvas = canvas(&file, size)?;
    let columns = Columns {
        left: table.names[1..].to_vec(),
        right: Vec::new(),
        against: "S".into(),
        label: "length along the line".into(),
    };
    history::draw(
        &results,
        &table,
        "the line",
        &columns,
        size,
        canvas.as_mut(),
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
    columns: &Columns,
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
    history::draw(&results, &table, name, columns, size, drawn_on)?;
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

/// How the modes of a step depend on what its map varies, as SVG: frequencies and growth over the factor; none where there is no map.
pub(crate) fn couplings(results: &Results, step: usize) -> Result<Vec<String>, Error> {
    let size = [1000, 520];
    let file = results.directory.join(format!("modes-{step}-map.csv"));
    if !file.is_file() {
        return Ok(Vec::new());
    }
    let table = stickslip::io::csv::read(&file)?;
    let mut out = Vec::new();
    for what in ["frequency", "growth"] {
        let mut canvas: Box<dyn Canvas> = Box::new(Svg::new(size));
        history::modes(&file, &table, what, "factor", size, canvas.as_mut())?;
        out.push(String::from_utf8_lossy(&canvas.finish()).into_owned());
    }
    Ok(out)
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
