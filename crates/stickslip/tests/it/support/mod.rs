//! What several suites share: from the text of a problem to a simulation, and a record of its iterations.

pub mod resistance;

use std::path::{Path, PathBuf};

use stickslip::Error;
use stickslip::contact::interface::ContactView;
use stickslip::newton::Progress;
use stickslip::problem::{Document, Problem};
pub use stickslip::results::Row;
use stickslip::results::{Analysis, Event, Observer};
use stickslip::run::Simulation;

/// The problem in `text`, which must be sound.
pub fn problem(text: &str) -> Problem {
    Problem::from_toml(text, None).unwrap_or_else(|e| panic!("{e}"))
}

/// A block that is pressed on a base over the first second and dragged along it after that, of a material `m`. Numbers are cells of the base and of the block, the
/// stiffness of the interface, the way, and the time at which it is covered; material and steps are to follow.
pub fn dragged(method: &str, [base, block, stiffness, way, end]: [&str; 5]) -> String {
    format!(
        r#"
format = 1
model.space = "plane-strain"
solver.method = "{method}"

[body.base]
generate.rectangle = {{ from = [0, -1], to = [3, 0], cells = {base} }}
material = "m"

[body.block]
generate.rectangle = {{ from = [1, 0], to = [2, 1], cells = {block} }}
material = "m"

[interface.press]
secondary = "block.bottom"
primary = "base.top"
normal.linear = {{ c = {stiffness} }}
friction.coulomb = {{ mu = 0.3 }}

[support.base]
set = "base.bottom"
x = 0
y = 0

[support.top-y]
set = "block.top"
y = -1e-3
amplitude = "press"

[support.top-x]
set = "block.top"
x = {way}
amplitude = "drag"

[amplitude.press]
table = [[0, 0], [1, 1]]

[amplitude.drag]
table = [[1, 0], [{end}, 1]]
"#
    )
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

/// The first interface as it was after the last increment that was reported.
pub fn contact(simulation: &Simulation) -> ContactView<'_> {
    let first = simulation.view().contacts().next();
    first.expect("there is an interface")
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
            | Event::Cycle(_)
            | Event::Note(_)
            | Event::Finding(_)
            | Event::Output
            | Event::Checkpoint(_)
            | Event::Modes(_)
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
