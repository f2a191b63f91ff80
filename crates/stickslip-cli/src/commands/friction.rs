use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use stickslip::Error;
use stickslip::friction::{self, FrictionProblem, Solution, text};
use stickslip::io::write_atomically;

use crate::failure::{Failure, Outcome, UNSOLVED};
use crate::given;
use crate::print;
use stickslip::number::digits;

/// Solve friction problems u = W r + q with a friction law at every point: solver, iterations and error of each.
///
/// A file has lines `dim D contacts N`, `mu` with N values, `q` with D N lines of a value, normal component first, and `W ENTRIES` with lines of row,
/// column (from 0) and value. `run --dump-failures` writes such files.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// The files.
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// Error tolerance: norm of the natural map relative to that of q.
    #[arg(long, default_value_t = 1e-10, value_parser = tolerance)]
    tolerance: f64,
    /// Write forces and motions of NAME.txt to NAME.csv in this folder.
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// List all solvers that were tried, not only the last one.
    #[arg(short, long)]
    verbose: bool,
}

fn tolerance(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value > 0.0 && value < 1.0 => Ok(value),
        _ => Err("a number between 0 and 1".into()),
    }
}

/// Solves them and prints a table. The exit code is that of a run that did not converge if one of them was not solved.
pub fn run(arguments: &Arguments) -> Outcome {
    let read: Result<Vec<FrictionProblem>, Failure> =
        arguments.files.iter().map(|file| problem(file)).collect();
    let problems = read?;
    if let Some(folder) = &arguments.output {
        fs::create_dir_all(folder).map_err(|e| Error::io(folder, e))?;
    }
    print::out("| problem | points | solver | iterations | error | in all | s |\n")?;
    print::out(&format!("|{}\n", "---|".repeat(7)))?;
    let mut unsolved = 0;
    for (file, problem) in arguments.files.iter().zip(&problems) {
        let started = Instant::now();
        let solution = friction::solve(problem, None, arguments.tolerance);
        unsolved += usize::from(!solution.solved);
        print::out(&row(
            file,
            problem.points(),
            &solution,
            started.elapsed().as_secs_f64(),
        ))?;
        if arguments.verbose {
            for tried in &solution.tried {
                let (solver, iterations, error) = (&tried.solver, tried.iterations, tried.error);
                print::out(&format!(
                    "    {solver}: {iterations} iterations, error {error}\n",
                    error = digits(error, 2)
                ))?;
            }
        }
        if let Some(folder) = &arguments.output {
            let stem = file.file_stem().unwrap_or_default();
            let path = folder.join(stem).with_extension("csv");
            crate::commands::spare(&path, &arguments.files)?;
            write_atomically(&path, table(problem, &solution).as_bytes())?;
        }
    }
    let all = problems.len();
    print::out(&format!("{} of {all} solved\n", all - unsolved))?;
    Ok(match unsolved {
        0 => ExitCode::SUCCESS,
        _ => ExitCode::from(UNSOLVED),
    })
}

/// Reads a problem.
fn problem(file: &Path) -> Result<FrictionProblem, Failure> {
    let text = given::text(file, &["txt"])?;
    let problem = text::read(&text).map_err(|fault| {
        let place = format!("{}:{}", file.display(), fault.line);
        Failure::Arguments(format!("{place}: {}", fault.message), fault.help)
    })?;
    match problem.fault() {
        None => Ok(problem),
        Some(fault) => Err(Failure::Arguments(
            format!("{}: {fault}", file.display()),
            "W maps forces to motions, and is symmetric and positive semi-definite".into(),
        )),
    }
}

/// A row of the table.
fn row(file: &Path, points: usize, solution: &Solution, seconds: f64) -> String {
    let name = file.file_stem().unwrap_or_default().to_string_lossy();
    let (solver, iterations) = match (solution.tried.last(), solution.solved) {
        (Some(last), true) => (last.solver.as_str(), last.iterations),
        (None, true) => ("none needed", 0),
        (_, false) => ("**none**", 0),
    };
    let all: usize = solution.tried.iter().map(|t| t.iterations).sum();
    let error = solution.error;
    format!(
        "| {name} | {points} | {solver} | {iterations} | {error} | {all} | {seconds:.2} |\n",
        error = digits(error, 2)
    )
}

/// Forces and motions as CSV, a row a point.
fn table(problem: &FrictionProblem, solution: &Solution) -> String {
    let d = problem.dimension;
    let names = ["normal", "shear1", "shear2"];
    let heads =
        |what: &str| -> Vec<String> { names[..d].iter().map(|n| format!("{what}_{n}")).collect() };
    let mut text = format!(
        "{},{}\n",
        heads("force").join(","),
        heads("motion").join(",")
    );
    let points = solution.forces.chunks(d).zip(solution.motion.chunks(d));
    for (forces, motion) in points {
        let row: Vec<String> = forces
            .iter()
            .chain(motion)
            .map(|x| format!("{x:?}"))
            .collect();
        text += &row.join(",");
        text += "\n";
    }
    text
}
