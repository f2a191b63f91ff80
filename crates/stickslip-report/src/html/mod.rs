//! The report: one page with all it needs.

mod convergence;
mod energy;
mod escape;
mod facts;
mod model;
mod modes;
mod page;
mod phases;
mod problem;
mod quality;
mod tables;

use std::path::{Path, PathBuf};

use stickslip::Error;
use stickslip::io::write_atomically;

use crate::results::Results;

/// How much of the results goes into a page.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// Most bytes of the fields over all times, before they are compressed. Times are left out, evenly, until the rest fits.
    pub fields: u64,
    /// Most rows of the history. More are thinned out evenly.
    pub rows: usize,
}

impl Default for Limits {
    fn default() -> Self {
        Limits {
            fields: 48 << 20,
            rows: 20_000,
        }
    }
}

/// What was written.
#[derive(Debug, Clone, PartialEq)]
pub struct Report {
    /// The page.
    pub file: PathBuf,
    /// Its size `[bytes]`.
    pub size: u64,
    /// What was left out or is missing, a sentence each; also in the page.
    pub notes: Vec<String>,
}

/// Pages larger than this `[bytes]` say so.
const LARGE_PAGE: u64 = 25 << 20;

/// The page of a result folder, and what was left out of it.
///
/// # Errors
/// [`Error::Io`] if results are damaged.
pub fn page(results: &Results, limits: Limits) -> Result<(String, Vec<String>), Error> {
    let mut notes = results.missing.clone();
    let model = model::pack(results, limits.fields, &mut notes)?;
    let history = tables::pack(&results.history, limits.rows, &mut notes);
    let drawn = page::Drawn {
        modes: modes::section(results)?,
        along: crate::plot::drawings(results)?,
        waterfalls: crate::plot::waterfalls(results)?,
    };
    let mut text = page::write(results, &model, &history, &drawn, &notes);
    if text.len() as u64 > LARGE_PAGE {
        notes.push(format!(
            "this page has {:.0} MB; with a lower --limit it keeps fewer times",
            text.len() as f64 / 1e6
        ));
        text = page::write(results, &model, &history, &drawn, &notes);
    }
    Ok((text, notes))
}

/// Writes the page of a result folder.
///
/// # Errors
/// [`Error::Io`] if results are missing or damaged, or the page cannot be written.
pub fn write(directory: &Path, file: Option<&Path>, limits: Limits) -> Result<Report, Error> {
    let results = Results::open(directory)?;
    let (text, notes) = page(&results, limits)?;
    let file = file.map_or_else(|| directory.join("report.html"), Path::to_path_buf);
    write_atomically(&file, text.as_bytes())?;
    Ok(Report {
        file,
        size: text.len() as u64,
        notes,
    })
}
