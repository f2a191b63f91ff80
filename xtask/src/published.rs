//! `cargo xtask schema` and `cargo xtask rooms`: files that follow from the code. The test that compares one of them with the code does the writing, as it
//! has what is to be written.

use std::process::Command;

use xtask::workspace;

/// Writes the JSON schema as it follows from the structs of problem files to `stickslip.schema.json`, which the program reads and editors find through
/// the first line of the examples.
pub fn schema() -> Result<(), String> {
    written_by("schema::", "STICKSLIP_WRITE_SCHEMA")
}

/// Draws the picture of the rooms in `ARCHITECTURE.md` from the imports.
pub fn rooms() -> Result<(), String> {
    written_by("layers::the_picture", "STICKSLIP_WRITE_ROOMS")
}

/// Runs tests of the library with the variable that makes them write.
fn written_by(tests: &str, variable: &str) -> Result<(), String> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let test = "test --quiet --package stickslip --test it --".split(' ');
    let status = Command::new(cargo)
        .args(test.chain([tests]))
        .env(variable, "1")
        .current_dir(workspace::root())
        .status()
        .map_err(|e| format!("cannot run cargo: {e}"))?;
    match status.success() {
        true => Ok(()),
        false => Err(format!("the test {tests} did not write its file")),
    }
}
