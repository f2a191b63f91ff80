//! The `stickslip` command: arguments, progress and printing around the `stickslip` library.
//!
//! Exit codes: 0 done, 1 the input is wrong or runs of a sweep failed, 2 results fail a check or the quality gate, 3 not converged,
//! 101 a fault of this program, 130 interrupted.
//! Results and listings go to standard output, diagnostics to standard error.

mod browser;
mod closing;
mod commands;
mod defect;
mod failure;
mod given;
mod input;
mod interrupt;
mod lines;
mod print;
mod progress;
mod remaining;
mod render;
mod space;
mod style;
mod voice;

pub use defect::report_defects;

use std::ffi::OsString;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Args, CommandFactory, FromArgMatches, Parser, Subcommand};

use failure::{EXIT_CODES, INPUT};

/// Frictional contact of elastic bodies, in 2D and 3D.
#[derive(Debug, Parser)]
#[command(name = "stickslip", version, arg_required_else_help = true, after_help = EXIT_CODES)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Demo(commands::demo::Arguments),
    New(commands::new::Arguments),
    Run(commands::run::Arguments),
    Resume(commands::resume::Arguments),
    Sweep(commands::sweep::Arguments),
    Check(commands::check::Arguments),
    Compare(commands::compare::Arguments),
    Explain(commands::explain::Arguments),
    Curve(commands::curve::Arguments),
    Friction(commands::friction::Arguments),
    Models(commands::models::Arguments),
    Schema(commands::schema::Arguments),
    Report(commands::report::Arguments),
    Plot(Box<commands::plot::Arguments>),
    Convert(commands::convert::Arguments),
    Completions(commands::completions::Arguments),
    Man(commands::man::Arguments),
}

/// The command line as data, for completions and manual pages.
fn command() -> clap::Command {
    Arguments::command()
}

/// Runs the command line `arguments`, the first of which is the name of the program. Returns the exit code.
pub fn main_with<T: Into<OsString> + Clone>(arguments: impl IntoIterator<Item = T>) -> ExitCode {
    defect::caught(|| obey(arguments))
}

fn obey<T: Into<OsString> + Clone>(arguments: impl IntoIterator<Item = T>) -> ExitCode {
    let arguments = match Arguments::try_parse_from(arguments) {
        Ok(arguments) => arguments,
        Err(e) => {
            // Help and version are "errors" that go to standard output and succeed. A closed pipe is nobody's fault.
            if !e.use_stderr() {
                let _ = e.print();
                return ExitCode::SUCCESS;
            }
            let text = e.render();
            print::err(&match style::coloured() {
                true => text.ansi().to_string(),
                false => text.to_string(),
            });
            return ExitCode::from(INPUT);
        }
    };
    let outcome = match arguments.command {
        Command::Demo(arguments) => commands::demo::run(&arguments),
        Command::New(arguments) => commands::new::run(&arguments),
        Command::Run(arguments) => commands::run::run(&arguments),
        Command::Resume(arguments) => commands::resume::run(&arguments),
        Command::Sweep(arguments) => commands::sweep::run(&arguments),
        Command::Check(arguments) => commands::check::run(&arguments),
        Command::Compare(arguments) => commands::compare::run(&arguments),
        Command::Explain(arguments) => commands::explain::run(&arguments),
        Command::Curve(arguments) => commands::curve::run(&arguments),
        Command::Friction(arguments) => commands::friction::run(&arguments),
        Command::Models(arguments) => commands::models::run(&arguments),
        Command::Schema(arguments) => commands::schema::run(&arguments),
        Command::Report(arguments) => commands::report::run(&arguments),
        Command::Plot(arguments) => commands::plot::run(&arguments),
        Command::Convert(arguments) => commands::convert::run(&arguments),
        Command::Completions(arguments) => commands::completions::run(&arguments, command()),
        Command::Man(arguments) => commands::man::run(&arguments, command()),
    };
    match outcome {
        Ok(code) => code,
        Err(failure) => {
            render::failure(&failure);
            ExitCode::from(failure.code())
        }
    }
}

/// Draws as `stickslip plot` does, from its options; returns the files that were written, and what is to be said about them.
///
/// # Errors
/// What the command would print.
pub fn pictures<T: Into<OsString> + Clone>(
    options: impl IntoIterator<Item = T>,
) -> Result<(Vec<PathBuf>, Vec<String>), String> {
    let name = std::iter::once(OsString::from("plot"));
    let options = name.chain(options.into_iter().map(Into::into));
    let command = commands::plot::Arguments::augment_args(clap::Command::new("plot"));
    let matches = command.try_get_matches_from(options);
    let arguments = matches.and_then(|m| commands::plot::Arguments::from_arg_matches(&m));
    let arguments = arguments.map_err(|e| e.render().to_string())?;
    commands::plot::draw(&arguments).map_err(|failure| render::plain(&failure))
}

/// An option of a command.
pub struct CommandOption {
    /// Its name, without dashes.
    pub name: String,
    /// What its value is called in the help, `x|y|z[=PLACE]`; a switch has none.
    pub value: Option<String>,
    /// Whether it may be given more than once, or takes a list.
    pub repeated: bool,
    /// What it does.
    pub help: String,
}

/// The options of `stickslip plot`, in the order of its help.
pub fn plot_options() -> Vec<CommandOption> {
    let command = commands::plot::Arguments::augment_args(clap::Command::new("plot"));
    let options = command.get_arguments().filter_map(|argument| {
        let takes = argument.get_action().takes_values();
        let names = argument.get_value_names().filter(|_| takes);
        Some(CommandOption {
            name: argument.get_long()?.to_string(),
            value: names.map(|names| names.join(" ")),
            repeated: matches!(argument.get_action(), clap::ArgAction::Append),
            help: argument
                .get_help()
                .map_or_else(String::new, |help| help.to_string()),
        })
    });
    options.collect()
}

/// The number of an exit code, for programs that call [`main_with`].
pub fn number(code: ExitCode) -> u8 {
    // The standard library does not tell; there are not many.
    (0..=u8::MAX)
        .find(|&n| ExitCode::from(n) == code)
        .unwrap_or(INPUT)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::failure::CHECK;

    #[test]
    fn exit_codes_have_their_numbers() {
        for n in [0, INPUT, CHECK, 3, 255] {
            assert_eq!(number(ExitCode::from(n)), n);
        }
    }

    #[test]
    fn a_wrong_command_line_is_an_error_of_input() {
        assert_eq!(number(main_with(["stickslip", "--no-such-flag"])), INPUT);
        assert_eq!(number(main_with(["stickslip", "--version"])), 0);
    }
}
