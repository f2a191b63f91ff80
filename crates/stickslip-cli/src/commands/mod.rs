//! The subcommands, one file each: its arguments, and `run`.

pub mod check;
pub mod compare;
pub mod completions;
pub mod convert;
pub mod curve;
pub mod demo;
pub mod explain;
pub mod friction;
pub mod man;
pub mod models;
pub mod new;
pub mod plot;
pub mod report;
pub mod resume;
pub mod run;
pub mod schema;
pub mod sweep;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::builder::PossibleValuesParser;
use stickslip::Error;
use stickslip::newton::condensed::Library;
use stickslip::newton::condensed::engine::EngineModel;
use stickslip::registry::Family;

use crate::failure::Failure;

/// Sets the number of threads, if one was chosen: at most one a processor, as more only wait for each other. To be called before anything else
/// uses threads.
pub fn use_threads(threads: Option<usize>, quiet: bool) {
    let processors = std::thread::available_parallelism().map_or(1, usize::from);
    // Zero: what rayon finds right.
    let count = threads.map_or(0, |wanted| wanted.min(processors));
    if let Some(wanted) = threads.filter(|wanted| *wanted > processors && !quiet) {
        crate::progress::say(&format!(
            "{wanted} threads are asked for, and this machine has {processors} processors: {count} are used"
        ));
    }
    let pool = || rayon::ThreadPoolBuilder::new();
    // A second run in one process (tests, Python) has the pool of the first. A system that gives no more threads still has this one.
    if pool().num_threads(count).build_global().is_err() {
        let _ = pool().num_threads(1).use_current_thread().build_global();
    }
}

/// Linear solvers.
#[derive(Debug, Default, clap::Args)]
pub struct EngineArguments {
    /// Linear solver that factors the bodies; overrides the problem file. `--set` changes its other keys.
    #[arg(long, value_name = "ENGINE", value_parser = PossibleValuesParser::new(EngineModel::KINDS))]
    engine: Option<String>,
    /// Number of MPI processes of `mumps`.
    #[arg(long, value_name = "N")]
    ranks: Option<usize>,
}

impl EngineArguments {
    /// The same as changes of values, which come before those that are given as such.
    pub fn overrides(&self, also: &[String]) -> Vec<String> {
        let ranks = self.ranks.map(|n| format!("ranks = {n}"));
        let ranks = ranks.unwrap_or_default();
        let own = match (&self.engine, self.ranks) {
            (Some(engine), _) => Some(format!("solver.engine={{ {engine} = {{ {ranks} }} }}")),
            (None, Some(n)) => Some(format!("solver.engine.mumps.ranks={n}")),
            (None, None) => None,
        };
        own.into_iter().chain(also.iter().cloned()).collect()
    }
}

/// Factors of bodies, kept in memory up to a limit `[bytes]`, and in a directory if there is one.
pub fn library(limit: u64, cache: Option<&Path>) -> Result<Arc<Library>, Error> {
    let library = match cache {
        Some(directory) => Library::in_directory(limit, directory)?,
        None => Library::new(limit),
    };
    Ok(Arc::new(library))
}

/// Refuses to write over a file that is read.
///
/// # Errors
/// [`Failure::Arguments`], if they are the same, by whatever names.
pub fn spare(output: &Path, inputs: &[PathBuf]) -> Result<(), Failure> {
    // What does not exist is nobody's.
    let Ok(written) = output.canonicalize() else {
        return Ok(());
    };
    let same = |input: &&PathBuf| input.canonicalize().is_ok_and(|read| read == written);
    match inputs.iter().find(same) {
        Some(input) => Err(Failure::Arguments(
            format!("{}: an input is never written to", input.display()),
            "give the output another name".into(),
        )),
        None => Ok(()),
    }
}
