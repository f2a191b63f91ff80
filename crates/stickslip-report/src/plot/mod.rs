//! Pictures of results and plots of histories, as PNG or SVG, made without a browser.

mod axis;
mod bodies;
mod camera;
mod history;
mod legend;
mod picture;
mod raster;
mod scene;
mod words;

use std::path::{Path, PathBuf};

use stickslip::Error;
use stickslip::io::write_atomically;

use crate::draw::{self, Canvas};
use crate::results::{Results, fault};

pub use camera::View;
pub use picture::{Picture, When};

/// Sizes of pictures that are made `[pixels]`.
const SIZES: std::ops::RangeInclusive<u32> = 200..=8000;

fn canvas(file: &Path, size: [u32; 2]) -> Result<Box<dyn Canvas>, Error> {
    if !size.iter().all(|n| SIZES.contains(n)) {
        let [w, h] = size;
        return Err(fault(
            file,
            format!(
                "a picture of {w}x{h} is not made: width and height are between {} and {}",
                SIZES.start(),
                SIZES.end()
            ),
        ));
    }
    draw::canvas(file, size)
        .ok_or_else(|| fault(file, "the name of a picture ends with .png or .svg"))
}

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
    let frames: Vec<usize> = match wanted.when {
        When::Last => vec![count - 1],
        When::All => (0..count).collect(),
        When::Number(n) if (1..=count).contains(&n) => vec![n - 1],
        When::Number(n) => {
            return Err(fault(
                directory,
                format!("there is no time {n}: fields were written at {count} times"),
            ));
        }
    };
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

/// `plot.png` of time 7 is `plot_00007.png`.
fn numbered(file: &Path, number: usize) -> PathBuf {
    let part = |p: Option<&std::ffi::OsStr>| p.unwrap_or_default().to_string_lossy().into_owned();
    let (stem, ending) = (part(file.file_stem()), part(file.extension()));
    file.with_file_name(format!("{stem}_{number:05}.{ending}"))
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
    history::draw(&results, names, against, size, canvas.as_mut())?;
    write_atomically(&file, &canvas.finish())?;
    Ok(file)
}
