//! Tasks of the workspace `tools`: what measures and audits is built when it is asked for.

use std::process::{Command, ExitCode};

use xtask::workspace;

/// Their names.
pub const TASKS: [&str; 9] = [
    "chatter",
    "decks",
    "digests",
    "house",
    "kill",
    "mixes",
    "peers",
    "robustness",
    "walk",
];

/// Runs one in the profile of this program.
pub fn run(arguments: &[String]) -> ExitCode {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let status = Command::new(cargo)
        .args(["run", "--quiet", "--package", "stickslip-bench"])
        .args((!cfg!(debug_assertions)).then_some("--release"))
        .arg("--manifest-path")
        .arg(workspace::root().join("tools/Cargo.toml"))
        .arg("--target-dir")
        .arg(workspace::target())
        .arg("--")
        .args(arguments)
        .status();
    match status {
        Ok(status) if status.success() => ExitCode::SUCCESS,
        Ok(_) => ExitCode::FAILURE,
        Err(e) => {
            eprintln!("cannot run cargo: {e}");
            ExitCode::FAILURE
        }
    }
}
