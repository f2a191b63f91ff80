//! What several suites share: from the text of a problem to a simulation, and a record of its iterations.

pub mod resistance;

use std::path::{Path, PathBuf};

use stickslip::Error;
use stickslip::newton::Progress;
use stickslip::problem::{Document, Problem};
pub use stickslip::results::Row;
use stickslip::results::{Analysis, Event, Observer};
use stickslip::run::Simulation;

/// The problem in `text`, which must be sound.
pub fn problem(text: &str) -> Problem {
    Problem::from_toml(text, None).unwrap_or_else(|e| panic!("{e}"))
}

/// A folder for temporary files, empty.
pub fn folder(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    if path.exists() {
        std::fs::remove_dir_all(&path).expect("a folder of an earlier run");
    }
    std::fs::create_dir_all(&path).expect("a folder for temporary files");
    path
}

/// Builds a problem without mesh files.
pub fn build(problem: &Problem) -> Result<Simulation, Error> {
    Simulation::new(problem.build(Path::new("."))?)
}

/// What happened in a run: the iterations of every accepted increment, and its history row.
#[derive(Debug, Default)]
pub struct Record {
    /// Iterations of the increment that is being computed.
    current: Vec<Progress>,
    /// Accepted increments.
    pub increments: Vec<(Vec<Progress>, Row)>,
    /// Increments that were cut.
    pub cutbacks: usize,
}

impl Observer for Record {
    fn see(&mut self, _: &Analysis, event: Event) -> Result<(), Error> {
        match event {
            Event::Iteration(progress) => self.current.push(*progress),
            Event::Increment(row) => {
                let iterations = std::mem::take(&mut self.current);
                self.increments.push((iterations, row.clone()));
            }
            Event::Cutback(..) => {
                self.cutbacks += 1;
                self.current.clear();
            }
            Event::Accepted(_)
            | Event::Note(_)
            | Event::Finding(_)
            | Event::Output
            | Event::Checkpoint(_)
            | Event::End => {}
        }
        Ok(())
    }
}

/// Runs a problem and records it.
pub fn run(problem: &Problem) -> Result<Record, Error> {
    let mut record = Record::default();
    build(problem)?.run(&mut [&mut record])?;
    Ok(record)
}

/// What is said of a problem that cannot be run, and where in the text.
pub fn complaint(text: &str) -> String {
    let document = Document::new(text, None);
    match document.problem() {
        Err(e) => e.to_string(),
        Ok(problem) => match build(&problem) {
            Err(Error::Problem(e)) => document.error(e.findings).to_string(),
            Err(e) => e.to_string(),
            Ok(mut simulation) => match simulation.run(&mut []) {
                Err(e) => e.to_string(),
                Ok(()) => panic!("no complaint about\n{text}"),
            },
        },
    }
}
