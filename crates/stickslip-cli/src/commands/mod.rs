//! The subcommands, one file each: its arguments, and `run`.

pub mod check;
pub mod compare;
pub mod curve;
pub mod explain;
pub mod models;
pub mod run;
pub mod schema;
pub mod sweep;

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;

use stickslip::Error;
use stickslip::newton::condensed::Library;

/// Gives findings about a problem their places in its file.
pub fn located(document: &stickslip::problem::Document, error: Error) -> Error {
    match error {
        Error::Problem(e) if e.source.is_empty() => Error::Problem(document.error(e.findings)),
        other => other,
    }
}

/// Sets the number of threads, if one was chosen. To be called before anything else uses threads.
pub fn use_threads(threads: Option<usize>) {
    if let Some(threads) = threads {
        // Fails only if a pool exists already, which cannot be: this is the first use.
        let _ = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build_global();
    }
}

/// Factors of bodies, kept in memory up to a limit `[bytes]`, and in a directory if there is one.
pub fn library(limit: u64, cache: Option<&Path>) -> Result<Arc<Library>, Error> {
    let library = match cache {
        Some(directory) => Library::in_directory(limit, directory)?,
        None => Library::new(limit),
    };
    Ok(Arc::new(library))
}

/// What a command ends with.
pub type Outcome = Result<ExitCode, Failure>;

/// Why a command could not do its work.
#[derive(Debug)]
pub enum Failure {
    /// From the library.
    Library(Error),
    /// A deck that cannot be run as it is.
    Deck(stickslip_deck::DeckError),
    /// From the command line itself: the message and what to do.
    Arguments(String, String),
    /// Runs of a sweep failed; its table is written all the same.
    Runs {
        /// How many.
        failed: usize,
        /// Of how many.
        all: usize,
        /// The table.
        table: PathBuf,
    },
    /// Standard output is closed or full.
    Output(std::io::Error),
}

impl Failure {
    /// The exit code.
    pub fn code(&self) -> u8 {
        match self {
            Failure::Library(Error::Run(_)) => 3,
            Failure::Library(Error::Interrupted(_)) => crate::INTERRUPTED,
            _ => crate::INPUT,
        }
    }
}

impl From<Error> for Failure {
    fn from(e: Error) -> Self {
        Failure::Library(e)
    }
}

impl From<stickslip::error::ProblemError> for Failure {
    fn from(e: stickslip::error::ProblemError) -> Self {
        Failure::Library(Error::Problem(e))
    }
}

impl From<std::io::Error> for Failure {
    fn from(e: std::io::Error) -> Self {
        Failure::Output(e)
    }
}
