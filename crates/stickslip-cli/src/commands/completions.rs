use std::process::ExitCode;

use clap::Command;

use crate::failure::Outcome;
use crate::print;

/// Print the completions of this command for a shell.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
bash:        stickslip completions bash > ~/.local/share/bash-completion/completions/stickslip
zsh:         stickslip completions zsh > DIR/_stickslip, where DIR is in your $fpath
fish:        stickslip completions fish > ~/.config/fish/completions/stickslip.fish
powershell:  stickslip completions powershell >> $PROFILE")]
pub struct Arguments {
    /// The shell.
    #[arg(value_enum)]
    shell: clap_complete::Shell,
}

/// Prints them; `all` is the whole command line.
pub fn run(arguments: &Arguments, mut all: Command) -> Outcome {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut all, "stickslip", &mut script);
    print::out(&String::from_utf8_lossy(&script))?;
    Ok(ExitCode::SUCCESS)
}
