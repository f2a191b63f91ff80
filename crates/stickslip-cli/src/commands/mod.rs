//! The subcommands, one file each: its arguments, and `run`.

pub mod check;
pub mod compare;
pub mod curve;
pub mod models;
pub mod run;
pub mod schema;

use std::process::ExitCode;

use stickslip::Error;

/// Gives findings about a problem their places in its file.
pub fn located(document: &stickslip::problem::Document, error: Error) -> Error {
    match error {
        Error::Problem(e) if e.source.is_empty() => Error::Problem(document.error(e.findings)),
        other => other,
    }
}

/// What a command ends with.
pub type Outcome = Result<ExitCode, Failure>;

/// Why a command could not do its work.
#[derive(Debug)]
pub enum Failure {
    /// From the library.
    Library(Error),
    /// From the command line itself: the message and what to do.
    Arguments(String, String),
    /// Standard output is closed or full.
    Output(std::io::Error),
}

impl Failure {
    /// The exit code.
    pub fn code(&self) -> u8 {
        match self {
            Failure::Library(Error::Run(_)) => 3,
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
