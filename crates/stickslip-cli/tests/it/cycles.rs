//! Runs over cycles that are killed: `cycles.csv` and what else is in the folder are those of a run that never stopped.

use std::path::{Path, PathBuf};
use std::process::Stdio;
use std::time::Duration;

use crate::support::{self, code, command, text};

/// A punch that is driven back and forth on a layer; both wear.
const CASE: &str = r#"format = 1
model.space = "plane-strain"
body.layer = { generate.rectangle = { from = [-1, 0], to = [2, 1], cells = [24, 4] }, material = "soft" }
body.punch = { generate.rectangle = { from = [0, 1], to = [1, 1.5], cells = [10, 3] }, material = "soft" }
material.soft.isotropic = { young = 1.0, poisson = 0.3 }
support.ground = { set = "layer.bottom", x = 0.0, y = 0.0 }
support.drive = { set = "punch.top", x = 0.02, amplitude = "triangle" }
load.press = { set = "punch.top", pressure.value = 1e-3 }
amplitude.triangle.table = [[1, 0], [1.25, 1], [1.75, -1], [2, 0]]
step = [{ name = "press", increments = { fixed = 1 } }, { name = "fret", cycles = { count = 120, jump = JUMP }, increments = { fixed = 4 } }]
output = { every = 30, checkpoint = { increments = 7 }, fatigue.criteria = [{ findley = { k = 0.3 } }, { ruiz = {} }] }
[interface.joint]
secondary = "punch.bottom"
primary = "layer.top"
friction.coulomb = { mu = 0.3 }
wear.archard = { coefficient = 0.05, primary-coefficient = 0.02 }
"#;

/// Files of a folder by name, but for checkpoints and what a summary says of the process.
fn files(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let mut all = Vec::new();
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        if path.is_dir() {
            all.extend(files(&path));
        } else if !name.starts_with("checkpoint_") && name != "summary.json" {
            all.push((path.clone(), std::fs::read(&path).expect("a file")));
        }
    }
    all.sort();
    all
}

fn below(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let inside = |path: PathBuf| path.strip_prefix(folder).map(PathBuf::from);
    let all = files(folder).into_iter();
    all.map(|(path, bytes)| (inside(path).expect("below"), bytes))
        .collect()
}

fn rows(folder: &Path) -> usize {
    let table = std::fs::read_to_string(folder.join("cycles.csv"));
    table.unwrap_or_default().lines().count()
}

fn kept(folder: &Path) -> bool {
    let mut entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    entries.any(|e| e.file_name().to_string_lossy().starts_with("checkpoint_"))
}

fn run(folder: &Path, words: &[&str]) {
    let output = command(folder).args(words).output();
    let output = output.expect("the binary runs");
    let said = text(&output.stdout) + &text(&output.stderr);
    assert_eq!(code(&output), Some(0), "{said}");
}

#[test]
fn a_run_over_cycles_that_was_killed_leaves_the_same_table_of_cycles() {
    for (name, jump) in [("fixed", "2"), ("chosen", "{ error = 0.002 }")] {
        let folder = support::place("cycles", name, &CASE.replace("JUMP", jump));
        run(&folder, &["run", "case.toml", "-q", "-o", "whole"]);
        let wanted = below(&folder.join("whole"));
        let head = rows(&folder.join("whole"));
        assert!(head > 12, "{name}: {head}");
        let out = folder.join("killed");
        for after in [4, 9] {
            let mut again = command(&folder);
            match after {
                4 => again.args(["run", "case.toml", "-q", "-o", "killed"]),
                _ => again.args(["resume", "killed", "-q"]),
            };
            let child = again.stdout(Stdio::null()).stderr(Stdio::null()).spawn();
            let mut child = child.expect("the binary runs");
            // Without a checkpoint there would be nothing to go on from.
            let early = || rows(&out) < after || !kept(&out);
            while early() && child.try_wait().expect("it can be asked").is_none() {
                std::thread::sleep(Duration::from_millis(1));
            }
            let _ = child.kill();
            child.wait().expect("it ends");
        }
        run(&folder, &["resume", "killed", "-q"]);
        let found = below(&out);
        let names = |all: &[(PathBuf, Vec<u8>)]| -> Vec<PathBuf> {
            all.iter().map(|(path, _)| path.clone()).collect()
        };
        assert_eq!(names(&found), names(&wanted), "{name}");
        for ((path, a), (_, b)) in found.iter().zip(&wanted) {
            assert!(a == b, "{name}: {}", path.display());
        }
        let table = String::from_utf8_lossy(
            &wanted
                .iter()
                .find(|(p, _)| p.ends_with("cycles.csv"))
                .expect("a table")
                .1,
        )
        .into_owned();
        assert!(table.lines().next().expect("a head").ends_with("FINDLEY,FINDLEY.X1,FINDLEY.X2,FINDLEY.N1,FINDLEY.N2,RUIZ,RUIZ.X1,RUIZ.X2,RUIZ.N1,RUIZ.N2"), "{table}");
    }
}
