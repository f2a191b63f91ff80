//! `sweep`: a problem file or a deck, many values, one table.

mod begun;
mod columns;
mod plan;
mod table;
mod values;

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;
use std::time::Instant;

use stickslip::Error;
use stickslip::assess::doctor::Severity;
use stickslip::model::Setup;
use stickslip::newton::condensed::Library;
use stickslip::results::{Claim, FileClaim, Observer, ResultFiles, Summary};
use stickslip::run::{Interrupt, Simulation, Watch};

use super::{library, spare, use_threads};

use crate::failure::{Failure, Outcome};
use crate::input::{Case, Input};
use crate::progress::found;
use crate::voice::{Heartbeat, Voice};
use begun::{Begun, Stand};
use columns::Columns;
use plan::Plan;
use table::{Row, Table};

/// Run an analysis for many values and write one table: a row a run.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Values are TOML: numbers, true, \"text\", [1, 2], { x = 1 }; commas inside do not separate. A range from..to:count
includes both ends. Bodies that stay the same are factored once. The columns of the table are run, the axes, outcome, increments, iterations, cutbacks,
factorisations, seconds, and the last row of the history. All values are checked before the first run. A run that
fails does not stop the others: its outcome says why, and the exit code is 1. One that does not pass the quality gate says
so too, and the exit code is 2 if none failed.

Examples:
  stickslip sweep case.toml --set interface.base.friction.coulomb.mu=0.1..0.5:5 --set support.top.y=-1e-5,-2e-5
  stickslip sweep case.toml --zip --set step.0.duration=1,2 --set step.0.increments.fixed=10,20 --column ALLSE")]
pub struct Arguments {
    /// The problem file, or an input deck of Abaqus or CalculiX (`.inp`), whose values go by the names that `convert` gives them.
    file: PathBuf,
    /// An axis: a key and its values. Several make all combinations, the last one changing fastest.
    #[arg(long = "set", value_name = "PATH=V1,V2,...", required = true)]
    set: Vec<String>,
    /// One value for all runs, as `run --set`.
    #[arg(long = "fix", value_name = "PATH=VALUE")]
    fix: Vec<String>,
    /// Axes of equal length run side by side, instead of in all combinations.
    #[arg(long)]
    zip: bool,
    /// A quantity of the history that the table shall have; all if not given. Can be repeated.
    #[arg(long = "column", value_name = "NAME")]
    column: Vec<String>,
    /// The table; `<file>.sweep.csv` beside the file if not given. It is complete after every run.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Keep the result files of every run, in DIR/0001 and so on.
    #[arg(long, value_name = "DIR")]
    results: Option<PathBuf>,
    /// Keep the factors of bodies in DIR too, and take from there what was factored before; see `run --cache`.
    #[arg(long, value_name = "DIR")]
    cache: Option<PathBuf>,
    /// Threads; all processors if not given. Results do not depend on it.
    #[arg(long, value_name = "N")]
    threads: Option<usize>,
    /// Go on with a sweep that was stopped or killed: runs that are in the table are not run again.
    #[arg(long)]
    resume: bool,
    /// No progress on standard error.
    #[arg(short, long)]
    quiet: bool,
}

/// Runs all.
pub fn run(arguments: &Arguments) -> Outcome {
    let started = Instant::now();
    use_threads(arguments.threads, arguments.quiet);
    let plan = Plan::new(&arguments.set, &arguments.fix, arguments.zip)?;
    let case = Case::read(&arguments.file)?;
    plan.check(&case.document)
        .map_err(|e| case.failure(e.into()))?;

    let output = arguments.output.clone();
    let output = output.unwrap_or_else(|| arguments.file.with_extension("sweep.csv"));
    spare(&output, std::slice::from_ref(&arguments.file))?;
    let axes = plan.axes.iter().map(|axis| axis.path.clone()).collect();
    let mut table = Table::new(output, axes, &arguments.column);
    // That the file cannot be written should not be found after the first run.
    table.try_file()?;
    let _claim = FileClaim::take(&table.path)?;
    let voice = Voice::new();
    let _heartbeat = (!arguments.quiet).then(|| Heartbeat::start(&voice));
    let tell = |text: &str| {
        if !arguments.quiet {
            voice.line(text);
        }
    };
    tell(&heading(&plan));
    let begun = Begun::of(&arguments.file, &case, &plan, &table.path)?;
    let mut done = 0;
    let stand = match arguments.resume {
        true => begun.stand()?,
        false => Stand::New,
    };
    if stand != Stand::New {
        done = table.take_over(|run| {
            let values = plan.values(run).into_iter();
            values.map(str::to_string).collect()
        })?;
        tell(&format!("{} in the table already", runs(done)));
    }
    if stand == Stand::Over && done < plan.count() {
        return Err(begun.unknown().into());
    }
    begun.write()?;

    let shared = Shared {
        watch: voice.watch(),
        library: library(Library::usual_limit(), arguments.cache.as_deref())?,
        interrupt: crate::interrupt::watch(),
    };
    let mut wanted = arguments.column.as_slice();
    let mut first = 0.0;
    let (mut failed, mut poor) = table.not_done();
    let mut told: Vec<String> = Vec::new();
    for run in done..plan.count() {
        let begun = Instant::now();
        voice.begins(&format!("run {} of {}", run + 1, plan.count()));
        let directory = arguments.results.as_ref();
        let directory = directory.map(|d| d.join(format!("{:04}", run + 1)));
        let mut columns = Columns::new(wanted);
        let input = case.input(&plan.overrides(run));
        let ended = analyse(input, directory.as_deref(), &mut columns, &shared);
        if let Some(refusal) = columns.refusal() {
            return Err(refusal);
        }
        if !columns.names.is_empty() {
            // A later run may lack a column; its place stays empty.
            wanted = &[];
        }
        table.add_quantities(&columns.names);

        let seconds = begun.elapsed().as_secs_f64();
        if run == done {
            first = seconds;
        }
        if let Some(stopped @ Failure::Library(Error::Interrupted(_))) = ended.error {
            tell(&format!(
                "the table in {} has the runs before",
                table.path.display()
            ));
            return Err(stopped);
        }
        failed += usize::from(ended.error.is_some());
        let values = plan.values(run);
        let outcome = outcome(&ended);
        poor += usize::from(ended.summary.as_ref().is_some_and(|s| s.quality.failed()));
        tell(&format!(
            "{:>width$}/{}  {}  {outcome}  {seconds:.3} s",
            run + 1,
            plan.count(),
            values.join("  "),
            width = plan.count().to_string().len()
        ));
        for finding in ended.summary.iter().flat_map(|s| &s.findings) {
            // What is wrong with the model is mostly wrong with it in every run.
            let line = found(finding);
            let before_the_run = finding.step.is_none() && finding.severity >= Severity::Warning;
            if before_the_run && !told.contains(&line) {
                tell(&format!("  {line}"));
                told.push(line);
            }
        }
        for note in ended.summary.iter().flat_map(|s| &s.notes) {
            tell(&format!("  {note}"));
        }
        let row = Row {
            values: values.into_iter().map(str::to_string).collect(),
            outcome,
            seconds,
            ..Row::default()
        };
        table.push(row.with_summary(ended.summary))?;
    }
    begun.end();
    tell(&format!(
        "{} in {:.3} s, the first in {first:.3} s; table in {}",
        runs(plan.count()),
        started.elapsed().as_secs_f64(),
        table.path.display()
    ));
    match failed {
        0 if poor > 0 => Ok(ExitCode::from(crate::failure::CHECK)),
        0 => Ok(ExitCode::SUCCESS),
        failed => Err(Failure::Runs {
            failed,
            all: plan.count(),
            table: table.path,
        }),
    }
}

/// What runs share.
struct Shared {
    /// Factors of bodies that stay the same.
    library: Arc<Library>,
    /// Whether the user wants to stop.
    interrupt: Interrupt,
    /// Who is told what is being worked on.
    watch: Watch,
}

/// How a run ended: its error if it failed, and what is known of it if there was a simulation.
struct Ended {
    error: Option<Failure>,
    summary: Option<Summary>,
}

/// From the problem file to the end of its run.
fn analyse(
    input: Result<Input, Failure>,
    directory: Option<&Path>,
    columns: &mut Columns,
    shared: &Shared,
) -> Ended {
    let failed = |error| Ended {
        error: Some(error),
        summary: None,
    };
    let started = Instant::now();
    let built = input.and_then(|input| Ok((input.build()?, input.files())));
    let (setup, inputs) = match built {
        Ok(built) => built,
        Err(e) => return failed(e),
    };
    let read = started.elapsed().as_secs_f64();
    let mut observers: Vec<&mut dyn Observer> = vec![columns];
    let claim = Claim {
        inputs,
        ..Claim::default()
    };
    let files = directory.map(|directory| ResultFiles::new(directory, &claim));
    let mut files = match files.transpose() {
        Ok(files) => files,
        Err(e) => return failed(e.into()),
    };
    if let Some(files) = &mut files {
        observers.push(files);
    }
    simulate(setup, read, &mut observers, shared)
}

/// Runs a model. The one place where a sweep makes a simulation.
fn simulate(
    setup: Setup,
    read: f64,
    observers: &mut [&mut dyn Observer],
    shared: &Shared,
) -> Ended {
    match Simulation::with_library(setup, Arc::clone(&shared.library)) {
        Ok(mut simulation) => {
            simulation.summary.phases.read = read;
            simulation.set_interrupt(Arc::clone(&shared.interrupt));
            simulation.set_watch(Arc::clone(&shared.watch));
            let error = simulation.run(observers).err();
            Ended {
                error: error.map(Failure::from),
                summary: Some(simulation.summary),
            }
        }
        Err(error) => Ended {
            error: Some(error.into()),
            summary: None,
        },
    }
}

/// `done`, what the quality gate found, or why not, in one line.
fn outcome(ended: &Ended) -> String {
    let quality = ended.summary.as_ref().map(|s| &s.quality);
    let poor = quality.filter(|q| q.failed());
    match (&ended.error, poor.and_then(|q| q.violations().next())) {
        (Some(error), _) => error.line(),
        (None, Some(figure)) => format!("quality: {}", figure.brief()),
        (None, None) => "done".into(),
    }
}

fn runs(count: usize) -> String {
    match count {
        1 => "1 run".into(),
        n => format!("{n} runs"),
    }
}

/// The axes, in the order in which the lines below have their values.
fn heading(plan: &Plan) -> String {
    let axes = plan.axes.iter();
    let axes: Vec<String> = axes
        .map(|axis| format!("{} ({})", axis.path, axis.values.len()))
        .collect();
    let by = if plan.zip { ", " } else { " × " };
    format!("{}: {}", runs(plan.count()), axes.join(by))
}
