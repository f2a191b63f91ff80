use std::path::PathBuf;
use std::process::ExitCode;

use crate::failure::Outcome;
use crate::print;

/// Compare the results in a directory with expected values.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Directory of results, as written by `run`.
    directory: PathBuf,
    /// What is expected; `expected.toml` beside the directory if not given.
    expected: Option<PathBuf>,
}

/// Prints a line a check; exit code 2 if one fails.
pub fn run(arguments: &Arguments) -> Outcome {
    let expected = arguments.expected.clone().unwrap_or_else(|| {
        let parent = arguments.directory.parent().unwrap_or(&arguments.directory);
        parent.join("expected.toml")
    });
    let report = stickslip::results::compare::compare(&arguments.directory, &expected)?;
    print::out(&format!("{report}\n"))?;
    Ok(if report.passes() {
        ExitCode::SUCCESS
    } else {
        ExitCode::from(crate::failure::CHECK)
    })
}
