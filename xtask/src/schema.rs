//! `cargo xtask schema`

use std::process::Command;

use crate::workspace;

/// Writes the JSON schema as it follows from the structs of problem files to `stickslip.schema.json`, which the program reads and editors find through
/// the first line of the examples. The test that holds the two together does the writing, as it has the schema.
pub fn write() -> Result<(), String> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let status = Command::new(cargo)
        .args([
            "test",
            "--quiet",
            "--package",
            "stickslip",
            "--test",
            "it",
            "--",
            "schema::",
        ])
        .env("STICKSLIP_WRITE_SCHEMA", "1")
        .current_dir(workspace::root())
        .status()
        .map_err(|e| format!("cannot run cargo: {e}"))?;
    match status.success() {
        true => Ok(()),
        false => Err("the schema could not be written".to_string()),
    }
}
