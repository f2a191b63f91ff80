//! Whatever number stands at a key of a problem file, and whatever a file has been damaged to: a finding or a model, and no panic. `cargo xtask walk` does the
//! same with all keys of all examples, with runs, and with more damages.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use stickslip_mechanics::mesh::check;

use stickslip::io::{gmsh, vtu};
use stickslip::problem::Document;
use stickslip::run::Simulation;

/// Tables of many kinds in one problem that is sound.
const CASE: &str = r#"format = 1
model = { space = "plane-strain", thickness = 0.5 }
body.block = { generate.rectangle = { from = [0, 0], to = [0.04, 0.02], cells = [4, 2] }, material = "m", rayleigh = { mass = 1.0, stiffness = 1e-6 } }
body.slab = { generate.rectangle = { from = [0.1, 0], to = [0.2, 0.02], cells = [3, 2] }, material = "m" }
material.m = { isotropic = { young = 2e11, poisson = 0.3, density = 7800 }, expansion = 1e-5 }
obstacle.floor.plane = { point = [0, 0], normal = [0, 1] }
reference.r = { point = [0.02, 0.03], mass = 2.0, inertia = [0.1] }
coupling.k.kinematic = { reference = "r", set = "block.top" }
coupling.s.spring = { stiffness = 1e6, terms = [{ set = "e", component = "x", factor = 1.0 }] }
set.e = { of = "slab", point = [0.2, 0.0] }
pretension.p = { of = "slab", plane = { point = [0.15, 0.0], normal = [1, 0] } }
mass.m = { set = "slab.right", mass = 1.0 }
amplitude.a.table = [[0, 0], [1, 1], [2, 0]]
interface.one = { secondary = "block.bottom", primary = "floor", normal.exponential = { p0 = 1e6, c0 = 1e-6 }, friction.coulomb = { mu = 0.3 }, primary-velocity = [1.0, 0.0] }
interface.two = { secondary = "slab.bottom", primary = "floor", friction.static-kinetic = { static = 0.3, kinetic = 0.2 }, enforcement.penalty = { factor = 100 } }
load.l = { set = "slab.top", pressure = { value = 1e6 }, amplitude = "a" }
load.b = { set = "slab", body-force = { value = [1.0, 2.0] } }
load.f = { set = "r", nodal-force = { value = [1.0, -1.0] } }
support.s = { set = "slab.left", x = 0.0, y = 0.0, amplitude = "a" }
temperature.t = { set = "slab", uniform.value = 20.0, amplitude = "a" }
initial.i = { set = "block", velocity = [0.0, -1.0] }
probe.q = { of = "slab", point = [0.2, 0.02] }
quality = { penetration-to-size = 0.1, rotation = 0.2 }
solver = { tolerance = 1e-8, max-iterations = 20, line-search = 3, linear = { patience = 12, tolerance = 1e-4 } }
output = { every = 1, history-every = 1, times = [0.5], checkpoint = { increments = 5, minutes = 10.0 } }
[[step]]
duration = 1.0
increments = { initial = 0.1, smallest = 1e-5, largest = 1.0 }
pretension.p = { force = 1e3 }
[[step]]
duration = 1.0
increments = { fixed = 4 }
dynamic = { scheme.newmark = { beta = 0.25, gamma = 0.5 } }
"#;

/// What stands in place of each number.
const VALUES: [&str; 9] = [
    "nan",
    "inf",
    "-inf",
    "-1",
    "0",
    "1e300",
    "1e-300",
    "9223372036854775807",
    "-1e-6",
];

/// The paths of all numbers below a value.
fn numbers(value: &toml::Value, path: &str, out: &mut Vec<String>) {
    let below = |name: &str| match path {
        "" => name.to_string(),
        path => format!("{path}.{name}"),
    };
    match value {
        toml::Value::Integer(_) | toml::Value::Float(_) => out.push(path.to_string()),
        toml::Value::Table(table) => {
            for (name, value) in table {
                numbers(value, &below(name), out);
            }
        }
        toml::Value::Array(list) => {
            for (i, value) in list.iter().enumerate() {
                numbers(value, &below(&i.to_string()), out);
            }
        }
        _ => {}
    }
}

/// From the text to the model; whether there is one.
fn build(text: &str, changes: Vec<String>) -> bool {
    let document = Document::new(text, None).with_overrides(changes);
    let problem = document.problem();
    problem.is_ok_and(|problem| problem.build(Path::new(".")).is_ok())
}

/// Does all of this, and names what has panicked.
fn walk(all: impl Iterator<Item = (String, Box<dyn Fn()>)>) {
    let mut broken = Vec::new();
    for (name, job) in all {
        if catch_unwind(AssertUnwindSafe(job)).is_err() {
            broken.push(name);
        }
    }
    assert!(broken.is_empty(), "panics: {broken:#?}");
}

#[test]
fn no_number_at_a_key_makes_a_panic() {
    assert!(build(CASE, Vec::new()), "the problem itself is sound");
    let mut paths = Vec::new();
    numbers(
        &toml::Value::Table(CASE.parse().expect("TOML")),
        "",
        &mut paths,
    );
    assert!(paths.len() > 80, "{}", paths.len());
    walk(paths.iter().flat_map(|path| {
        VALUES.iter().map(move |value| {
            let change = format!("{path}={value}");
            let name = change.clone();
            let job = move || {
                build(CASE, vec![change.clone()]);
            };
            (name, Box::new(job) as Box<dyn Fn()>)
        })
    }));
}

#[test]
fn counts_have_bounds() {
    for (change, said) in [
        (
            "step.2.increments.fixed=1000000000",
            "must be at most 100000000",
        ),
        (
            "solver.max-iterations=9223372036854775807",
            "must be at most 1000000000",
        ),
        (
            "body.block.generate.rectangle.cells=[9223372036854775807, 1]",
            "must be at most 1000000000",
        ),
    ] {
        let document = Document::new(CASE, None).with_overrides(vec![change.into()]);
        let error = document.problem().expect_err(change).to_string();
        assert!(error.contains(said), "{change}: {error}");
    }
}

/// The same numbers each time.
struct Dice(u64);

impl Dice {
    /// Below a count.
    fn below(&mut self, count: usize) -> usize {
        // Marsaglia's xorshift.
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % count.max(1) as u64) as usize
    }
}

/// Words that a number, a count or a key may have become.
const WORDS: [&str; 10] = [
    "nan",
    "-1",
    "1e300",
    "99999999999",
    "18446744073709551615",
    "",
    "\0",
    "\u{1b}[2J",
    "[",
    "=",
];

/// A damage: bytes that are others, words in place of others, pieces that are gone, doubled or moved.
fn damaged(bytes: &[u8], dice: &mut Dice) -> Vec<u8> {
    let mut out = bytes.to_vec();
    for _ in 0..1 + dice.below(3) {
        let at = dice.below(out.len());
        let piece = 1 + dice.below(40);
        let end = (at + piece).min(out.len());
        match dice.below(6) {
            0 if !out.is_empty() => out[at] = dice.below(256) as u8,
            1 => drop(out.drain(at..end)),
            2 => {
                let copy = out[at..end].to_vec();
                let to = dice.below(out.len() + 1);
                out.splice(to..to, copy);
            }
            3 => out.truncate(at),
            _ => {
                // The word that begins after the place.
                let is_part = |b: &u8| b.is_ascii_alphanumeric() || b"+-._".contains(b);
                let begin = at + out[at..].iter().position(is_part).unwrap_or(0);
                let length = out[begin..].iter().take_while(|b| is_part(b)).count();
                let word = WORDS[dice.below(WORDS.len())];
                out.splice(begin..begin + length, word.bytes());
            }
        }
    }
    out
}

/// The files of a folder with an ending, in order.
fn files(folder: &str, ending: &str) -> Vec<(String, Vec<u8>)> {
    let entries = std::fs::read_dir(folder).expect("a folder");
    let mut paths: Vec<_> = entries.map(|e| e.expect("an entry").path()).collect();
    paths.retain(|path| path.extension().is_some_and(|e| e == ending));
    paths.sort();
    let read = |path: &std::path::PathBuf| std::fs::read(path).expect("a file");
    let all = paths
        .iter()
        .map(|path| (path.display().to_string(), read(path)));
    all.collect()
}

/// Damages each file so many times, and reads what is left.
fn read_damaged(files: Vec<(String, Vec<u8>)>, times: u64, read: fn(&[u8])) {
    assert!(!files.is_empty());
    walk(
        files
            .into_iter()
            .enumerate()
            .flat_map(|(k, (name, bytes))| {
                (1..=times).map(move |i| {
                    let seed = (k as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ i;
                    let bytes = damaged(&bytes, &mut Dice(seed));
                    let job = move || read(&bytes);
                    (
                        format!("{name}, damage {i}"),
                        Box::new(job) as Box<dyn Fn()>,
                    )
                })
            }),
    );
}

#[test]
fn damaged_meshes_make_no_panic() {
    read_damaged(files("tests/meshes", "msh"), 12, |bytes| {
        if let Ok(mesh) = gmsh::parse(bytes, Path::new("a.msh")) {
            check::check_structure(&mesh).expect("what is read is sound");
            let _ = check::check(&mesh);
        }
    });
    read_damaged(files("tests/malformed/vtu", "vtu"), 6, |bytes| {
        let _ = vtu::parse(bytes, Path::new("a.vtu"));
        let _ = vtu::parse_mesh(bytes, Path::new("a.vtu"));
    });
}

#[test]
fn damaged_problem_files_make_no_panic() {
    let own = vec![(
        "the problem of this test".to_string(),
        CASE.as_bytes().to_vec(),
    )];
    read_damaged(own, 200, |bytes| {
        build(&String::from_utf8_lossy(bytes), Vec::new());
    });
}

/// A pad that is shaken by a load of no size, below all of its modes.
const SHAKEN: &str = r#"format = 1
model = { space = "plane-strain" }
body.pad = { generate.rectangle = { to = [0.1, 0.02], cells = [1, 1] }, material = "lining" }
material.lining.isotropic = { young = 2e9, poisson = 0.3, density = 2500.0 }
obstacle.disc.plane = { point = [0, 0], normal = [0, 1] }
interface.rub = { secondary = "pad.bottom", primary = "disc", friction.coulomb.mu = 0.5, primary-velocity = [5.0, 0.0] }
load.press = { set = "pad.top", pressure = { value = 1e6 } }
load.shaker = { set = "pad.top", pressure = { value = 0.0 } }
support.g = { set = "pad.right", x = 0.0 }
step = [
 { loads = ["press"], increments.fixed = 1 },
 { loads = ["press"], harmonic = { loads = ["shaker"], from = 10.0, to = 500.0, points = 5 } }]
probe.p = { point = [0, 0] }
"#;

#[test]
fn what_nothing_shakes_does_not_move() {
    let problem = Document::new(SHAKEN, None).problem().expect("sound");
    let setup = problem.build(Path::new(".")).expect("a model");
    let mut simulation = Simulation::new(setup).expect("a simulation");
    simulation.run(&mut []).expect("an answer");
    let outcome = simulation
        .summary
        .vibrations
        .modes
        .last()
        .expect("an outcome");
    let response = outcome.response.as_ref().expect("a response");
    assert_eq!(response.rows.len(), 5);
    let still = |row: &stickslip::modal::ResponseRow| {
        row.residual == 0.0 && row.values.iter().all(|v| *v == [0.0; 2])
    };
    assert!(response.rows.iter().all(still));
}
