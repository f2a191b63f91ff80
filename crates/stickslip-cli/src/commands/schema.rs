use std::process::ExitCode;

use crate::failure::Outcome;
use crate::print;

/// Print the JSON schema of the problem file, for completion in editors.
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Save it beside the problem file and put `#:schema ./stickslip.schema.json` in its first line."
)]
pub struct Arguments {}

/// Prints the schema.
pub fn run(_arguments: &Arguments) -> Outcome {
    print::out(&format!("{:#}\n", stickslip::problem::schema()))?;
    Ok(ExitCode::SUCCESS)
}
