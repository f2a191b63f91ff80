//! Sweeps in parts: by processes that stand for machines, killed and gone on with, merged to what one process makes.

use crate::support::{self, CASE, command, text};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::{Child, Output, Stdio};
use std::time::Duration;

/// Eight runs with two bodies; of one surface there are no points, and increments are enough to be killed between.
const SET: [&str; 6] = [
    "--set",
    "body.block.generate.rectangle.cells=[48,24],[60,20]",
    "--set",
    "interface.base.secondary=block.bottom,block.botom",
    "--set",
    "interface.base.friction.coulomb.mu=0.1,0.3",
];
const RUNS: usize = 8;

fn place(name: &str) -> PathBuf {
    let case = CASE.replace("fixed = 2", "fixed = 30");
    let case = case.replace("x = 0.0, y = -1e-5", "x = 2e-6, y = -1e-5");
    support::place("shards", name, &case)
}

fn sweep(folder: &Path, arguments: &[&str]) -> Output {
    let mut sweep = command(folder);
    sweep.arg("sweep").args(arguments);
    sweep.output().expect("the binary runs")
}

/// A shard of the eight runs, with results and a cache.
fn shard(folder: &Path, part: &str) -> Child {
    let mut sweep = command(folder);
    sweep.args(["sweep", "case.toml", "--threads=1"]).args(SET);
    sweep.args(["--results", "runs", "--cache", "factors", "--shard", part]);
    sweep.stdout(Stdio::null()).stderr(Stdio::piped());
    sweep.spawn().expect("the binary runs")
}

/// What a command says that has to end with 1.
fn refused(folder: &Path, arguments: &[&str]) -> String {
    let output = sweep(folder, arguments);
    assert_eq!(output.status.code(), Some(1), "{}", text(&output.stderr));
    text(&output.stderr)
}

/// The names of all files under a folder, while others may be at work in it.
fn files(folder: &Path) -> BTreeSet<PathBuf> {
    let mut all = BTreeSet::new();
    let mut open = vec![folder.to_path_buf()];
    while let Some(next) = open.pop() {
        for entry in std::fs::read_dir(&next).into_iter().flatten().flatten() {
            let path = entry.path();
            if path.is_dir() {
                open.push(path);
            } else {
                all.insert(path.strip_prefix(folder).expect("a name").to_path_buf());
            }
        }
    }
    all
}

/// All files under a folder, with what is in them.
fn tree(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let read = |name: PathBuf| {
        let bytes = std::fs::read(folder.join(&name)).expect("a file");
        (name, bytes)
    };
    files(folder).into_iter().map(read).collect()
}

fn names(folder: &Path, ends: &str) -> Vec<PathBuf> {
    let all = files(folder).into_iter();
    all.filter(|name| name.to_string_lossy().ends_with(ends))
        .collect()
}

/// The eight runs in one process, in `one.csv` and `one`.
fn whole(folder: &Path) {
    let arguments = ["case.toml", "-q", "-o", "one.csv", "--results", "one"];
    let output = sweep(folder, &[&arguments[..], &SET].concat());
    assert_eq!(output.status.code(), Some(1), "{}", text(&output.stderr));
    assert!(text(&output.stderr).contains("4 of 8 runs failed"));
}

fn assert_merged(folder: &Path) {
    let merge = ["--merge", "case.sweep.shards", "--results", "runs", "-q"];
    let said = refused(folder, &merge);
    assert!(said.contains("4 of 8 runs failed"), "{said}");
    let read = |name: &str| std::fs::read(folder.join(name)).expect("a table");
    assert!(read("case.sweep.csv") == read("one.csv"));
    let (merged, one) = (tree(&folder.join("runs")), tree(&folder.join("one")));
    assert!(one.len() > 4 * 4, "{:?}", one.keys());
    assert!(
        merged.keys().eq(one.keys()),
        "{:?}\n{:?}",
        merged.keys(),
        one.keys()
    );
    for (name, bytes) in &one {
        assert!(merged[name] == *bytes, "{} differs", name.display());
    }
    for left in [".tmp", ".lock", ".lease"] {
        assert_eq!(names(folder, left), Vec::<PathBuf>::new());
    }
}

/// The column of the table of what runs took.
fn factorisations(folder: &Path) -> usize {
    let table = std::fs::read_to_string(folder.join("case.sweep.effort.csv")).expect("a table");
    let mut lines = table.lines();
    let heads = lines.next().expect("a head").split(',');
    let at = heads
        .clone()
        .position(|head| head == "factorisations")
        .expect("a column");
    assert_eq!(lines.clone().count(), RUNS);
    let counts = lines.map(|line| {
        line.split(',')
            .nth(at)
            .expect("a cell")
            .parse()
            .unwrap_or(0)
    });
    counts.sum()
}

#[test]
fn parts_side_by_side_make_what_one_process_makes_and_factor_every_body_once() {
    let folder = place("beside");
    whole(&folder);
    let all: Vec<Child> = ["1/3", "2/3", "3/3"]
        .map(|part| shard(&folder, part))
        .into();
    for one in all {
        let output = one.wait_with_output().expect("it ends");
        assert_eq!(output.status.code(), Some(1), "{}", text(&output.stderr));
    }
    assert_merged(&folder);
    assert_eq!(factorisations(&folder), 2);
    // Over, each has nothing left to do; nor has one that is called in another order.
    let before = tree(&folder.join("case.sweep.shards"));
    let output = shard(&folder, "2/3").wait_with_output().expect("it ends");
    assert!(text(&output.stderr).contains("3 runs in case.sweep.shards/2-of-3 already"));
    assert!(tree(&folder.join("case.sweep.shards")) == before);
}

/// The files of the runs of a part that are over.
fn done(folder: &Path, part: &str) -> BTreeMap<PathBuf, Vec<u8>> {
    let shard = folder
        .join("case.sweep.shards")
        .join(part.replace('/', "-of-"));
    let all = names(&shard, ".json").into_iter();
    // One that is written has another name until then.
    let own = all.filter(|name| name.to_string_lossy().starts_with('0'));
    own.map(|name| {
        (
            name.clone(),
            std::fs::read(shard.join(name)).expect("a file"),
        )
    })
    .collect()
}

/// When a shard is killed.
enum Moment {
    /// Right away.
    Soon,
    /// As soon as another file has come whose name ends so.
    File(&'static str),
    /// When so many runs are over.
    Runs(usize),
}

#[test]
fn a_shard_that_is_killed_goes_on_where_it_was() {
    let folder = place("killed");
    whole(&folder);
    let moments = [
        ("1/3", Moment::Soon),
        ("1/3", Moment::File(".lease")),
        ("2/3", Moment::File(".lock")),
        ("1/3", Moment::File("history.csv")),
        ("1/3", Moment::Runs(1)),
        ("2/3", Moment::Runs(2)),
        ("3/3", Moment::File(".vtu")),
        ("3/3", Moment::Runs(1)),
    ];
    for (part, moment) in moments {
        let done = || done(&folder, part);
        let (before, known) = (done(), files(&folder));
        let mut child = shard(&folder, part);
        let come = || match moment {
            Moment::Soon => true,
            Moment::File(ends) => names(&folder, ends)
                .iter()
                .any(|name| !known.contains(name)),
            Moment::Runs(count) => done().len() >= count,
        };
        // It may be over before; then there is nothing to kill, and that is as good.
        while !come() && child.try_wait().expect("a state").is_none() {
            std::thread::sleep(Duration::from_millis(1));
        }
        let _ = child.kill();
        child.wait().expect("it ends");
        // What was done stays, and is not done again.
        let after = done();
        assert!(before.iter().all(|(name, bytes)| after[name] == *bytes));
    }
    // One that was cut in the middle of a file.
    let cut = folder.join("case.sweep.shards/3-of-3/.0006.json.1.tmp");
    std::fs::write(cut, "{\"run\": 6, \"val").expect("a file");
    let before = done(&folder, "3/3");
    for part in ["3/3", "1/3", "2/3"] {
        let output = shard(&folder, part).wait_with_output().expect("it ends");
        assert_eq!(output.status.code(), Some(1), "{}", text(&output.stderr));
    }
    let after = done(&folder, "3/3");
    assert!(before.iter().all(|(name, bytes)| after[name] == *bytes));
    assert_merged(&folder);
    assert!(factorisations(&folder) <= 2);
}

const MU: [&str; 2] = [
    "--set",
    "interface.base.friction.coulomb.mu=0.1,0.2,0.3,0.4,0.5",
];

/// Parts of a sweep of five runs.
fn parts(folder: &Path, table: &str, parts: &[&str]) {
    for part in parts {
        let arguments = ["case.toml", "-q", "-o", table, "--shard", part];
        let output = sweep(folder, &[&arguments[..], &MU].concat());
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    }
}

#[test]
fn what_cannot_be_merged_is_refused_with_its_reason() {
    let folder = support::place("shards", "refused", CASE);
    parts(&folder, "t.csv", &["1/2"]);
    let merge = |folders: &[&str]| refused(&folder, &[&["--merge"], folders].concat());
    assert_eq!(
        merge(&["t.shards"]),
        "error: 2 of 5 runs are missing: runs 2, 4\n  help: runs 2, 4 would be in shards that are not named: 2/2\n"
    );
    parts(&folder, "t.csv", &["2/2"]);
    // A shard that has not come to its end.
    let run = folder.join("t.shards/2-of-2/0002.json");
    let whole = std::fs::read_to_string(&run).expect("a run");
    std::fs::write(&run, whole.replace("done", "gone")).expect("a file");
    let said = merge(&["t.shards"]);
    assert!(
        said.contains("0002.json: this is no run of this shard"),
        "{said}"
    );
    std::fs::remove_file(&run).expect("a file");
    let said = merge(&["t.shards"]);
    assert!(said.contains("1 of 5 runs are missing: run "), "{said}");
    assert!(
        said.contains("shard 2/2 in t.shards/2-of-2 lacks run "),
        "{said}"
    );
    assert!(
        said.contains(": it goes on with the command that began it"),
        "{said}"
    );
    parts(&folder, "t.csv", &["2/2"]);
    // A copy, and another division.
    std::fs::create_dir(folder.join("copy")).expect("a folder");
    for name in ["shard.json", "0002.json", "0004.json"] {
        let from = folder.join("t.shards/2-of-2").join(name);
        std::fs::copy(from, folder.join("copy").join(name)).expect("a copy");
    }
    let said = merge(&["t.shards", "copy"]);
    assert!(
        said.contains("is in two shards: t.shards/2-of-2 and copy"),
        "{said}"
    );
    // Named twice it is one; a table has to be named where none follows from the folders.
    let output = sweep(&folder, &["--merge", "t.shards", "t.shards/1-of-2"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    assert!(text(&output.stderr).contains("5 runs of 2 shards; table in t.csv"));
    assert!(merge(&["copy", "t.shards/1-of-2"]).contains("name it: -o TABLE.csv"));
    assert!(
        refused(&folder, &["--merge", "t.shards", "-o", "case.toml"])
            .contains("an input is never written to")
    );
    assert!(
        refused(&folder, &["--merge", "t.shards", "--results", "runs"])
            .contains("these shards kept no results")
    );
    // Folders of another kind.
    std::fs::create_dir(folder.join("empty")).expect("a folder");
    std::fs::create_dir(folder.join("run")).expect("a folder");
    std::fs::write(folder.join("run/summary.json"), "{}").expect("a file");
    assert!(merge(&["empty"]).contains("empty: there is no shard of a sweep in this folder"));
    assert!(merge(&["run"]).contains("run: these are results of a run, and no shard of a sweep"));
    assert!(merge(&["nowhere"]).contains("nowhere: there is no such folder"));
    assert!(merge(&["t.csv"]).contains("t.csv: this is a file"));
    std::fs::write(folder.join("empty/shard.json"), "{}").expect("a file");
    assert!(merge(&["empty"]).contains("no record of a shard"));
}

#[test]
fn shards_of_different_sweeps_are_told_apart() {
    let folder = support::place("shards", "different", CASE);
    parts(&folder, "t.csv", &["1/2"]);
    let again = ["case.toml", "-q", "-o", "t.csv", "--shard", "1/2"];
    // Other values, in the same folder.
    let said = refused(
        &folder,
        &[&again[..], &["--set", "support.top.y=-1e-5,-2e-5"]].concat(),
    );
    assert!(said.contains("t.shards/1-of-2: this shard was begun by another sweep: its axes or their values are others"), "{said}");
    // Another problem, in the same folder and in another.
    let case = CASE.replace("210e9", "200e9");
    std::fs::write(folder.join("case.toml"), case).expect("a file");
    let said = refused(&folder, &[&again[..], &MU].concat());
    assert!(said.contains("its file case.toml is another"), "{said}");
    parts(&folder, "u.csv", &["2/2"]);
    let said = refused(&folder, &["--merge", "t.shards", "u.shards", "-o", "v.csv"]);
    assert!(said.contains("t.shards/1-of-2 and u.shards/2-of-2 are shards of different sweeps: its file case.toml is another"), "{said}");
    // Another version.
    let record = folder.join("u.shards/2-of-2/shard.json");
    let text = std::fs::read_to_string(&record).expect("a record");
    let version = format!("\"version\": \"{}\"", env!("CARGO_PKG_VERSION"));
    assert!(text.contains(&version), "{text}");
    std::fs::write(&record, text.replace(&version, "\"version\": \"99.0.0\"")).expect("a file");
    let said = refused(&folder, &["--merge", "t.shards", "u.shards", "-o", "v.csv"]);
    assert!(said.contains("it is of version 99.0.0"), "{said}");
    assert!(!folder.join("v.csv").exists());
    for (part, why) in [
        ("3/2", "there are only 2 parts"),
        ("0/2", "parts are counted from 1"),
    ] {
        let said = refused(
            &folder,
            &[&["case.toml", "--shard", part], &MU[..]].concat(),
        );
        assert!(said.contains(&format!("--shard {part}: {why}")), "{said}");
    }
}

#[test]
fn a_shard_has_one_process_at_a_time_and_that_of_the_dead_is_taken_over() {
    let folder = place("held");
    let mut first = shard(&folder, "1/2");
    let lease = folder.join("case.sweep.shards/1-of-2/shard.lease");
    while !lease.exists() && first.try_wait().expect("a state").is_none() {
        std::thread::sleep(Duration::from_millis(1));
    }
    let second = shard(&folder, "1/2").wait_with_output().expect("it ends");
    let at_it = format!("process {} on ", first.id());
    let said = text(&second.stderr);
    assert!(
        second.status.code() == Some(1) && said.contains(&at_it),
        "{said}"
    );
    assert!(said.contains("is at this shard"), "{said}");
    first.kill().expect("it goes on");
    first.wait().expect("it ends");
    assert!(lease.exists());
    let output = shard(&folder, "1/2").wait_with_output().expect("it ends");
    assert_eq!(output.status.code(), Some(1), "{}", text(&output.stderr));
    assert!(!lease.exists());
}
