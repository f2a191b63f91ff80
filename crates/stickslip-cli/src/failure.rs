//! What a command ends with: exit codes, and why it could not do its work.

use std::path::PathBuf;
use std::process::ExitCode;

use stickslip::Error;
use stickslip::error::ProblemError;
use stickslip::problem::Document;
use stickslip_deck::DeckError;

/// The input is wrong; also the code of a wrong command line.
pub const INPUT: u8 = 1;

/// Results fail a check or the quality gate.
pub const CHECK: u8 = 2;

/// A run, or a friction problem, has not converged.
pub const UNSOLVED: u8 = 3;

/// Stopped by Ctrl-C; results up to there are complete.
pub const INTERRUPTED: u8 = 130;

/// The program has a fault: what it takes for certain does not hold. This is what the standard library ends with as well.
pub const DEFECT: u8 = 101;

/// The table of them.
pub const EXIT_CODES: &str = "\
Exit codes:
  0    done
  1    the input is wrong, or runs of a sweep failed
  2    a check of `compare` or the quality gate fails; results are kept
  3    the analysis did not finish
  101  a fault of this program: please report it, with the input that shows it
  130  interrupted; the results up to there are complete";

/// What a command ends with.
pub type Outcome = Result<ExitCode, Failure>;

/// Why a command could not do its work.
#[derive(Debug)]
pub enum Failure {
    /// From the library.
    Library(Error),
    /// A deck that cannot be run as it is.
    Deck(DeckError),
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
    /// What is wrong, in a line.
    pub fn line(&self) -> String {
        let text = match self {
            Failure::Library(e) => e.to_string(),
            Failure::Deck(e) => e.to_string(),
            Failure::Arguments(message, _) => message.clone(),
            Failure::Runs { failed, all, .. } => format!("{failed} of {all} runs failed"),
            Failure::Output(e) => e.to_string(),
        };
        text.lines().next().unwrap_or_default().to_string()
    }

    /// The exit code.
    pub fn code(&self) -> u8 {
        match self {
            Failure::Library(Error::Run(_)) => UNSOLVED,
            Failure::Library(Error::Interrupted(_)) => INTERRUPTED,
            _ => INPUT,
        }
    }
}

impl From<Error> for Failure {
    fn from(e: Error) -> Self {
        Failure::Library(e)
    }
}

impl From<ProblemError> for Failure {
    fn from(e: ProblemError) -> Self {
        Failure::Library(Error::Problem(e))
    }
}

impl From<std::io::Error> for Failure {
    fn from(e: std::io::Error) -> Self {
        Failure::Output(e)
    }
}

/// Gives findings about a problem their places in its file.
pub fn located(document: &Document, error: Error) -> Error {
    match error {
        Error::Problem(e) if e.source.is_empty() => Error::Problem(document.error(e.findings)),
        other => other,
    }
}
