use std::path::{Path, PathBuf};
use std::process::ExitCode;

use stickslip::Error;
use stickslip::io::write_atomically;
use stickslip::problem::Problem;
use stickslip_report::Limits;

use crate::failure::Outcome;
use crate::given;
use crate::print;

/// Write a report: one self-contained HTML file.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// The result folder of a run.
    #[arg(value_hint = clap::ValueHint::DirPath)]
    directory: PathBuf,
    /// The file to write; default: `report.html` in the folder.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Largest size of fields in megabytes before compression; times are left out evenly above it.
    #[arg(long, value_name = "MB", default_value_t = 48)]
    limit: u64,
}

/// Writes the report.
pub fn run(arguments: &Arguments) -> Outcome {
    let limits = Limits {
        fields: arguments.limit.saturating_mul(1 << 20),
        ..Limits::default()
    };
    given::results(&arguments.directory)?;
    let output = arguments.output.as_deref();
    let report = stickslip_report::report(&arguments.directory, output, limits)?;
    let mut text = format!(
        "{} ({:.1} MB)\n",
        report.file.display(),
        report.size as f64 / 1e6
    );
    for note in &report.notes {
        text += &format!("note: {note}\n");
    }
    print::out(&text)?;
    Ok(ExitCode::SUCCESS)
}

/// Writes the problem as it is run, with what was changed on the command line, beside its results.
///
/// # Errors
/// [`Error::Io`] if it cannot be written.
pub fn keep_problem(directory: &Path, problem: &Problem) -> Result<(), Error> {
    let text = problem.to_toml().map_err(Error::Problem)?;
    let head = "# The problem as it was run. Names of mesh files are relative to the folder of the original file.\n";
    write_atomically(
        &directory.join("problem.toml"),
        format!("{head}{text}").as_bytes(),
    )
}
