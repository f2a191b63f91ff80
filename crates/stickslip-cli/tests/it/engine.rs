//! Factors by MUMPS on the ranks of an MPI job, from outside: the same results, and nothing left behind whoever dies. What needs the job is
//! ignored unless asked for; `.ci/run` builds the engine and asks for it.

use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use crate::support::{self, CASE, code, text};

/// Two blocks, one thrown at the other: the factor is used in every increment, of which there are more than anybody waits for.
const THROWN: &str = r#"format = 1
model.space = "plane-strain"
body.floor = { generate.rectangle = { from = [0, -1], to = [3, 0], cells = [18, 6] }, material = "steel" }
body.block = { generate.rectangle = { from = [1, 0.0005], to = [2, 1], cells = [7, 7] }, material = "steel" }
material.steel.isotropic = { young = 210e9, poisson = 0.3, density = 7800 }
interface.base = { secondary = "block.bottom", primary = "floor.top", friction.coulomb = { mu = 0.3 } }
support.floor = { set = "floor.bottom", x = 0.0, y = 0.0 }
initial.thrown = { set = "block", velocity = [1.0, -5.0] }
solver.tolerance = 1e-11
output.history-every = 1
step = [{ name = "fall", duration = 1.5e-4, increments = { fixed = 15 }, dynamic = {} }]
"#;

/// Cells of these blocks.
const CELLS: f64 = 18.0 * 6.0 + 7.0 * 7.0;

fn place(name: &str, case: &str) -> PathBuf {
    support::place("engine", name, case)
}

/// A run in a folder, whose files for the ranks go to the folder `between`.
fn run(folder: &Path, arguments: &[&str]) -> Command {
    let between = folder.join("between");
    std::fs::create_dir_all(&between).expect("a folder");
    let mut command = support::command(folder);
    command
        .args(["run", "case.toml", "--quiet"])
        .args(arguments)
        .env("STICKSLIP_MUMPS_DIR", between);
    command
}

fn output(mut command: Command) -> Output {
    command.output().expect("the binary runs")
}

/// Nothing is left where files for the ranks were.
fn assert_clean(folder: &Path) {
    let left = std::fs::read_dir(folder.join("between")).expect("a folder");
    assert_eq!(left.count(), 0);
}

/// The columns of a history, by name; those that are times of the clock are left out.
fn history(folder: &Path) -> Vec<(String, Vec<f64>)> {
    let path = folder.join("history.csv");
    let all = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let mut lines = all.lines().filter(|l| !l.starts_with('#'));
    let names = lines.next().expect("a header").split(',');
    let mut columns: Vec<(String, Vec<f64>)> = names
        .map(|n| (n.trim_matches('"').into(), Vec::new()))
        .collect();
    for line in lines {
        for (column, word) in columns.iter_mut().zip(line.split(',')) {
            column.1.push(word.parse().unwrap_or(f64::NAN));
        }
    }
    columns
}

/// Columns that are measured against a length, a force, an energy; not what rounding is (residuals), and not counts of iterations.
fn compared(name: &str) -> bool {
    [
        ".CF", ".U", ".RF", "ALLSE", "ALLKE", "ALLFD", "STICK", "SLIP", "OPEN",
    ]
    .iter()
    .any(|part| name.contains(part))
}

fn assert_same(a: &Path, b: &Path) {
    let (a, b) = (history(a), history(b));
    // Forces are compared with the largest of all, and so are displacements.
    let kind = |name: &str| {
        name.rsplit('.')
            .next()
            .map(|n| n[..2.min(n.len())].to_string())
    };
    let mut seen = 0;
    for ((name, x), (other, y)) in a.iter().zip(&b) {
        assert_eq!((name, x.len()), (other, y.len()));
        if !compared(name) {
            continue;
        }
        let alike = b.iter().filter(|(other, _)| kind(other) == kind(name));
        let size = alike
            .flat_map(|(_, y)| y)
            .fold(0.0, |m: f64, y| m.max(y.abs()));
        for (x, y) in x.iter().zip(y) {
            seen += usize::from(*y != 0.0);
            assert!((x - y).abs() <= 1e-9 * size, "{name}: {x} instead of {y}");
        }
    }
    assert!(seen > 50, "{seen} numbers compared");
}

/// The same at rest.
fn pressed() -> String {
    THROWN
        .replace(
            "initial.thrown = { set = \"block\", velocity = [1.0, -5.0] }",
            "support.top = { set = \"block.top\", x = 2e-4, y = -1e-3 }",
        )
        .replace(
            "duration = 1.5e-4, increments = { fixed = 15 }, dynamic = {}",
            "increments = { fixed = 10 }",
        )
}

/// Who made the matrices of bodies: cells of each rank, bytes it was sent for them, entries that the first process made.
struct Assembly {
    cells: Vec<f64>,
    bytes: Vec<f64>,
    entries: f64,
}

fn assembly(summary: &str) -> Assembly {
    let summary: serde_json::Value = serde_json::from_str(summary).expect("a summary");
    let engine = &summary["engine"];
    let list = |key: &str| -> Vec<f64> {
        let numbers = engine[key].as_array().expect("a list").iter();
        numbers.map(|n| n.as_f64().expect("a number")).collect()
    };
    Assembly {
        cells: list("cells-of-ranks"),
        bytes: list("bytes-of-ranks"),
        entries: engine["entries-dealt"].as_f64().expect("a number"),
    }
}

/// Results with the built-in engine, and with MUMPS on ranks with these keys, which must be the same. Returns who made the matrices in each of these runs.
fn compare(name: &str, case: &str, all: &[(&str, &str)]) -> Vec<Assembly> {
    let mut assemblies = Vec::new();
    let folder = place(name, case);
    let own = output(run(&folder, &["-o", "own"]));
    assert_eq!(code(&own), Some(0), "{}", text(&own.stderr));
    for (at, (ranks, keys)) in all.iter().enumerate() {
        let out = format!("by-{at}");
        let set = format!("solver.engine.mumps={{ ranks = {ranks}{keys} }}");
        let results = output(run(&folder, &["-o", &out, "--set", &set]));
        assert_eq!(code(&results), Some(0), "{}", text(&results.stderr));
        assert_same(&folder.join(&out), &folder.join("own"));
        let summary = std::fs::read_to_string(folder.join(&out).join("summary.json"));
        let summary = summary.expect("a summary");
        for part in [
            "\"name\": \"mumps\"",
            &format!("\"ranks\": {ranks}"),
            "\"reproducible\": false",
        ] {
            assert!(summary.contains(part), "{part} in {summary}");
        }
        assemblies.push(assembly(&summary));
        assert_clean(&folder);
    }
    assemblies
}

#[test]
#[ignore = "needs the MUMPS engine: `cargo xtask engine mumps`, then `cargo test --tests -- --ignored`"]
fn results_are_those_of_the_built_in_engine_at_rest_and_in_motion() {
    let all = [("1", ""), ("2", ""), ("3", ", spread = true")];
    for motion in compare("motion", THROWN, &all) {
        assert!(motion.cells.is_empty() && motion.entries > 0.0);
    }
    let rest = compare("rest", &pressed(), &all);
    let of_one = rest[0].bytes[0];
    for (ranks, rest) in (1..).zip(&rest) {
        // Each makes the matrices of its part of the cells, the first process none.
        assert_eq!(rest.entries, 0.0);
        assert_eq!(rest.cells.len(), ranks);
        assert_eq!(rest.cells.iter().sum::<f64>(), CELLS);
        let largest = |list: &[f64]| list.iter().fold(0.0, |m: f64, x| m.max(*x));
        let share = 1.0 / ranks as f64;
        assert!(largest(&rest.cells) <= 1.1 * share * CELLS + 2.0);
        // Beside its cells there is the head of a file for each body, and points that it shares with others.
        assert!(largest(&rest.bytes) <= (share + 0.2) * of_one);
    }
}

/// Other elements and materials than those above: what one word of the problem file makes of it.
#[test]
#[ignore = "needs the MUMPS engine: `cargo xtask engine mumps`, then `cargo test --tests -- --ignored`"]
fn cells_of_all_sorts_are_made_by_the_ranks() {
    const STRAIN: &str = "plane-strain";
    const STEEL: &str = "material = \"steel\" }";
    const CONSTANT: &str =
        "material.steel.isotropic = { young = 210e9, poisson = 0.3, density = 7800 }";
    const GRADED: &str = r#"material.steel.isotropic = { young = 210e9, poisson = 0.3, density = 7800 }
material.steel.temperature = 0
material.steel.at = [{ temperature = 400, isotropic = { young = 90e9, poisson = 0.2 } }]
initial.floor = { set = "floor", temperature.linear = { value = 0, point = [0, 0], gradient = [100, 0] } }
initial.block = { set = "block", temperature.linear = { value = 0, point = [0, 0], gradient = [100, 50] } }"#;
    for (name, old, new) in [
        ("stress", STRAIN, "plane-stress"),
        ("axis", STRAIN, "axisymmetric"),
        (
            "reduced",
            STEEL,
            "material = \"steel\", formulation = \"reduced\" }",
        ),
        (
            "modes",
            STEEL,
            "material = \"steel\", formulation = \"incompatible-modes\" }",
        ),
        ("graded", CONSTANT, GRADED),
    ] {
        let case = pressed().replace(old, new);
        assert_ne!(case, pressed());
        for by_ranks in compare(name, &case, &[("2", "")]) {
            assert_eq!(by_ranks.entries, 0.0);
            assert_eq!(by_ranks.cells.iter().sum::<f64>(), CELLS);
        }
    }
}

/// Springs on an elastic body, which contact alone would hold along the floor, and on a rigid one: what is not of cells.
#[test]
#[ignore = "needs the MUMPS engine: `cargo xtask engine mumps`, then `cargo test --tests -- --ignored`"]
fn bodies_on_springs_have_the_same_results_with_a_matrix_that_nobody_keeps() {
    let springs = r#"load.soft = { set = "block", spring = { stiffness = [4e9, 1e9] } }
body.wall = { generate.rectangle = { from = [4, 0], to = [5, 1], cells = [2, 2] }, material = "steel", rigid = true }
load.wall = { set = "wall", spring = { stiffness = [1e9, 2e9] } }
load.push = { set = "wall", nodal-force.value = [1e4, 2e4] }
load.press = { set = "block.top", pressure.value = 1e8 }
"#;
    let case = pressed().replace(
        "support.top = { set = \"block.top\", x = 2e-4, y = -1e-3 }\n",
        springs,
    );
    for by_ranks in compare("springs", &case, &[("2", ""), ("3", ", spread = true")]) {
        // The rigid wall is no body of cells to be factored.
        assert_eq!(by_ranks.cells.iter().sum::<f64>(), CELLS);
        assert!(by_ranks.entries > 0.0 && by_ranks.entries < 1000.0);
    }
}

/// A run that ends before its first increment, and says all of these words.
fn assert_says(folder: &Path, command: Command, words: &[&str]) {
    let ended = output(command);
    let said = text(&ended.stderr);
    assert_eq!(code(&ended), Some(3), "{said}");
    for word in words {
        assert!(said.contains(word), "{word} in {said}");
    }
    assert_clean(folder);
}

fn with_variable(folder: &Path, name: &str, value: &str) -> Command {
    let mut command = run(folder, &["--engine", "mumps"]);
    command.env(name, value);
    command
}

#[test]
fn a_program_that_is_missing_is_named() {
    let folder = place("missing", CASE);
    let nowhere = "/nowhere/stickslip-mumps";
    let command = with_variable(&folder, "STICKSLIP_MUMPS", nowhere);
    assert_says(&folder, command, &[nowhere, "cargo xtask engine mumps"]);
}

#[test]
#[ignore = "needs the MUMPS engine: `cargo xtask engine mumps`, then `cargo test --tests -- --ignored`"]
fn what_the_ranks_lack_is_named() {
    let folder = place("lacking", CASE);
    let place = folder.join("between/none").display().to_string();
    for (name, value, words) in [
        (
            "STICKSLIP_MPIRUN",
            "/nowhere/mpirun",
            ["/nowhere/mpirun, which does not start", "mpi-default-bin"],
        ),
        // A program that is no engine.
        (
            "STICKSLIP_MUMPS",
            "/bin/true",
            ["the engine `mumps` did not start", ""],
        ),
        (
            "STICKSLIP_MUMPS_DIR",
            &place,
            ["files for the engine", "STICKSLIP_MUMPS_DIR"],
        ),
    ] {
        assert_says(&folder, with_variable(&folder, name, value), &words);
    }
}

#[test]
fn a_method_that_does_not_condense_is_refused() {
    let folder = place("method", CASE);
    let refused = output(run(
        &folder,
        &["--ranks", "2", "--set", "solver.method=sparse"],
    ));
    let said = text(&refused.stderr);
    assert_eq!(code(&refused), Some(1), "{said}");
    assert!(said.contains("leave `solver.method` out"), "{said}");
}

/// Processes whose parent is one of these.
fn children(of: u32) -> Vec<u32> {
    let processes = std::fs::read_dir("/proc").into_iter().flatten().flatten();
    let numbers = processes.filter_map(|e| e.file_name().to_str()?.parse().ok());
    let is_child = |process: &u32| {
        let stat = std::fs::read_to_string(format!("/proc/{process}/stat")).unwrap_or_default();
        let behind = stat.rsplit(')').next().unwrap_or_default();
        behind.split_whitespace().nth(1) == Some(&of.to_string())
    };
    numbers.filter(is_child).collect()
}

fn lives(process: u32) -> bool {
    let stat = std::fs::read_to_string(format!("/proc/{process}/stat")).unwrap_or_default();
    !stat.is_empty() && !stat.contains(") Z ")
}

fn kill(process: u32) {
    let killed = Command::new("kill")
        .args(["-9", &process.to_string()])
        .status();
    assert!(killed.expect("kill").success());
}

fn wait_for(what: &str, mut there: impl FnMut() -> bool) {
    let started = Instant::now();
    while !there() {
        assert!(started.elapsed() < Duration::from_secs(120), "{what}");
        std::thread::sleep(Duration::from_millis(20));
    }
}

/// A run on two ranks that has written rows: itself, mpirun, and the ranks.
fn started(folder: &Path, spread: bool) -> (Child, u32, Vec<u32>) {
    let set = format!("solver.engine.mumps={{ ranks = 2, spread = {spread} }}");
    let mut command = run(folder, &["-o", "out", "--set", &set]);
    command.args(["--set", "step.1.increments.fixed=40000"]);
    let child = command
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the binary runs");
    let rows = folder.join("out/history.csv");
    wait_for("rows", || {
        std::fs::read_to_string(&rows).is_ok_and(|text| text.lines().count() > 5)
    });
    let mpirun = children(child.id());
    assert_eq!(mpirun.len(), 1);
    let ranks = children(mpirun[0]);
    assert_eq!(ranks.len(), 2);
    (child, mpirun[0], ranks)
}

#[test]
#[ignore = "needs the MUMPS engine: `cargo xtask engine mumps`, then `cargo test --tests -- --ignored`"]
#[cfg(target_os = "linux")]
fn nothing_stays_behind_whoever_dies() {
    for (who, spread) in [
        ("rank", false),
        ("rank", true),
        ("mpirun", true),
        ("stickslip", false),
    ] {
        let folder = place(&format!("{who}-{spread}"), THROWN);
        let (child, mpirun, ranks) = started(&folder, spread);
        match who {
            "rank" => kill(ranks[1]),
            "mpirun" => kill(mpirun),
            _ => kill(child.id()),
        }
        let ended = child.wait_with_output().expect("it ends");
        if who != "stickslip" {
            let said = text(&ended.stderr);
            assert_eq!(code(&ended), Some(3), "{said}");
            assert!(said.contains("the engine `mumps` has died"), "{said}");
            assert!(said.contains("stickslip resume"), "{said}");
            let summary = std::fs::read_to_string(folder.join("out/summary.json"));
            assert!(
                summary
                    .expect("a summary")
                    .contains("\"status\": \"failed\"")
            );
        }
        let rows = std::fs::read_to_string(folder.join("out/history.csv"));
        assert!(who == "stickslip" || rows.expect("rows").ends_with('\n'));
        wait_for("the end of all processes", || {
            !lives(mpirun) && ranks.iter().all(|&rank| !lives(rank))
        });
        assert_clean(&folder);
    }
}
