use std::ffi::OsStr;
use std::process::ExitCode;

use clap::builder::{PossibleValue, StringValueParser, TypedValueParser};
use clap::{Arg, Command};

use crate::failure::Outcome;
use crate::print;

/// Print shell completions.
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

/// The values that a shell offers for an argument, which takes others as well: what is wrong about those is said by whoever knows what is there.
#[derive(Clone)]
pub struct Words(pub fn() -> Vec<&'static str>);

impl TypedValueParser for Words {
    type Value = String;

    fn parse_ref(
        &self,
        command: &Command,
        argument: Option<&Arg>,
        value: &OsStr,
    ) -> Result<String, clap::Error> {
        StringValueParser::new().parse_ref(command, argument, value)
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        Some(Box::new((self.0)().into_iter().map(PossibleValue::new)))
    }
}

/// Prints them; `all` is the whole command line.
pub fn run(arguments: &Arguments, mut all: Command) -> Outcome {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut all, "stickslip", &mut script);
    print::out(&String::from_utf8_lossy(&script))?;
    Ok(ExitCode::SUCCESS)
}
