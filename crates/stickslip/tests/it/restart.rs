//! An analysis that goes on from a checkpoint does so with the bits of one that never stopped.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use stickslip::contact::look;

use crate::support;
use stickslip::Error;
use stickslip::model::Setup;
use stickslip::newton::condensed::Library;
use stickslip::problem::{Document, Problem, changed_keys};
use stickslip::results::{Analysis, Event, Observer, Snapshot};
use stickslip::run::{Checkpoint, Simulation};

/// What is seen of an increment: the row, the fields and the iterations.
#[derive(Default, Clone)]
struct Diary {
    rows: Vec<Vec<u64>>,
    states: Vec<Vec<u64>>,
    iterations: Vec<usize>,
    seen: usize,
}

fn bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|x| x.to_bits()).collect()
}

impl Observer for Diary {
    fn see(&mut self, analysis: &Analysis, event: Event) -> Result<(), Error> {
        match event {
            Event::Iteration(_) => self.seen += 1,
            Event::Increment(row) => {
                self.rows.push(bits(&row.values));
                let frame = analysis.frame;
                let mut state = bits(&frame.state.u);
                state.extend(bits(&frame.state.v));
                state.extend(bits(&frame.forces));
                for interface in analysis.contacts() {
                    for column in look::table(interface, &frame.state.u).1 {
                        state.extend(bits(&column));
                    }
                }
                self.states.push(state);
                self.iterations.push(std::mem::take(&mut self.seen));
            }
            _ => {}
        }
        Ok(())
    }
}

/// The summary without what clocks say.
fn summary(simulation: &Simulation) -> String {
    let mut value = serde_json::to_value(&simulation.summary).unwrap_or_default();
    if let Some(all) = value.as_object_mut() {
        // Counts of factors and the memory that is free are of a process, too: what one has in memory another makes again.
        for clock in [
            "phases",
            "linear-solve",
            "relative-to-linear",
            "peak-memory",
            "page-faults",
            "method-reason",
        ] {
            all.remove(clock);
        }
        if let Some(solver) = all.get_mut("solver").and_then(|s| s.as_object_mut()) {
            let of_process = [
                "seconds",
                "substructures",
                "analyses",
                "factor",
                "flops",
                "linear",
            ];
            solver.retain(|key, _| of_process.iter().all(|word| !key.starts_with(word)));
        }
    }
    serde_json::to_string_pretty(&value).unwrap_or_default()
}

fn in_place(problem: &Problem) -> Setup {
    problem
        .build(Path::new("."))
        .unwrap_or_else(|e| panic!("{e}"))
}

fn begin(setup: Setup) -> Simulation {
    Simulation::new(setup).unwrap_or_else(|e| panic!("{e}"))
}

/// Runs a problem once, and takes a checkpoint wherever there can be one, in the middle of increments that wait for their report as well; goes on from
/// `count` of them.
pub fn check(name: &str, problem: &Problem, folder: &Path, count: usize) {
    let setup = || problem.build(folder).unwrap_or_else(|e| panic!("{e}"));
    check_setups(name, &setup, count);
}

/// The same of what is made anew each time.
pub fn check_setups(name: &str, setup: &dyn Fn() -> Setup, count: usize) {
    let mut whole = Diary::default();
    let mut run = begin(setup());
    let mut taken = Vec::new();
    loop {
        match run.advance(&mut [&mut whole]) {
            Ok(true) => {}
            Ok(false) => break,
            Err(e) => panic!("{name}: {e}"),
        }
        if let Some(checkpoint) = run.checkpoint() {
            // Iterations of an attempt that failed belong to the next row.
            taken.push((whole.rows.len(), whole.seen, checkpoint.to_bytes()));
        }
    }
    assert!(taken.len() > 1, "{name}: {} checkpoints", taken.len());
    let last = taken.len() - 1;
    let mut chosen: Vec<usize> = (1..=count).map(|k| k * last / (count + 1)).collect();
    chosen.dedup();
    for k in chosen {
        let (rows, seen, bytes) = &taken[k];
        let checkpoint = Checkpoint::from_bytes(bytes).expect("bytes of a checkpoint");
        assert_eq!(&checkpoint.to_bytes(), bytes, "{name}: written once more");
        let library = Arc::new(Library::new(Library::small_limit()));
        let mut again = Simulation::resume(setup(), library, checkpoint)
            .unwrap_or_else(|e| panic!("{name}: {e}"));
        let at_once = again.checkpoint().expect("it stands where it stood");
        assert!(at_once.to_bytes() == *bytes, "{name}: taken at once again");
        let mut rest = Diary {
            seen: *seen,
            ..Diary::default()
        };
        again
            .run(&mut [&mut rest])
            .unwrap_or_else(|e| panic!("{name} from {rows}: {e}"));
        assert_eq!(
            rest.rows.len() + rows,
            whole.rows.len(),
            "{name} from {rows}"
        );
        for i in 0..rest.rows.len() {
            let at = format!("{name} from {rows}: increment {}", rows + i);
            assert!(rest.states[i] == whole.states[rows + i], "{at}, state");
            assert!(rest.rows[i] == whole.rows[rows + i], "{at}, row");
            assert_eq!(rest.iterations[i], whole.iterations[rows + i], "{at}");
        }
        assert_eq!(summary(&again), summary(&run), "{name} from {rows}");
    }
}

/// An example with other values.
fn example(name: &str, overrides: &[&str]) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../examples")
        .join(name);
    let document = Document::read(&folder.join("case.toml"))
        .unwrap_or_else(|e| panic!("{e}"))
        .with_overrides(overrides.iter().map(|o| o.to_string()).collect::<Vec<_>>());
    let problem = document.problem().unwrap_or_else(|e| panic!("{e}"));
    check(&format!("{name} {overrides:?}"), &problem, &folder, 3);
}

/// The block that is dragged, through steps of all kinds, with a law that changes.
fn kinds_of(method: &str) -> String {
    let numbers = ["[9, 3]", "[4, 4]", "2e9", "2e-3", "3"];
    let text = support::dragged(method, numbers);
    text.replace("solver.method", "quality.gate = \"off\"\nsolver.method") + STEPS
}

const STEPS: &str = r#"
[material.m]
isotropic = { young = 2e7, poisson = 0.3, density = 1000 }

[body.block.rayleigh]
mass = 1
stiffness = 1e-4

[[step]]
increments.fixed = 3

[[step]]
change.press.friction.coulomb.mu = 0.1
increments.initial = 0.2

[[step]]
duration = 0.02
dynamic.scheme.generalised-alpha = { rho = 0.8 }
increments.fixed = 8

[[step]]
duration = 0.5
increments.fixed = 5

[[step]]
duration = 0.02
dynamic.scheme.generalised-alpha = { rho = 0.8 }
increments.fixed = 6

[[step]]
duration = 2e-3
dynamic.scheme.central-difference = {}
"#;

fn kinds(method: &str) -> Problem {
    support::problem(&kinds_of(method))
}

#[test]
fn steps_of_all_kinds_go_on_with_the_same_bits() {
    for method in ["condensed", "sparse", "multigrid"] {
        check(method, &kinds(method), Path::new("."), 7);
    }
}

#[test]
fn examples_go_on_with_the_same_bits() {
    // Events in time, obstacles, mortars and bodies that only contact holds, in both ways to solve.
    example("belt-mass", &[]);
    example("flat-punch", &[]);
    example("patch-friction", &["solver.method=\"sparse\""]);
    example("shrink-fit", &["solver.method=\"multigrid\""]);
    example("closing-gaps", &[]);
}

#[test]
fn the_compliance_of_gaps_that_is_kept_goes_on_with_the_same_bits() {
    // Two hundred points that stick, slip and open, whose gradients stay.
    let set = [
        "body.lower.generate.box.cells=[15,15,4]",
        "body.upper.generate.box.cells=[14,14,4]",
        "interface.joint.kinematics.small-sliding={}",
        "interface.joint.friction.coulomb.mu=0.1",
        "support.top-z.z=-1e-4",
        "amplitude.press.table=[[0, 0], [1, 1], [2, -0.1]]",
        "solver.method=\"condensed\"",
    ];
    example("press-and-slide", &set);
}

/// Keeps the last checkpoint that is told of.
#[derive(Default)]
struct Keeper(Option<Snapshot>);

impl Observer for Keeper {
    fn see(&mut self, _: &Analysis, event: Event) -> Result<(), Error> {
        if let Event::Checkpoint(snapshot) = event {
            self.0 = Some(snapshot.clone());
        }
        Ok(())
    }
}

#[test]
fn a_run_that_is_stopped_in_the_middle_of_an_increment_goes_on_with_the_same_bits() {
    for method in ["condensed", "sparse"] {
        check_stopped(method, &kinds(method), &[9, 30, 55]);
    }
}

/// Runs a problem, stops it when it has asked so many times whether to stop, and goes on from the checkpoint that is left.
pub fn check_stopped(name: &str, problem: &Problem, asked: &[usize]) {
    let mut whole = Diary::default();
    let mut run = begin(in_place(problem));
    run.run(&mut [&mut whole]).unwrap_or_else(|e| panic!("{e}"));
    for &asked in asked {
        let counter = AtomicUsize::new(0);
        let mut stopped = begin(in_place(problem));
        stopped.set_interrupt(Arc::new(move || {
            counter.fetch_add(1, Ordering::Relaxed) == asked
        }));
        let (mut first, mut keeper) = (Diary::default(), Keeper::default());
        let outcome = stopped.run(&mut [&mut first, &mut keeper]);
        assert!(matches!(outcome, Err(Error::Interrupted(_))), "{asked}");
        let snapshot = keeper.0.expect("a run that is stopped leaves a checkpoint");
        first.rows.truncate(snapshot.increments);
        first.states.truncate(snapshot.increments);
        let checkpoint = Checkpoint::from_bytes(&snapshot.state).expect("its bytes");
        let setup = problem.build(Path::new(".")).expect("it was built before");
        let library = Arc::new(Library::new(Library::small_limit()));
        let mut again =
            Simulation::resume(setup, library, checkpoint).unwrap_or_else(|e| panic!("{e}"));
        again
            .run(&mut [&mut first])
            .unwrap_or_else(|e| panic!("{e}"));
        assert!(first.rows == whole.rows, "{name}, {asked}: rows");
        assert!(first.states == whole.states, "{name}, {asked}: states");
        assert_eq!(summary(&again), summary(&run), "{name}, {asked}");
    }
}

/// Sizes of what is written: the largest checkpoint, and counts of rows and outputs.
#[derive(Default)]
struct Written {
    checkpoint: usize,
    rows: u64,
    row: usize,
    outputs: u64,
}

impl Observer for Written {
    fn see(&mut self, _: &Analysis, event: Event) -> Result<(), Error> {
        match event {
            Event::Checkpoint(snapshot) => {
                self.checkpoint = self.checkpoint.max(snapshot.state.len());
            }
            Event::Increment(row) => {
                self.rows += 1;
                let length = row.values.iter().map(|x| format!("{x:e},").len()).sum();
                self.row = self.row.max(length);
            }
            Event::Output => self.outputs += 1,
            _ => {}
        }
        Ok(())
    }
}

#[test]
fn what_a_run_writes_is_told_before_it() {
    for method in ["condensed", "sparse", "multigrid"] {
        // Large enough for what is beside the vectors not to count.
        let text = kinds_of(method)
            .replace(
                "quality.gate",
                "output.checkpoint.increments = 1\nquality.gate",
            )
            .replace("cells = [9, 3]", "cells = [60, 20]")
            .replace("cells = [4, 4]", "cells = [20, 20]")
            .replace("increments.initial = 0.2", "increments.fixed = 5")
            .replace("duration = 2e-3", "duration = 5e-4");
        let mut run = begin(in_place(&support::problem(&text)));
        let told = run.sizes();
        let mut written = Written::default();
        run.run(&mut [&mut written])
            .unwrap_or_else(|e| panic!("{e}"));
        let checkpoint = written.checkpoint as u64;
        assert!(
            checkpoint <= told.checkpoint && told.checkpoint < 3 * checkpoint,
            "{method}: {checkpoint} {told:?}"
        );
        let row = written.row as u64;
        assert!(row <= told.row && told.row < 3 * row, "{row} {told:?}");
        // The explicit increments are shorter where bodies touch.
        for (is, said) in [(written.rows, told.rows), (written.outputs, told.outputs)] {
            assert!(is <= 2 * said && said <= 2 * is, "{method}: {is} {told:?}");
        }
    }
}

#[test]
fn a_checkpoint_of_another_model_is_refused() {
    let mut run = begin(in_place(&kinds("sparse")));
    while run.summary.attempts.increments == 0 {
        run.advance(&mut []).unwrap_or_else(|e| panic!("{e}"));
    }
    let bytes = run.checkpoint().expect("between increments").to_bytes();
    let other = kinds_of("sparse").replace("[4, 4]", "[4, 5]");
    let setup = support::problem(&other).build(Path::new("."));
    let checkpoint = Checkpoint::from_bytes(&bytes).expect("its bytes");
    let library = Arc::new(Library::new(Library::small_limit()));
    let refused = Simulation::resume(setup.expect("a model"), library, checkpoint);
    let message = refused.err().map(|e| e.to_string()).unwrap_or_default();
    assert!(message.contains("of another model"), "{message}");
    // Bytes that are cut are none, wherever.
    for end in (0..bytes.len()).step_by(97) {
        assert!(Checkpoint::from_bytes(&bytes[..end]).is_none(), "{end}");
    }
}

#[test]
fn what_is_still_to_come_may_change_and_the_rest_not() {
    let before = kinds("sparse");
    let keys = |from: &str, to: &str, step: usize| -> Vec<String> {
        let text = kinds_of("sparse").replace(from, to);
        let after = support::problem(&text);
        let found = changed_keys(&before, &after, step, false, 0.5 + step as f64);
        found.into_iter().map(|f| f.key).collect()
    };
    assert!(keys("quality.gate", "output.every = 3\nquality.gate", 0).is_empty());
    assert!(keys("duration = 2e-3", "duration = 3e-3", 0).is_empty());
    assert!(keys("fixed = 8", "fixed = 9", 1).is_empty());
    assert!(keys("fixed = 3", "fixed = 3\n\n[[step]]", 0).is_empty());
    assert_eq!(
        keys("fixed = 3", "fixed = 4", 0),
        ["step.1.increments.fixed"]
    );
    assert_eq!(
        keys("mu = 0.3", "mu = 0.2", 0),
        ["interface.press.friction.coulomb.mu"]
    );
    assert_eq!(
        keys("[4, 4]", "[4, 5]", 0),
        ["body.block.generate.rectangle.cells"]
    );
}
