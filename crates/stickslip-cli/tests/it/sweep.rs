//! Sweeps from outside: which runs, in which order, what the table says, and what is refused before anything runs.

use crate::support::{self, CASE};
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::Duration;

use stickslip::io::csv;

/// A folder of its own for each test, with the case in it.
struct Place {
    folder: PathBuf,
}

impl Place {
    fn new(name: &str) -> Self {
        let folder = support::place("sweep", name, CASE);
        Place { folder }
    }

    fn write_case(&self, text: &str) {
        std::fs::write(self.folder.join("case.toml"), text).expect("the folder can be written to");
    }

    fn path(&self, name: &str) -> String {
        self.folder.join(name).display().to_string()
    }

    fn command(&self, command: &str, arguments: &[&str]) -> Command {
        let mut all = Command::new(env!("CARGO_BIN_EXE_stickslip"));
        all.arg(command).arg(self.path("case.toml")).args(arguments);
        all
    }

    fn sweep(&self, arguments: &[&str]) -> Output {
        let mut command = self.command("sweep", arguments);
        command.output().expect("the binary runs")
    }

    /// The table of a sweep that has to end with this code.
    fn table(&self, arguments: &[&str], code: i32) -> Table {
        let output = self.sweep(arguments);
        assert_eq!(output.status.code(), Some(code), "{}", err(&output));
        assert!(output.stdout.is_empty());
        table(&self.folder.join("case.sweep.csv"))
    }

    /// What the runs of the last sweep took.
    fn effort(&self) -> Table {
        table(&self.folder.join("case.sweep.effort.csv"))
    }

    fn exists(&self, name: &str) -> bool {
        self.folder.join(name).exists()
    }
}

fn err(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// A table with its text; quoted cells as they were before.
struct Table {
    names: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Table {
    fn column(&self, name: &str) -> Vec<&str> {
        let i = self.names.iter().position(|n| n == name);
        let i = i.unwrap_or_else(|| panic!("no `{name}` in {:?}", self.names));
        self.rows.iter().map(|row| row[i].as_str()).collect()
    }

    fn numbers(&self, name: &str) -> Vec<f64> {
        let numbers = self.column(name).into_iter().map(str::parse);
        numbers.collect::<Result<_, _>>().expect("numbers")
    }
}

fn table(path: &Path) -> Table {
    let text = std::fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    assert!(text.ends_with('\n'), "the last row is cut: {text}");
    let mut rows: Vec<Vec<String>> = text.lines().map(cells).collect();
    let names = rows.remove(0);
    assert!(rows.iter().all(|row| row.len() == names.len()), "{text}");
    Table { names, rows }
}

fn cells(line: &str) -> Vec<String> {
    let mut cells = vec![String::new()];
    let mut quoted = false;
    let mut after_quote = false;
    for letter in line.chars() {
        let cell = cells.last_mut().expect("there is one");
        match letter {
            '"' => {
                // The second of two quotes within quotes stands for one.
                if after_quote && !quoted {
                    cell.push('"');
                }
                quoted = !quoted;
                after_quote = !quoted;
                continue;
            }
            ',' if !quoted => cells.push(String::new()),
            letter => cell.push(letter),
        }
        after_quote = false;
    }
    cells
}

const MU: &str = "interface.base.friction.coulomb.mu";

#[test]
fn the_last_axis_changes_fastest_and_the_numbers_are_those_of_single_runs() {
    let place = Place::new("product");
    let output = place.sweep(&[
        "--set",
        &format!("{MU}=0.1,0.3"),
        "--set",
        "support.top.y=-1e-5,-2.5e-5,-3e-5",
        "--fix",
        "support.top.x=1e-6",
    ]);
    assert_eq!(output.status.code(), Some(0), "{}", err(&output));
    let table = table(&place.folder.join("case.sweep.csv"));
    let header = [
        "run",
        MU,
        "support.top.y",
        "outcome",
        "increments",
        "iterations",
        "cutbacks",
        "STEP",
        "INC",
    ];
    assert_eq!(table.names[..header.len()], header);
    assert_eq!(table.column("run"), ["1", "2", "3", "4", "5", "6"]);
    assert_eq!(table.column(MU), ["0.1", "0.1", "0.1", "0.3", "0.3", "0.3"]);
    let heights = ["-1e-5", "-2.5e-5", "-3e-5", "-1e-5", "-2.5e-5", "-3e-5"];
    assert_eq!(table.column("support.top.y"), heights);
    assert_eq!(table.column("outcome"), ["done"; 6]);
    assert_eq!(table.column("increments"), ["2"; 6]);
    let effort = place.effort();
    assert_eq!(effort.column("run"), table.column("run"));
    assert!(effort.numbers("seconds").iter().all(|&s| s > 0.0));
    // a row against `run` with the same values, to the bit
    let mut run = place.command("run", &["-q", "-o", &place.path("one")]);
    run.args(["--set", "support.top.x=1e-6", "--set", &format!("{MU}=0.3")]);
    let run = run.args(["--set", "support.top.y=-2.5e-5"]).output();
    assert_eq!(run.expect("the binary runs").status.code(), Some(0));
    let history = csv::read(&place.folder.join("one/history.csv")).expect("a history");
    assert_eq!(table.names[7..], history.names);
    for name in &history.names {
        let alone = *history.column(name).and_then(<[f64]>::last).expect("a row");
        let here = table.numbers(name)[4];
        assert_eq!(here.to_bits(), alone.to_bits(), "{name}");
    }
    assert_eq!(table.numbers("corner.U2")[4], -2.5e-5);
    // progress: the axes, a line a run, the times
    let err = err(&output);
    let lines: Vec<&str> = err.lines().collect();
    assert_eq!(lines.len(), 8, "{err}");
    assert_eq!(lines[0], format!("6 runs: {MU} (2) × support.top.y (3)"));
    assert!(
        lines[5].starts_with("5/6  0.3  -2.5e-5  done  "),
        "{}",
        lines[5]
    );
    assert!(
        lines[7].contains("the first in ") && lines[7].ends_with("case.sweep.csv"),
        "{}",
        lines[7]
    );
    // no results were asked for
    assert!(!place.exists("case.out"));
}

#[test]
fn bodies_that_stay_the_same_are_factored_once() {
    let place = Place::new("shared");
    let set = format!("{MU}=0.1,0.2,0.3");
    let cache = place.path("cache");
    for (arguments, expected) in [
        (&["--set", &set][..], ["1", "0", "0"]),
        (&["--set", &set, "--cache", &cache], ["1", "0", "0"]),
        (&["--set", &set, "--cache", &cache], ["0", "0", "0"]),
    ] {
        place.table(arguments, 0);
        assert_eq!(place.effort().column("factorisations"), expected);
    }
    // `run` uses the same directory.
    let arguments = ["-q", "--cache", &cache, "-o", &place.path("one")];
    let run = place.command("run", &arguments).output();
    assert_eq!(run.expect("the binary runs").status.code(), Some(0));
    let summary = std::fs::read_to_string(place.folder.join("one/summary.json"));
    let summary = summary.expect("a summary");
    assert!(summary.contains("\"substructures-read\": 1"), "{summary}");
    // Another matrix is another body.
    let young = "material.steel.isotropic.young=200e9,210e9,220e9,200e9";
    place.table(&["--set", young], 0);
    let effort = place.effort();
    assert_eq!(effort.column("factorisations"), ["1", "1", "1", "0"]);
    assert_eq!(effort.column("shared"), ["0", "0", "0", "1"]);
    // What is wrong with a file is said.
    for entry in std::fs::read_dir(place.folder.join("cache")).expect("a folder") {
        std::fs::write(entry.expect("an entry").path(), "nothing").expect("a file to write");
    }
    let output = place.sweep(&["--set", &set, "--cache", &cache]);
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(
        err(&output).matches("made again").count(),
        1,
        "{}",
        err(&output)
    );
}

#[test]
fn a_run_that_fails_has_its_reason_in_the_table_and_the_others_go_on() {
    let place = Place::new("fails");
    // With the first value nothing holds the block sideways.
    let held = r#"support.top={set="block.top",y=-1e-5},{set="block.top",x=0.0,y=-1e-5}"#;
    let surface = "interface.base.secondary=block.botom,block.bottom";
    let axes = ["--set", surface, "--set", held];
    let fix = ["--fix", "interface.base.friction={none={}}", "-q"];
    let output = place.sweep(&[axes, [fix[0], fix[1], fix[2], "--threads=1"]].concat());
    assert_eq!(output.status.code(), Some(1));
    assert_eq!(
        err(&output),
        format!(
            "error: 3 of 4 runs failed\n  help: the column `outcome` of {} says why\n",
            place.path("case.sweep.csv")
        )
    );
    let table = table(&place.folder.join("case.sweep.csv"));
    let outcomes = table.column("outcome");
    for (outcome, part) in outcomes.iter().zip([
        "`block.botom` has no points",
        "`block.botom` has no points",
        "is free to move as a rigid body",
        "done",
    ]) {
        assert!(outcome.contains(part), "{part} in {outcome}");
    }
    assert!(outcomes[0].contains("case.toml"), "{}", outcomes[0]);
    assert_eq!(table.column("increments"), ["", "", "0", "2"]);
    assert_eq!(place.effort().column("factorisations")[..2], ["", ""]);
    let height = table.column("corner.U2");
    assert_eq!(height, ["", "", "", "-1e-5"]);
    // inline tables are one value each, and survive as text
    assert_eq!(
        table.column("support.top")[1],
        r#"{set="block.top",x=0.0,y=-1e-5}"#
    );
}

#[test]
fn a_mistake_in_the_last_value_is_found_before_the_first_run() {
    let place = Place::new("mistakes");
    let young = "material.steel.isotropic.young=210e9,-1";
    let refused: [(&[&str], &[&str]); 6] = [
        (
            &["--set", &format!("{MU}=0.1,0.2"), "--set", young],
            &[
                "material.steel.isotropic.young: young = -1",
                "mistakes/case.toml",
                &format!("in run 2 of 4: {MU}=0.1, {young}").replace("210e9,", ""),
            ],
        ),
        (
            &["--set", "interface.base.friction.coulomb.mue=0.1,0.2"],
            &["unknown key `mue`", "did you mean `mu`?"],
        ),
        (
            &["--set", &format!("{MU}=0.1,0,2x")],
            &["`2x` is not a TOML value"],
        ),
        (
            &["--set", &format!("{MU}=0.1..0.5")],
            &["range `0.1..0.5`: it does not say how many values", "help:"],
        ),
        (
            &["--set", &format!("{MU}=0.1"), "--fix", &format!("{MU}=1")],
            &["is given twice"],
        ),
        (
            &["--zip", "--set", "a=1,2", "--set", "b=1,2,3"],
            &["--zip: `a` has 2 values, `b` has 3", "--fix sets one value"],
        ),
    ];
    for (arguments, parts) in refused {
        let output = place.sweep(arguments);
        assert_eq!(output.status.code(), Some(1), "{arguments:?}");
        for part in parts {
            assert!(err(&output).contains(part), "{part} in\n{}", err(&output));
        }
        assert!(!place.exists("case.sweep.csv"), "{arguments:?}");
    }
    // what is wrong in the file itself has its line, and is said once
    place.write_case(&CASE.replace("young", "yuong"));
    let output = place.sweep(&["--set", &format!("{MU}=0.1,0.2")]);
    assert_eq!(output.status.code(), Some(1));
    let message = err(&output);
    assert!(message.contains("case.toml:4:") && !message.contains("in run"));
    assert_eq!(message.matches("yuong").count(), 3, "{message}");
    place.write_case(CASE);
    // without an axis
    assert_eq!(place.sweep(&[]).status.code(), Some(1));
    // a folder that is not there, before the first run
    let nowhere = place.path("nowhere/a.csv");
    let output = place.sweep(&["--set", &format!("{MU}=1"), "-o", &nowhere]);
    assert_eq!(output.status.code(), Some(1));
    assert!(err(&output).contains("a.csv") && err(&output).lines().count() == 1);
    assert!(!place.exists("nowhere"));
}

#[test]
fn ranges_reach_the_problem_and_axes_run_side_by_side() {
    let place = Place::new("zip");
    let table = place.table(
        &[
            "--zip",
            "--set",
            "support.top.y=-1e-5..-3e-5:3",
            "--set",
            "step.1.increments.fixed=1..3:3",
            "--set",
            "body.block.generate.rectangle.cells=[4,2],[2,1],[6,3]",
            "-q",
        ],
        0,
    );
    assert_eq!(table.column("increments"), ["1", "2", "3"]);
    assert_eq!(
        table.column("body.block.generate.rectangle.cells"),
        ["[4,2]", "[2,1]", "[6,3]"]
    );
    let heights = table.numbers("support.top.y");
    assert_eq!((heights[0], heights[2]), (-1e-5, -3e-5));
    assert_eq!(table.numbers("corner.U2"), heights);
    // more cells at the interface, more points
    let statuses = ["OPEN", "STICK", "SLIP"].map(|name| table.numbers(name));
    let points = (0..3).map(|run| statuses.iter().map(|s| s[run]).sum());
    assert_eq!(points.collect::<Vec<f64>>(), [5.0, 3.0, 7.0]);
}

#[test]
fn columns_can_be_chosen_and_unknown_ones_are_refused() {
    let place = Place::new("columns");
    let set = format!("{MU}=0.1,0.2,0.3");
    let chosen = ["--column", "corner.U2", "--column", "base.CFN2", "-q"];
    let table = place.table(&[&["--set", &set][..], &chosen].concat(), 0);
    assert_eq!(table.names[6..], ["corner.U2", "base.CFN2"]);
    assert!(table.numbers("base.CFN2").iter().all(|&f| f > 0.0));
    let output = place.sweep(&["--set", &set, "--column", "base.CNF2"]);
    assert_eq!(output.status.code(), Some(1));
    let err = err(&output);
    assert!(err.contains("there is no column `base.CNF2`"), "{err}");
    assert!(err.contains("near: base.CFN2, "), "{err}");
    assert!(!err.contains("1/3"), "{err}");
    // the table of the sweep before is untouched
    assert_eq!(
        self::table(&place.folder.join("case.sweep.csv")).rows.len(),
        3
    );
}

#[test]
fn results_of_the_runs_are_kept_on_request_and_do_not_depend_on_threads() {
    let place = Place::new("results");
    let set = format!("{MU}=0.1,0.2");
    let mut tables = Vec::new();
    for threads in ["1", "3"] {
        let (file, folder) = (place.path(threads) + ".csv", place.path(threads));
        let output = place.sweep(&[
            "--set",
            &set,
            "-o",
            &file,
            "--results",
            &folder,
            "--threads",
            threads,
            "-q",
        ]);
        assert_eq!(output.status.code(), Some(0), "{}", err(&output));
        assert!(output.stderr.is_empty());
        for run in ["0001", "0002"] {
            for name in ["history.csv", "summary.json", "fields.pvd"] {
                assert!(place.exists(&format!("{threads}/{run}/{name}")));
            }
        }
        tables.push(table(Path::new(&file)).rows);
    }
    assert_eq!(tables[0], tables[1]);
    assert!(!place.exists("case.sweep.csv") && !place.exists("1/0003"));
}

#[test]
fn the_table_is_complete_while_the_sweep_goes_on_and_after_it_was_killed() {
    let place = Place::new("killed");
    let set = "support.top.y=-1e-5..-2e-5:20000";
    let mut child = place
        .command("sweep", &["--set", set, "-q", "--threads=1"])
        .stderr(Stdio::null())
        .spawn()
        .expect("the binary runs");
    let path = place.folder.join("case.sweep.csv");
    let mut seen = 0;
    let mut grown = 0;
    // Every look finds whole rows; after some have come, the process ends in the middle of whatever it does.
    while grown < 5 && child.try_wait().expect("a state").is_none() {
        if path.exists() {
            let rows = table(&path).rows.len();
            assert!(rows >= seen);
            grown += usize::from(rows > seen);
            seen = rows;
        }
        std::thread::sleep(Duration::from_millis(1));
    }
    child.kill().expect("it still runs");
    child.wait().expect("it ends");
    let table = table(&path);
    assert!(grown == 5 && (seen..20000).contains(&table.rows.len()));
    assert!(table.column("outcome").iter().all(|&o| o == "done"));
    assert_eq!(table.numbers("corner.U2"), table.numbers("support.top.y"));
}

#[test]
fn help_tells_how_values_are_written() {
    let output = Command::new(env!("CARGO_BIN_EXE_stickslip"))
        .args(["sweep", "--help"])
        .output()
        .expect("the binary runs");
    assert_eq!(output.status.code(), Some(0));
    let text = String::from_utf8_lossy(&output.stdout);
    for part in [
        "--set <PATH=V1,V2,...>",
        "--fix <PATH=VALUE>",
        "--zip",
        "--column <NAME>",
        "--results <DIR>",
        "--shard <I/N>",
        "--merge <DIR>...",
        "from..to:count",
        "checked before the first run",
    ] {
        assert!(text.contains(part), "{part} in\n{text}");
    }
}

#[test]
fn a_sweep_that_is_complete_runs_nothing_and_one_that_lacks_rows_is_refused() {
    let place = Place::new("goes-on");
    let sweep = ["--resume", "-q", "--set", "support.top.y=-1e-5,-2e-5,-3e-5"];
    let path = place.folder.join("case.sweep.csv");
    let whole = place.table(&sweep, 0);
    assert_eq!(whole.rows.len(), 3);
    let before = std::fs::read_to_string(&path).expect("a table");
    // Complete: nothing is run, the times in it are what they were.
    place.table(&sweep, 0);
    assert_eq!(std::fs::read_to_string(&path).expect("a table"), before);
    // A row is missing, and nobody knows of which problem the others are.
    let lines: Vec<&str> = before.lines().collect();
    std::fs::write(&path, lines[..3].join("\n") + "\n").expect("a file");
    let refused = place.sweep(&sweep);
    assert_eq!(refused.status.code(), Some(1));
    let said = err(&refused);
    assert!(
        said.contains("rows are missing, and nothing beside this table says"),
        "{said}"
    );
}

const BELT: &str = r#"
format = 1
model.space = "plane-strain"
body.block = { rigid = true, generate.rectangle = { from = [-0.5, 0], to = [0.5, 0.1], cells = [2, 2] }, material = "any" }
material.any.isotropic = { young = 1e6, poisson = 0.0, density = 10.0 }
set.centre = { of = "block", point = [0, 0.05] }
obstacle.belt.plane = { point = [0, 0], normal = [0, 1] }
interface.rub = { secondary = "block.bottom", primary = "belt", friction.exponential-decay = { static = 0.5, kinetic = 0.3, decay = 10 }, primary-velocity = [1, 0] }
load.press = { set = "centre", nodal-force = { value = [0, -10] } }
coupling.k.spring = { stiffness = 100.0, terms = [{ set = "centre", component = "x" }] }
coupling.d.dashpot = { coefficient = 2.0, terms = [{ set = "centre", component = "x" }] }
support.guide = { set = "block", hold = ["y"] }
[[step]]
supports = []
steady = {}
[[step]]
complex-modes = { count = 1 }
"#;

/// A mass on a belt whose friction falls with speed, and a dashpot: below a speed of 0.1 ln 10 it does not slide steadily.
#[test]
fn the_speed_at_which_sliding_becomes_unstable_is_found_between_runs() {
    let place = Place::new("critical");
    place.write_case(BELT);
    let axis = "interface.rub.primary-velocity.1=0.1..0.4:4";
    let asked = [
        "--set",
        axis,
        "--critical",
        "MODES.GROWTH",
        "--column",
        "MODES.GROWTH",
    ];
    let output = place.sweep(&asked);
    assert_eq!(output.status.code(), Some(0), "{}", err(&output));
    assert!(
        err(&output).contains("goes through zero"),
        "{}",
        err(&output)
    );
    let read = |name: &str| csv::read(&place.folder.join(name)).expect("a table");
    assert_eq!(read("case.sweep.csv").rows(), 4);
    let critical = read("case.sweep.critical.csv");
    assert_eq!(critical.rows(), 1);
    let hopf = 0.1 * 10.0_f64.ln();
    let found = critical.columns[0][0];
    assert!((found - hopf).abs() < 1e-7, "{found} is not {hopf}");
    let unknown = place.sweep(&["--set", axis, "--critical", "GROWTH"]);
    assert_eq!(unknown.status.code(), Some(1));
    assert!(
        err(&unknown).contains("no run has a column"),
        "{}",
        err(&unknown)
    );
}

/// The same with two loads: falling friction is as strong as the load, and the boundary of stability is at 0.1 ln 10 and 0.1 ln 20.
#[test]
fn a_chart_of_stability_is_drawn_of_two_axes_with_its_boundary() {
    let place = Place::new("stability");
    place.write_case(BELT);
    let axes = [
        "load.press.nodal-force.value.2=-10,-20",
        "interface.rub.primary-velocity.1=0.1..0.4:4",
    ];
    let output = place.sweep(&[
        "--set",
        axes[0],
        "--set",
        axes[1],
        "--critical",
        "MODES.GROWTH",
    ]);
    assert_eq!(output.status.code(), Some(0), "{}", err(&output));
    let read = |name: &str| csv::read(&place.folder.join(name)).expect("a table");
    let critical = read("case.sweep.critical.csv");
    let speed = critical
        .column("interface.rub.primary-velocity.1")
        .expect("the axis");
    for (found, load) in speed.iter().zip([10.0_f64, 20.0]) {
        assert!((found - 0.1 * load.ln()).abs() < 1e-7, "{found}");
    }
    let table = read("case.sweep.csv");
    let of_mode = table
        .column("MODES.1.GROWTH")
        .expect("a column of the mode");
    let fastest = table.column("MODES.GROWTH").expect("a column");
    assert_eq!(of_mode, fastest);
    let frequency = table
        .column("MODES.1.FREQUENCY")
        .expect("a column of the mode");
    assert!(
        frequency.iter().all(|f| (1.0..1.6).contains(f)),
        "{frequency:?}"
    );
    let plot = |arguments: &[&str]| {
        let output = std::process::Command::new(env!("CARGO_BIN_EXE_stickslip"))
            .args(["plot", "case.sweep.csv"])
            .args(arguments)
            .current_dir(&place.folder)
            .output()
            .expect("the command");
        assert_eq!(output.status.code(), Some(0), "{}", err(&output));
    };
    plot(&[
        "--stability",
        "primary-velocity.1,value.2",
        "-o",
        "chart.svg",
    ]);
    plot(&["--coupling", "primary-velocity.1", "-o", "modes.svg"]);
    for name in ["chart.svg", "modes.frequency.svg", "modes.growth.svg"] {
        let picture = std::fs::read_to_string(place.folder.join(name)).expect("a picture");
        assert!(
            picture.starts_with("<svg") || picture.contains("<svg"),
            "{name}"
        );
    }
}
