use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

use stickslip::newton::condensed::Library;
use stickslip::problem::Document;
use stickslip::simulation::{Observer, ResultFiles, Simulation};

use super::{Outcome, library, located, use_threads};
use crate::progress::Progress;

/// Run an analysis and write its results.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// The problem file.
    file: PathBuf,
    /// Directory of the results; `<file>.out` beside the problem file if not given.
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Threads; all processors if not given. Results do not depend on it.
    #[arg(long, value_name = "N")]
    threads: Option<usize>,
    /// Change a value: path=value, for example interface.base.friction.coulomb.mu=0.3.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    set: Vec<String>,
    /// Keep the factors of bodies in DIR, and take from there what was factored before: for other loads, laws of
    /// interfaces and steps nothing has to be factored again. What is in it can be deleted at any time.
    #[arg(long, value_name = "DIR")]
    cache: Option<PathBuf>,
    /// No progress on standard error.
    #[arg(short, long)]
    quiet: bool,
    /// Show every Newton iteration.
    #[arg(short, long)]
    verbose: bool,
}

/// Runs the analysis.
pub fn run(arguments: &Arguments) -> Outcome {
    use_threads(arguments.threads);
    let started = Instant::now();
    let document = Document::read(&arguments.file)?.with_overrides(arguments.set.clone());
    let problem = document.problem()?;
    let model = problem
        .build(&document.folder())
        .map_err(|e| located(&document, e))?;
    let directory = arguments
        .output
        .clone()
        .unwrap_or_else(|| arguments.file.with_extension("out"));
    let read = started.elapsed().as_secs_f64();
    let library = library(Library::small_limit(), arguments.cache.as_deref())?;
    let mut simulation = Simulation::with_library(model, library)?;
    simulation.summary.phases.read = read;
    let mut files = ResultFiles::new(&directory)?;
    super::report::keep_problem(&directory, &problem)?;
    let mut progress = Progress::new(arguments.verbose);
    let mut observers: Vec<&mut dyn Observer> = vec![&mut files];
    if !arguments.quiet {
        observers.push(&mut progress);
    }
    simulation.run(&mut observers)?;
    if !arguments.quiet {
        crate::progress::closing(&simulation, &directory);
    }
    let quality = &simulation.summary.quality;
    if quality.failed() || !arguments.quiet {
        crate::progress::gate(quality);
    }
    Ok(match quality.failed() {
        true => ExitCode::from(crate::CHECK),
        false => ExitCode::SUCCESS,
    })
}
