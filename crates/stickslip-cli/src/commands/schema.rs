use std::process::ExitCode;

use crate::failure::Outcome;
use crate::print;

/// Print the JSON schema of problem files, for editors.
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Save the schema beside the problem file, and begin the problem file with the line `#:schema ./stickslip.schema.json`."
)]
pub struct Arguments {}

/// Prints the schema.
pub fn run(_arguments: &Arguments) -> Outcome {
    print::out(&format!("{:#}\n", stickslip::problem::schema()))?;
    Ok(ExitCode::SUCCESS)
}
