use std::path::PathBuf;
use std::process::ExitCode;

use stickslip::number::figure;
use stickslip::results::compare::{Differences, compare, differences};

use crate::failure::{CHECK, Failure, Outcome};
use crate::given;
use crate::print;

/// Compare results with expected values, or with those of another run.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  stickslip compare case.out                              with expected.toml beside it
  stickslip compare coarse.out fine.out                   histories, fields and interfaces: the largest differences, and where
  stickslip compare before.out after.out --relative 1e-6  exit code 2 if anything differs by more")]
pub struct Arguments {
    /// Result folder of a run.
    #[arg(value_hint = clap::ValueHint::DirPath)]
    directory: PathBuf,
    /// Expected values (default: `expected.toml` beside the folder), or the result folder of another run.
    other: Option<PathBuf>,
    /// Largest allowed difference between two runs, relative to the largest value of a quantity; quantities that cannot be compared fail.
    #[arg(long, value_name = "R")]
    relative: Option<f64>,
}

/// Prints a line a check, or a line a quantity that differs; exit code 2 if one fails.
pub fn run(arguments: &Arguments) -> Outcome {
    given::results(&arguments.directory)?;
    if let Some(other) = arguments.other.as_ref().filter(|other| other.is_dir()) {
        given::results(other)?;
        let found = differences(&arguments.directory, other)?;
        print::out(&format!("{found}\n"))?;
        return judge(&found, arguments.relative);
    }
    if arguments.relative.is_some() {
        return Err(Failure::Arguments(
            "`--relative` is for two directories of results".into(),
            "name both, or give tolerances in expected.toml".into(),
        ));
    }
    let expected = arguments.other.clone().unwrap_or_else(|| {
        let parent = arguments.directory.parent().unwrap_or(&arguments.directory);
        parent.join("expected.toml")
    });
    if arguments.other.is_none() && !expected.exists() {
        return Err(Failure::Arguments(
            format!("{}: there is no such file", expected.display()),
            "name the file of expected values, or the folder of another run: `stickslip compare A.out B.out`".into(),
        ));
    }
    given::file(&expected, &["toml"])?;
    let report = compare(&arguments.directory, &expected)?;
    print::out(&format!("{report}\n"))?;
    Ok(code(report.passes()))
}

/// Whether differences are as small as they shall be.
fn judge(found: &Differences, limit: Option<f64>) -> Outcome {
    let Some(limit) = limit else {
        return Ok(ExitCode::SUCCESS);
    };
    let beyond = found.quantities.iter().filter(|d| d.relative() > limit);
    let beyond = beyond.count();
    let limit = figure(limit);
    print::out(&match (beyond, found.uncompared.len()) {
        (0, 0) => format!("all differ by at most {limit}\n"),
        (0, n) => format!("those compared differ by at most {limit}, but {n} could not be\n"),
        (n, _) => format!("{n} differ by more than {limit}\n"),
    })?;
    Ok(code(beyond == 0 && found.uncompared.is_empty()))
}

fn code(passes: bool) -> ExitCode {
    match passes {
        true => ExitCode::SUCCESS,
        false => ExitCode::from(CHECK),
    }
}
