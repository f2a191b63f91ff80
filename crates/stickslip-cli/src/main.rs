//! The `stickslip` command.

use std::process::ExitCode;

fn main() -> ExitCode {
    stickslip_cli::main_with(std::env::args_os())
}
