//! Developer tasks: `cargo xtask TASK`.

mod peers;
mod schema;
mod workspace;

use std::process::ExitCode;

const USAGE: &str = "\
usage: cargo xtask TASK

tasks:
  schema          write stickslip.schema.json, the JSON schema of problem files
  peers [N ...]   run press-and-slide with N cells an edge (default 11 18) in stickslip and in CalculiX,
                  and print both CPU times";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let result = match arguments.split_first() {
        Some((task, [])) if task == "schema" => schema::write(),
        Some((task, sizes)) if task == "peers" => peers::compare(sizes),
        _ => Err(USAGE.to_string()),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}
