use std::path::PathBuf;
use std::process::ExitCode;

use clap::Command;
use stickslip::Error;

use crate::failure::Outcome;
use crate::print;

/// Print the manual page, or write the manual pages of all commands to a folder.
#[derive(Debug, clap::Args)]
#[command(after_help = "Read it at once with `stickslip man | man -l -`.")]
pub struct Arguments {
    /// Folder for stickslip.1, stickslip-run.1 and so on.
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
}

/// Prints or writes them; `all` is the whole command line.
pub fn run(arguments: &Arguments, all: Command) -> Outcome {
    match &arguments.output {
        None => {
            let mut page = Vec::new();
            clap_mangen::Man::new(all).render(&mut page)?;
            print::out(&String::from_utf8_lossy(&page))?;
        }
        Some(folder) => {
            std::fs::create_dir_all(folder)
                .and_then(|()| clap_mangen::generate_to(all, folder))
                .map_err(|e| Error::io(folder, e))?;
        }
    }
    Ok(ExitCode::SUCCESS)
}
