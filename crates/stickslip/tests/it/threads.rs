//! Results do not depend on the number of threads, to the last bit.

use crate::support;
use std::path::Path;

use stickslip::results::ResultFiles;
use stickslip::run::Simulation;

/// Large enough that bodies and interface are worked on in several chunks.
const CASE: &str = r#"
format = 1
model.space = "solid"

[body.lower]
generate.box = { from = [0, 0, -1], to = [1, 1, 0], cells = [9, 9, 6] }
material = "steel"

[body.upper]
generate.box = { from = [0.1, 0.1, 0], to = [0.8, 0.9, 0.8], cells = [8, 8, 6] }
material = "steel"

[material.steel.isotropic]
young = 210e9
poisson = 0.3

[interface.joint]
secondary = "upper.bottom"
primary = "lower.top"
friction.coulomb = { mu = 0.2 }

[support.base]
set = "lower.bottom"
x = 0
y = 0
z = 0

[support.top]
set = "upper.top"
x = 2e-4
y = 1e-4
z = -4e-4

[probe.corner]
of = "upper"
point = [0.1, 0.1, 0]

[output]
every = 1

[[step]]
increments.fixed = 2
"#;

/// The same cubes thrown at each other, by an implicit and an explicit scheme.
const MOTION: &str = r#"
[initial.throw]
set = "upper"
velocity = [20, 10, -50]

[[step]]
name = "implicit"
duration = 1e-5
increments.fixed = 2
dynamic = {}

[[step]]
name = "explicit"
duration = 4e-5
dynamic = { scheme.central-difference = {} }
"#;

fn run(case: &str, threads: usize, folder: &Path) {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .expect("a pool of threads");
    pool.install(|| {
        let problem = support::problem(case);
        let mut simulation: Simulation = support::build(&problem).unwrap_or_else(|e| panic!("{e}"));
        let mut files =
            ResultFiles::new(folder, &Default::default()).unwrap_or_else(|e| panic!("{e}"));
        simulation
            .run(&mut [&mut files])
            .unwrap_or_else(|e| panic!("{e}"));
    });
}

/// All files below a folder but the summary, which tells times.
fn contents(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let mut out = Vec::new();
    let mut left = vec![folder.to_path_buf()];
    while let Some(path) = left.pop() {
        if path.is_dir() {
            let entries = std::fs::read_dir(&path).expect("a folder of results");
            left.extend(entries.map(|e| e.expect("an entry").path()));
        } else if path.file_name().is_some_and(|n| n != "summary.json") {
            let name = path.strip_prefix(folder).expect("below").display();
            let bytes = std::fs::read(&path).expect("a result file");
            out.push((name.to_string(), bytes));
        }
    }
    out.sort();
    out
}

#[test]
fn one_thread_and_four_give_the_same_files() {
    same_files("statics", CASE);
}

#[test]
fn one_thread_and_four_give_the_same_motion() {
    let still = CASE.replace("poisson = 0.3", "poisson = 0.3\ndensity = 7800");
    let (bodies, _) = still.split_once("[[step]]").expect("a step");
    let (before, after) = bodies.split_once("[support.top]").expect("a support");
    let (_, after) = after.split_once("[probe").expect("a probe");
    let finer = before.replace("cells = [9, 9, 6]", "cells = [14, 14, 10]");
    same_files("motion", &format!("{finer}[probe{after}{MOTION}"));
}

fn same_files(name: &str, case: &str) {
    let folders = [1, 4].map(|threads| {
        let folder = support::folder(&format!("threads-{name}-{threads}"));
        run(case, threads, &folder);
        folder
    });
    let [one, four] = folders.each_ref().map(|f| contents(f));
    let names = |all: &[(String, Vec<u8>)]| -> Vec<String> {
        all.iter().map(|(name, _)| name.clone()).collect()
    };
    assert_eq!(names(&one), names(&four));
    for wanted in ["history.csv", "interfaces/joint.csv"] {
        assert!(names(&one).iter().any(|n| n == wanted), "{:?}", names(&one));
    }
    assert!(names(&one).iter().filter(|n| n.ends_with(".vtu")).count() >= 2);
    for ((name, a), (_, b)) in one.iter().zip(&four) {
        assert!(!a.is_empty(), "{name} is empty");
        assert!(a == b, "{name} depends on the number of threads");
    }
}
