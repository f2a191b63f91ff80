//! Factors made for one run serve others: what may differ between them, what may not, and what happens to damaged files.

use crate::support;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use stickslip::newton::Statistics;
use stickslip::newton::condensed::Library;
use stickslip::run::Simulation;

/// A stack of four blocks; nothing but contact holds the two in the middle.
const CASE: &str = r#"
format = 1
model.space = "plane-strain"

[body.lower]
generate.rectangle = { from = [0, -0.01], to = [0.03, 0], cells = [6, 3] }
material = "steel"

[body.first]
generate.rectangle = { from = [0.005, 0], to = [0.025, 0.01], cells = [5, 3] }
material = "steel"

[body.second]
generate.rectangle = { from = [0.007, 0.01], to = [0.023, 0.02], cells = [3, 2] }
material = "steel"

[body.upper]
generate.rectangle = { from = [0.008, 0.02], to = [0.022, 0.03], cells = [4, 3] }
material = "tool"

[material.steel.isotropic]
young = 210e9
poisson = 0.3
density = 7800

[material.tool.isotropic]
young = 300e9
poisson = 0.25
density = 7800

[interface.low]
secondary = "first.bottom"
primary = "lower.top"
friction.coulomb = { mu = 0.3 }

[interface.middle]
secondary = "second.bottom"
primary = "first.top"
roles = "as-named"
friction.coulomb = { mu = 0.3 }

[interface.high]
secondary = "upper.bottom"
primary = "second.top"
friction.coulomb = { mu = 0.3 }

[support.base]
set = "lower.bottom"
x = 0
y = 0

[support.top]
set = "upper.top"
x = 1e-6
y = -4e-6

[probe.corner]
of = "first"
point = [0.005, 0.01]

[solver]
method = "condensed"

[[step]]
increments.fixed = 3
"#;

/// What a run gives, by its bits, and what it took.
struct Run {
    rows: Vec<Vec<u64>>,
    statistics: Statistics,
    notes: Vec<String>,
}

impl Run {
    /// Substructures made, shared and read.
    fn counts(&self) -> [usize; 3] {
        let s = &self.statistics;
        assert_eq!(s.factorisations, s.substructures.made);
        [
            s.substructures.made,
            s.substructures.shared,
            s.substructures.read,
        ]
    }
}

fn run(text: &str, library: &Arc<Library>) -> Run {
    let model = support::problem(text)
        .build(Path::new("."))
        .unwrap_or_else(|e| panic!("{e}"));
    let mut simulation =
        Simulation::with_library(model, Arc::clone(library)).unwrap_or_else(|e| panic!("{e}"));
    let mut record = support::Record::default();
    simulation
        .run(&mut [&mut record])
        .unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(simulation.summary.solved_by.method, "condensed");
    let rows = record.increments.iter();
    Run {
        rows: rows
            .map(|(_, row)| row.values.iter().map(|v| v.to_bits()).collect())
            .collect(),
        statistics: simulation.summary.cost.solver,
        notes: (simulation.summary.notes.iter())
            .filter(|note| !note.starts_with("condensed:"))
            .cloned()
            .collect(),
    }
}

fn in_memory() -> Arc<Library> {
    Arc::new(Library::new(Library::usual_limit()))
}

fn changed(from: &str, to: &str) -> String {
    assert!(CASE.contains(from), "{from}");
    CASE.replace(from, to)
}

#[test]
fn what_is_the_same_is_factored_once() {
    let library = in_memory();
    let first = run(CASE, &library);
    assert_eq!(first.counts(), [4, 0, 0]);
    assert_eq!(first.statistics.analyses, 4);
    for text in [
        CASE.to_string(),
        changed("mu = 0.3", "mu = 0.2"),
        changed(
            "friction.coulomb = { mu = 0.3 }",
            "friction.coulomb = { mu = 0.3 }\nenforcement.penalty = { stiffness = 1e14, tangential-stiffness = 1e13 }",
        ),
        changed("y = -4e-6", "y = -3e-6"),
        changed("increments.fixed = 3", "increments.fixed = 2\nduration = 2"),
        changed(
            "increments.fixed = 3",
            "increments.fixed = 2\n[[step]]\nincrements.fixed = 2",
        ),
    ] {
        let again = run(&text, &library);
        assert_eq!(again.counts(), [0, 4, 0], "{text}");
        assert_eq!(again.statistics.analyses, 0);
        let alone = run(&text, &in_memory());
        assert_eq!(alone.counts(), [4, 0, 0]);
        assert!(again.rows == alone.rows, "{text}");
        assert!(!again.rows.is_empty());
    }
}

#[test]
fn what_is_not_the_same_is_factored_again() {
    let library = in_memory();
    run(CASE, &library);
    for (text, made, analysed) in [
        // Other values, the same pattern.
        (changed("poisson = 0.25", "poisson = 0.26"), 1, 0),
        (changed("young = 300e9", "young = 301e9"), 1, 0),
        (changed("to = [0.022, 0.03]", "to = [0.0221, 0.03]"), 1, 0),
        // The same mesh and material.
        (
            changed(
                "material = \"tool\"",
                "material = \"tool\"\nformulation = \"mean-dilatation\"",
            ),
            1,
            0,
        ),
        (
            changed("\"plane-strain\"", "\"plane-strain\"\nmodel.thickness = 2"),
            4,
            0,
        ),
        (
            changed(
                "[support.top]",
                "[load.held]\nset = \"second.right\"\nspring.stiffness = [1e8, 1e8]\n\n[support.top]",
            ),
            1,
            0,
        ),
        // Other unknowns or points.
        (changed("x = 1e-6\n", ""), 1, 1),
        (
            changed("set = \"upper.top\"", "set = \"upper.right\""),
            1,
            1,
        ),
        (changed("cells = [4, 3]", "cells = [4, 2]"), 1, 1),
    ] {
        let other = run(&text, &library);
        assert_eq!(other.counts(), [made, 4 - made, 0], "{text}");
        assert_eq!(other.statistics.analyses, analysed, "{text}");
        let alone = run(&text, &in_memory());
        assert!(other.rows == alone.rows, "{text}");
    }
}

#[test]
fn increments_in_motion_share_as_far_as_they_are_as_long() {
    let moving = |increments: usize| {
        let step = "increments.fixed = 3";
        let motion = format!("duration = 6e-6\nincrements.fixed = {increments}\ndynamic = {{}}");
        changed(step, &motion)
    };
    let library = in_memory();
    let first = run(&moving(3), &library);
    let [made, ..] = first.counts();
    assert!(made >= 4);
    let text = moving(3).replace("mu = 0.3", "mu = 0.1");
    let again = run(&text, &library);
    assert_eq!(again.counts()[0], 0);
    assert!(again.rows == run(&text, &in_memory()).rows);
    let other = run(&moving(2), &library);
    assert!(other.counts()[0] >= 4);
    assert_eq!(other.statistics.analyses, 0);
}

#[test]
fn a_library_without_room_shares_nothing_and_does_no_harm() {
    let library = Arc::new(Library::new(0));
    let first = run(CASE, &library);
    let again = run(CASE, &library);
    assert_eq!([first.counts(), again.counts()], [[4, 0, 0]; 2]);
    assert!(first.rows == again.rows);
}

fn on_disk(folder: &Path) -> Arc<Library> {
    let library = Library::in_directory(Library::usual_limit(), folder);
    Arc::new(library.unwrap_or_else(|e| panic!("{e}")))
}

fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).expect("a folder of files");
    let mut paths: Vec<PathBuf> = entries.map(|e| e.expect("an entry").path()).collect();
    paths.sort();
    paths
}

#[test]
fn another_process_finds_what_was_factored() {
    let folder = support::folder("library-disk").join("new/cache");
    let first = run(CASE, &on_disk(&folder));
    assert_eq!(first.counts(), [4, 0, 0]);
    assert_eq!(files(&folder).len(), 4);
    let library = on_disk(&folder);
    let again = run(CASE, &library);
    assert_eq!(again.counts(), [0, 0, 4]);
    assert_eq!(again.statistics.analyses, 0);
    assert!(again.rows == first.rows);
    // From now on it is in memory.
    assert_eq!(run(CASE, &library).counts(), [0, 4, 0]);
    let text = changed("mu = 0.3", "mu = 0.1");
    let other = run(&text, &on_disk(&folder));
    assert_eq!(other.counts(), [0, 0, 4]);
    assert!(other.rows == run(&text, &in_memory()).rows);
    let text = changed("poisson = 0.25", "poisson = 0.26");
    assert_eq!(run(&text, &on_disk(&folder)).counts(), [1, 0, 3]);
    assert_eq!(files(&folder).len(), 5);
    for run in [first, again, other] {
        assert!(run.notes.is_empty(), "{:?}", run.notes);
    }
}

#[test]
fn damaged_files_are_noticed_and_made_again() {
    let folder = support::folder("library-damage");
    let first = run(CASE, &on_disk(&folder));
    let paths = files(&folder);
    let path = &paths[1];
    let sound = std::fs::read(path).expect("a cache file");
    let n = sound.len();
    let mut wrong: Vec<(Vec<u8>, &str)> = Vec::new();
    for length in [0, 1, 20, 63, 64, 80, n / 2, n - 16, n - 1] {
        wrong.push((sound[..length].to_vec(), "length"));
    }
    for (at, why) in [
        (0, "something else"),
        (8, "another version"),
        (16, "another version"),
        (40, "for something else"),
        (56, "another length"),
        (63, "another length"),
        (64, "damaged"),
        (80, "damaged"),
        (87, "damaged"),
        (120, "damaged"),
        (150, "damaged"),
        (200, "damaged"),
        (n / 3, "damaged"),
        (n / 2, "damaged"),
        (n - 100, "damaged"),
        (n - 17, "damaged"),
        (n - 16, "damaged"),
        (n - 1, "damaged"),
    ] {
        for change in [1, 0x80] {
            let mut bytes = sound.clone();
            bytes[at] ^= change;
            wrong.push((bytes, why));
        }
    }
    wrong.push(([&sound[..], b"more"].concat(), "another length"));
    wrong.push((std::fs::read(&paths[2]).expect("a file"), "something else"));
    for (bytes, why) in wrong {
        std::fs::write(path, &bytes).expect("the folder can be written to");
        let again = run(CASE, &on_disk(&folder));
        assert_eq!(again.counts(), [1, 0, 3], "{why}");
        assert!(again.rows == first.rows, "{why}");
        assert_eq!(again.notes.len(), 1, "{:?}", again.notes);
        let note = &again.notes[0];
        let cut = note.contains("cut short") && why == "length";
        assert!(cut || note.contains(why), "{note}: {why}");
        assert!(
            note.contains(".sub") && note.ends_with("made again"),
            "{note}"
        );
        assert!(std::fs::read(path).expect("a cache file") == sound, "{why}");
        assert_eq!(files(&folder), paths, "something was left behind");
    }
}

#[test]
fn a_directory_that_cannot_be_used_is_said() {
    let folder = support::folder("library-gone");
    let inside = folder.join("cache");
    let library = on_disk(&inside);
    std::fs::remove_dir(&inside).expect("an empty folder");
    let run = run(CASE, &library);
    assert_eq!(run.counts(), [4, 0, 0]);
    assert_eq!(run.notes.len(), 4);
    assert!(
        run.notes.iter().all(|n| n.contains("not written")),
        "{:?}",
        run.notes
    );
    std::fs::write(&inside, "a file").expect("the folder can be written to");
    assert!(Library::in_directory(0, &inside).is_err());
}
