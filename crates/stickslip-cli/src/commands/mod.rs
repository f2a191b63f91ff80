//! The subcommands, one file each: its arguments, and `run`.

pub mod check;
pub mod models;
pub mod schema;

use std::process::ExitCode;

use stickslip::Error;

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
