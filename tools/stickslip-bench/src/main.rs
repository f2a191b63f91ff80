//! Tasks that measure, audit and try the program: `cargo xtask TASK` starts them and lists what they take.

mod chatter;
mod decks;
mod digests;
mod house;
mod kill;
mod mixes;
mod peers;
mod robustness;
mod walk;

use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let result = match arguments.split_first() {
        Some((task, what)) if task == "decks" => decks::run(what),
        Some((task, what)) if task == "digests" => digests::run(what),
        Some((task, [])) if task == "house" => house::count(),
        Some((task, what)) if task == "kill" => kill::run(what),
        Some((task, what)) if task == "walk" => walk::walk(what),
        Some((task, [])) if task == "chatter" => chatter::measure(),
        Some((task, what)) if task == "peers" => peers::compare(what),
        Some((task, what)) if task == "robustness" => robustness::sweep(what),
        Some((task, what)) if task == "mixes" => mixes::sweep(what),
        _ => Err("`cargo xtask` lists the tasks and what they take".to_string()),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}
