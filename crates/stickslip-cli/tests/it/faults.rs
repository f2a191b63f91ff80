//! What goes wrong around a run: full and read-only disks, folders that are taken, names that leave the folder, inputs that would be
//! overwritten, memory that runs out, runs that are killed. Nothing is lost, and each message is what it was when somebody read it last.

use crate::support::{self, CASE};
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::Duration;

use serde_json::Value;

/// A folder of its own for each test, with the case in it.
fn place(name: &str) -> PathBuf {
    support::place("faults", name, CASE)
}

fn run(folder: &Path, arguments: &[&str]) -> (Option<i32>, String) {
    said(
        support::command(folder)
            .args(arguments)
            .output()
            .expect("the binary runs"),
    )
}

/// The exit code, and what was said on standard error, with process numbers and the name of this machine left out.
fn said(output: Output) -> (Option<i32>, String) {
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    let mut out = Vec::new();
    let mut words = text.split(' ').peekable();
    while let Some(word) = words.next() {
        out.push(word.to_string());
        if word.ends_with("process") && words.peek().is_some() {
            words.next();
            out.push("N".into());
            if words.peek() == Some(&"on") {
                words.next();
                let end = words
                    .next()
                    .unwrap_or_default()
                    .trim_start_matches(|c| c != ')' && c != ';');
                out.push(format!("on HOST{end}"));
            }
        }
    }
    (output.status.code(), out.join(" "))
}

/// The lines of standard error that begin with one of these.
fn lines(text: &str, begin: &[&str]) -> String {
    let wanted = text
        .lines()
        .filter(|line| begin.iter().any(|b| line.trim_start().starts_with(b)));
    wanted.map(|line| format!("{line}\n")).collect()
}

fn summary(folder: &Path) -> Value {
    summary_of(&folder.join("case.out"))
}

fn summary_of(out: &Path) -> Value {
    let text = std::fs::read_to_string(out.join("summary.json")).expect("a summary");
    serde_json::from_str(&text).expect("a summary is JSON at any time")
}

/// All files below a folder with their contents.
fn contents(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let mut out = Vec::new();
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            out.extend(contents(&path));
        } else {
            let bytes = std::fs::read(&path).expect("a file");
            out.push((path, bytes));
        }
    }
    out.sort();
    out
}

struct Guard(Child);

impl Drop for Guard {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// A run that goes on until it is killed, under way.
fn endless(folder: &Path) -> Guard {
    let child = support::command(folder)
        .args([
            "run",
            "case.toml",
            "-q",
            "--set",
            "step.1.increments.fixed=100000000",
        ])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn();
    let guard = Guard(child.expect("the binary runs"));
    let history = folder.join("case.out/history.csv");
    for _ in 0..2000 {
        if history.exists() {
            return guard;
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    panic!("no increment in 20 s");
}

#[test]
fn names_do_not_leave_the_folder() {
    let folder = place("names");
    let before = contents(&folder);
    for (name, why) in [
        ("../../precious", "it begins or ends with a dot"),
        (
            "/tmp/absolute",
            r#"it has one of / \ < > : " | ? * or a control character"#,
        ),
        (
            "a/b",
            r#"it has one of / \ < > : " | ? * or a control character"#,
        ),
        (
            "a\\\\b",
            r#"it has one of / \ < > : " | ? * or a control character"#,
        ),
        (
            "nul\\u0000",
            r#"it has one of / \ < > : " | ? * or a control character"#,
        ),
        ("", "it is empty"),
        (" ", "it is empty"),
        (" x", "it begins or ends with a blank"),
        (&"x".repeat(300), "it has more than 100 characters"),
    ] {
        let text = CASE.replace("interface.base", &format!("interface.\"{name}\""));
        std::fs::write(folder.join("case.toml"), text).expect("a file");
        let (code, text) = run(&folder, &["run", "case.toml"]);
        assert_eq!(code, Some(1), "{name}: {text}");
        let wanted = format!("cannot be the name of an interface: {why}");
        assert!(text.contains(&wanted), "{name}: {text}");
        assert!(text.contains("case.toml:6:"), "{name}: {text}");
    }
    std::fs::write(folder.join("case.toml"), CASE).expect("a file");
    assert_eq!(contents(&folder), before);
    let twice = format!("{CASE}support.Top = {{ set = \"block.top\", x = 0.0 }}\n")
        .replace("step = [", "steps = [");
    let twice = twice.replace(
        "steps = [{ name = \"press\", increments = { fixed = 2 } }]\n",
        "",
    ) + "step = [{ name = \"press\" }]\n";
    std::fs::write(folder.join("case.toml"), twice).expect("a file");
    let (code, text) = run(&folder, &["check", "case.toml"]);
    assert_eq!(code, Some(1));
    assert!(
        text.contains("`Top` and `top` differ by nothing but capitals"),
        "{text}"
    );
}

#[test]
fn inputs_are_never_written_to() {
    let folder = place("inputs");
    std::fs::create_dir(folder.join("d")).expect("a folder");
    std::fs::copy(folder.join("case.toml"), folder.join("d/problem.toml")).expect("a file");
    std::fs::copy(folder.join("case.toml"), folder.join("x.toml")).expect("a file");
    let mesh = "*NODE\n1,0,0\n2,1,0\n3,0,1\n*ELEMENT,TYPE=CPE3\n1,1,2,3\n";
    std::fs::write(folder.join("a.inp"), mesh).expect("a file");
    let before = contents(&folder);
    let replaced = "error: d/problem.toml: the results would replace this file, from which the problem is read: choose another folder than d\n";
    for (arguments, message) in [
        (&["run", "d/problem.toml", "-o", "d"][..], replaced),
        (
            &[
                "sweep",
                "x.toml",
                "--set",
                "interface.base.friction.coulomb.mu=0.1,0.2",
                "-o",
                "./x.toml",
            ],
            "error: x.toml: an input is never written to\n",
        ),
        (
            &["convert", "a.inp", "../inputs/a.inp"],
            "error: a.inp: an input is never written to\n",
        ),
    ] {
        let (code, text) = run(&folder, arguments);
        assert_eq!(code, Some(1), "{arguments:?}: {text}");
        assert_eq!(lines(&text, &["error"]), message, "{arguments:?}");
        assert_eq!(contents(&folder), before, "{arguments:?}");
    }
}

#[test]
fn files_of_others_are_not_touched() {
    let folder = place("others");
    let out = folder.join("case.out");
    std::fs::create_dir_all(out.join("interfaces")).expect("a folder");
    std::fs::write(out.join("history.csv"), "mine\n").expect("a file");
    let (code, text) = run(&folder, &["run", "case.toml", "-q"]);
    assert_eq!(code, Some(1));
    assert_eq!(
        text.lines().next(),
        Some(
            "error: case.out/history.csv: it would be replaced, but there is no summary.json of a run beside it: choose another folder, or remove it"
        )
    );
    assert_eq!(
        std::fs::read_to_string(out.join("history.csv")).expect("a file"),
        "mine\n"
    );
    assert!(!out.join("run.lock").exists());
}

#[test]
fn what_an_older_run_left_is_gone() {
    let folder = place("older");
    // Its interface has another name than that of the later run.
    let older = CASE.replace("interface.base", "interface.gone");
    std::fs::write(folder.join("older.toml"), older).expect("a file");
    let (code, text) = run(
        &folder,
        &[
            "run",
            "older.toml",
            "-q",
            "-o",
            "case.out",
            "--set",
            "step.1.increments.fixed=5",
        ],
    );
    assert_eq!(code, Some(0), "{text}");
    let out = folder.join("case.out");
    assert!(out.join("interfaces/gone.csv").exists());
    for (name, text) in [
        ("fields_00099.vtu", "old"),
        ("interfaces/gone_00007.vtp", "old"),
        ("report.html", "old"),
        ("notes.txt", "mine"),
    ] {
        std::fs::write(out.join(name), text).expect("a file");
    }
    let (code, text) = run(
        &folder,
        &["run", "case.toml", "-q", "--set", "output.every=1"],
    );
    assert_eq!(code, Some(0), "{text}");
    let names: Vec<String> = contents(&out)
        .iter()
        .map(|(path, _)| {
            path.strip_prefix(&out)
                .expect("below")
                .display()
                .to_string()
        })
        .collect();
    let wanted = [
        "fields.pvd",
        "fields_00000.vtu",
        "fields_00001.vtu",
        "fields_00002.vtu",
        "history.csv",
        "interfaces/base.csv",
        "interfaces/base_00000.vtp",
        "interfaces/base_00001.vtp",
        "interfaces/base_00002.vtp",
        "interfaces.pvd",
        "notes.txt",
        "problem.toml",
        "summary.json",
    ];
    let wanted: Vec<&str> = match names.iter().any(|n| n == "fields_00002.vtu") {
        true => wanted.to_vec(),
        false => wanted
            .into_iter()
            .filter(|n| !n.contains("_00002.vt"))
            .collect(),
    };
    assert_eq!(names, wanted);
    assert_eq!(summary(&folder)["status"], "done");
}

#[test]
fn a_folder_belongs_to_one_run_at_a_time() {
    let folder = place("taken");
    let first = endless(&folder);
    assert_eq!(summary(&folder)["status"], "running");
    let before = std::fs::read(folder.join("case.out/run.lock")).expect("a lock");
    let (code, text) = run(&folder, &["run", "case.toml", "-q"]);
    assert_eq!(code, Some(1));
    assert_eq!(
        text.lines().next(),
        Some(
            "error: case.out: another run writes into this folder (process N on HOST): wait for it, or choose another folder; if that run is over, remove run.lock"
        )
    );
    assert_eq!(
        std::fs::read(folder.join("case.out/run.lock")).expect("a lock"),
        before
    );
    drop(first);
    // It was killed: its lock is no obstacle, and what it left is gone.
    let (code, text) = run(&folder, &["run", "case.toml"]);
    assert_eq!(code, Some(0), "{text}");
    assert_eq!(
        lines(&text, &["case.out"]),
        "case.out: the run before (process N on HOST) was killed; what it left is removed\n"
    );
    assert!(!folder.join("case.out/run.lock").exists());
}

#[test]
fn a_folder_that_is_removed_ends_the_run() {
    let folder = place("removed");
    let mut first = endless(&folder);
    // Files appear while it goes.
    while folder.join("case.out/run.lock").exists() {
        let _ = std::fs::remove_dir_all(folder.join("case.out"));
    }
    let begun = std::time::Instant::now();
    let status = loop {
        match first.0.try_wait().expect("it can be asked") {
            Some(status) => break status,
            None if begun.elapsed() > Duration::from_secs(20) => panic!("it goes on"),
            None => std::thread::sleep(Duration::from_millis(20)),
        }
    };
    assert!(matches!(status.code(), Some(1 | 3)), "{status}");
}

#[test]
fn a_table_of_a_sweep_is_written_by_one_at_a_time() {
    let folder = place("two-sweeps");
    std::fs::write(folder.join("t.csv"), "mine\n").expect("a file");
    // Whoever holds the lock writes the table.
    let held = std::fs::File::create(folder.join("t.csv.lock")).expect("a file");
    held.lock().expect("a lock");
    std::fs::write(folder.join("t.csv.lock"), "4711 elsewhere\n").expect("a file");
    let sweep = [
        "sweep",
        "case.toml",
        "-q",
        "-o",
        "t.csv",
        "--set",
        "support.top.y=-1e-5,-2e-5",
    ];
    let (code, text) = run(&folder, &sweep);
    assert_eq!(code, Some(1), "{text}");
    assert_eq!(
        text,
        "error: t.csv: process N on HOST writes this file: wait for it, or choose another; if that is over, remove t.csv.lock\n"
    );
    assert_eq!(
        std::fs::read(folder.join("t.csv")).expect("a file"),
        b"mine\n"
    );
    drop(held);
    let (code, text) = run(&folder, &sweep);
    assert_eq!(code, Some(0), "{text}");
    assert!(!folder.join("t.csv.lock").exists());
    let rows = std::fs::read_to_string(folder.join("t.csv")).expect("a file");
    assert_eq!(rows.lines().count(), 3);
}

#[test]
fn a_file_in_the_way_of_the_folder_is_told() {
    let folder = place("in-the-way");
    std::fs::write(folder.join("file"), "mine\n").expect("a file");
    std::os::unix::fs::symlink("nowhere", folder.join("link")).expect("a link");
    for out in ["file", "link"] {
        let (code, text) = run(&folder, &["run", "case.toml", "-q", "-o", out]);
        assert_eq!(code, Some(1), "{text}");
        assert_eq!(
            text,
            format!(
                "error: {out}: the results need a folder here, and a file or a link to nothing is in its way: choose another folder, or remove it\n"
            )
        );
    }
    assert_eq!(
        std::fs::read(folder.join("file")).expect("a file"),
        b"mine\n"
    );
}

#[test]
fn a_run_killed_at_any_moment_is_known_for_that() {
    let folder = place("killed");
    for pause in [0, 1, 3, 10, 30] {
        let mut guard = endless(&folder);
        std::thread::sleep(Duration::from_millis(pause));
        guard.0.kill().expect("a process");
        guard.0.wait().expect("it ends");
        let out = folder.join("case.out");
        assert_eq!(summary(&folder)["status"], "running");
        // Whole rows, whole files, and nothing half-written under the name of a result. The second run is killed while it takes the folder.
        let history = std::fs::read_to_string(out.join("history.csv")).unwrap_or_default();
        assert!(history.is_empty() || history.ends_with('\n'), "{history}");
        for (path, bytes) in contents(&out) {
            if path.extension().is_some_and(|e| e == "vtu") {
                assert!(bytes.ends_with(b"</VTKFile>\n"), "{}", path.display());
            }
        }
        let (code, _) = run(&folder, &["explain", "case.out"]);
        assert_eq!(code, Some(0));
    }
}

/// Arguments of a run with many increments, a checkpoint after each.
const LONG: [&str; 10] = [
    "run",
    "case.toml",
    "-q",
    "--set",
    "step.1.increments.fixed=300",
    "--set",
    "output={ every = 50, checkpoint = { increments = 1 } }",
    "--set",
    "solver.method=\"sparse\"",
    "-o",
];

/// The results in a folder without checkpoints and summary, by name; and of the summary what does not depend on the process.
fn results(folder: &Path) -> (Vec<(PathBuf, Vec<u8>)>, Vec<Value>) {
    let name = |path: &Path| path.strip_prefix(folder).map(Path::to_path_buf);
    let all = contents(folder).into_iter();
    let all = all.filter_map(|(path, bytes)| Some((name(&path).ok()?, bytes)));
    let of_process = |name: &str| name.starts_with("checkpoint_") || name == "summary.json";
    let files = all.filter(|(path, _)| !of_process(&path.to_string_lossy()));
    let summary = summary_of(folder);
    let wanted = ["status", "increments", "iterations", "energies", "quality"];
    let said = wanted.iter().map(|key| summary[*key].clone());
    (files.collect(), said.collect())
}

/// The numbers of the checkpoints in a folder.
fn checkpoints(folder: &Path) -> Vec<usize> {
    let names = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut all: Vec<usize> = names
        .filter_map(|entry| {
            let name = entry.file_name().to_string_lossy().into_owned();
            let digits = name.strip_prefix("checkpoint_")?.strip_suffix(".bin")?;
            digits.parse().ok()
        })
        .collect();
    all.sort_unstable();
    all
}

/// A run that was killed after at least 20 of its increments, in the folder `killed`; the numbers of its checkpoints.
fn killed(folder: &Path) -> Vec<usize> {
    let out = folder.join("killed");
    let mut command = support::command(folder);
    command.args(LONG).arg("killed");
    let child = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn();
    let mut guard = Guard(child.expect("the binary runs"));
    for _ in 0..20000 {
        if checkpoints(&out).last().is_some_and(|&n| n >= 20) {
            break;
        }
        std::thread::sleep(Duration::from_millis(1));
    }
    guard.0.kill().expect("a process");
    guard.0.wait().expect("it ends");
    // It may have been killed between writing one and removing the third last.
    let all = checkpoints(&out);
    assert!(all.len() >= 2, "{all:?}");
    all
}

#[test]
fn a_run_that_was_killed_goes_on_with_the_results_of_one_that_never_stopped() {
    let folder = place("resumed");
    let mut whole = LONG.to_vec();
    whole.push("whole");
    assert_eq!(run(&folder, &whole).0, Some(0));
    let wanted = results(&folder.join("whole"));
    killed(&folder);
    let (code, text) = run(&folder, &["resume", "killed", "-q"]);
    assert_eq!((code, text.as_str()), (Some(0), ""));
    assert!(results(&folder.join("killed")) == wanted);
    // The last checkpoint is cut: the one before it serves.
    let all = checkpoints(&folder.join("killed"));
    let last = folder.join(format!("killed/checkpoint_{}.bin", all[all.len() - 1]));
    let bytes = std::fs::read(&last).expect("a checkpoint");
    std::fs::write(&last, &bytes[..bytes.len() / 2]).expect("it is shorter");
    let (code, text) = run(&folder, &["resume", "killed", "-q"]);
    assert_eq!(code, Some(0), "{text}");
    assert!(text.contains("the checkpoint is damaged"), "{text}");
    assert!(results(&folder.join("killed")) == wanted);
}

/// What is done to the bytes of a checkpoint, and what has to be said of it.
type Damage = (String, fn(&mut Vec<u8>, usize), usize, &'static str);

/// Whatever can be wrong with the bytes of a checkpoint of so many bytes.
fn damages(length: usize) -> Vec<Damage> {
    const DAMAGED: &str = "damaged";
    let mut all: Vec<Damage> = Vec::new();
    for end in [0, 7, 16, 20, 40, length / 3, length / 2, length - 1] {
        all.push((format!("cut at {end}"), Vec::truncate, end, DAMAGED));
    }
    // Behind the version, whose text stands in front of the digest.
    for k in 0..24 {
        let at = 16 + 8 + 5 + k * (length - 30) / 23;
        let flip = |bytes: &mut Vec<u8>, at: usize| bytes[at] ^= 1 << (at % 8);
        all.push((format!("another bit at {at}"), flip, at, DAMAGED));
    }
    let begin = |bytes: &mut Vec<u8>, _: usize| bytes[0] = b'S';
    all.push(("another mark".into(), begin, 0, DAMAGED));
    let more = |bytes: &mut Vec<u8>, count: usize| bytes.extend(vec![0; count]);
    all.push(("longer".into(), more, 100, DAMAGED));
    for digit in [b'1', b'9'] {
        let layout = |bytes: &mut Vec<u8>, digit: usize| bytes[15] = digit as u8;
        let said = "has another layout than this build of stickslip reads";
        all.push(("another layout".into(), layout, digit.into(), said));
    }
    for (major, said) in [(b'0', "stickslip 0.0"), (b'9', "stickslip 9.0")] {
        let version = |bytes: &mut Vec<u8>, major: usize| {
            bytes[24] = major as u8;
            bytes[26] = b'0';
        };
        all.push(("another version".into(), version, major.into(), said));
    }
    all
}

#[test]
fn checkpoints_that_are_not_what_was_written_are_refused_and_nothing_is_touched() {
    let folder = place("checkpoint-faults");
    let all = killed(&folder);
    let out = folder.join("killed");
    let whole: Vec<(PathBuf, Vec<u8>)> = all
        .iter()
        .map(|n| out.join(format!("checkpoint_{n}.bin")))
        .map(|path| (path.clone(), std::fs::read(path).expect("a checkpoint")))
        .collect();
    let before = results(&out);
    let shortest = whole.iter().map(|(_, bytes)| bytes.len()).min();
    for (what, damage, value, said) in damages(shortest.expect("some")) {
        for (path, bytes) in &whole {
            let mut bytes = bytes.clone();
            damage(&mut bytes, value);
            std::fs::write(path, bytes).expect("a file");
        }
        let (code, text) = run(&folder, &["resume", "killed", "-q"]);
        assert_eq!(code, Some(1), "{what}: {text}");
        assert!(text.contains(said), "{what}: {text}");
        assert!(results(&out) == before, "{what}");
    }
    // That of another problem, with the right length and the right digest.
    let other = CASE.replace("mu = 0.3", "mu = 0.25");
    std::fs::write(folder.join("case.toml"), other).expect("a file");
    let mut long = LONG.to_vec();
    long.push("other");
    assert_eq!(run(&folder, &long).0, Some(0));
    let last = checkpoints(&folder.join("other"));
    let last = folder.join(format!("other/checkpoint_{}.bin", last[last.len() - 1]));
    for (path, _) in &whole {
        std::fs::copy(&last, path).expect("a copy");
    }
    let (code, text) = run(&folder, &["resume", "killed", "-q"]);
    assert_eq!(code, Some(1), "{text}");
    // Its files have come further than those of this folder, or its keys are others.
    assert!(
        text.contains("is shorter than at the checkpoint") || text.contains("has changed since"),
        "{text}"
    );
    assert!(results(&out) == before);
}

#[test]
fn checkpoints_that_cannot_be_written_are_told_once_and_the_run_goes_on() {
    let folder = place("unsaved");
    let mut whole = LONG.to_vec();
    whole.push("whole");
    assert_eq!(run(&folder, &whole).0, Some(0));
    let wanted = results(&folder.join("whole"));
    let out = folder.join("out");
    let mut command = support::command(&folder);
    command.args(LONG).arg("out").stdout(Stdio::null());
    let child = command.stderr(Stdio::piped()).spawn();
    let mut guard = Guard(child.expect("the binary runs"));
    // From some moment on a folder is in the way of the file that a checkpoint is written to.
    let aside = out.join(".checkpoint.tmp");
    while checkpoints(&out).len() < 2 || std::fs::create_dir(&aside).is_err() {
        let ended = guard.0.try_wait().expect("it can be asked");
        assert!(ended.is_none(), "it ended before");
    }
    let mut told = String::new();
    let mut stderr = guard.0.stderr.take().expect("a pipe");
    std::io::Read::read_to_string(&mut stderr, &mut told).expect("text");
    assert_eq!(guard.0.wait().expect("it ends").code(), Some(0), "{told}");
    assert_eq!(told.lines().count(), 1, "{told}");
    assert!(told.contains("warning: out/checkpoint_"), "{told}");
    assert!(told.contains("cannot be written: Is a directory"), "{told}");
    assert_eq!(results(&out).0, wanted.0);
    let note = summary_of(&out)["notes"].to_string();
    assert!(note.contains("the checkpoint cannot be written"), "{note}");
    // The last ones that could be written are whole.
    let left = checkpoints(&out);
    assert!(
        !left.is_empty() && left.iter().all(|n| *n < 300),
        "{left:?}"
    );
    std::fs::remove_dir(&aside).expect("it is empty");
    assert_eq!(run(&folder, &["resume", "out", "-q"]).0, Some(0));
    assert!(results(&out) == wanted);
}

#[test]
fn a_run_that_was_asked_to_stop_leaves_a_checkpoint_and_goes_on_with_the_same_bits() {
    let folder = place("asked");
    // No checkpoint but the one that a signal asks for.
    let long = |method: &str, out: &str| -> Vec<String> {
        let method = format!("solver.method={method}");
        let output = "output={ every = 50, checkpoint = { minutes = 0 } }";
        let words = [
            "run",
            "case.toml",
            "-q",
            "--set",
            "step.1.increments.fixed=600",
        ];
        let more = ["--set", output, "--set", &method, "-o", out];
        words.iter().chain(&more).map(|w| w.to_string()).collect()
    };
    for (signal, method) in [
        (libc::SIGINT, "multigrid"),
        (libc::SIGTERM, "sparse"),
        (libc::SIGHUP, "condensed"),
    ] {
        let whole = format!("whole-{method}");
        let words = long(method, &whole);
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        assert_eq!(run(&folder, &words).0, Some(0));
        let mut command = support::command(&folder);
        command.args(long(method, method)).stdout(Stdio::null());
        let child = command.stderr(Stdio::null()).spawn();
        let mut guard = Guard(child.expect("the binary runs"));
        let out = folder.join(method);
        let rows = || std::fs::read_to_string(out.join("history.csv")).unwrap_or_default();
        while rows().lines().count() < 30 {
            assert!(guard.0.try_wait().expect("it can be asked").is_none());
        }
        // SAFETY: the process has not been waited for, so that its number is its own.
        unsafe { libc::kill(guard.0.id() as libc::pid_t, signal) };
        assert_eq!(guard.0.wait().expect("it ends").code(), Some(130));
        assert_eq!(summary_of(&out)["status"], "interrupted");
        assert_eq!(checkpoints(&out).len(), 1, "{method}");
        let (code, text) = run(&folder, &["resume", method, "-q"]);
        assert_eq!(code, Some(0), "{text}");
        assert!(results(&out) == results(&folder.join(whole)), "{method}");
    }
}

#[test]
fn who_goes_on_from_an_earlier_checkpoint_gives_up_the_later_ones() {
    let folder = place("earlier");
    let all = killed(&folder);
    let out = folder.join("killed");
    // None is written any more; one may have been half written when the run was killed.
    let begun = out.join(".checkpoint.tmp");
    let _ = std::fs::remove_file(&begun);
    std::fs::create_dir(begun).expect("a folder");
    let first = all[0].to_string();
    let (code, text) = run(&folder, &["resume", "killed", "--from", &first, "-q"]);
    assert_eq!(code, Some(0), "{text}");
    assert_eq!(checkpoints(&out), [all[0]]);
}

#[test]
fn a_folder_is_read_while_it_grows_and_nobody_else_goes_on_in_it() {
    let folder = place("growing");
    let child = support::command(&folder)
        .args(["run", "case.toml", "-q", "--set"])
        .arg("step.1.increments.fixed=100000000")
        .args(["--set", "solver.method=sparse", "--set"])
        .arg("output={ every = 1, checkpoint = { increments = 1 } }")
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn();
    let guard = Guard(child.expect("the binary runs"));
    let out = folder.join("case.out");
    let mut seen = 0;
    while seen < 60 {
        // A row that is just being written may be there in part; all before it are whole.
        let history = std::fs::read_to_string(out.join("history.csv")).unwrap_or_default();
        let whole = history.rfind('\n').map_or(0, |end| end + 1);
        let mut rows = history[..whole].lines();
        let columns = rows.next().map_or(0, |heads| heads.split(',').count());
        assert!(rows.all(|row| row.split(',').count() == columns));
        seen = history.lines().count();
        if out.join("fields.pvd").exists() {
            let listed = stickslip::io::pvd::read(&out.join("fields.pvd"));
            for (_, name) in listed.expect("a collection").iter().rev().take(2) {
                let fields = std::fs::read(out.join(name)).expect("a file of fields");
                assert!(fields.ends_with(b"</VTKFile>\n"), "{name}");
            }
            let table = stickslip::io::csv::read(&out.join("interfaces/base.csv"));
            assert_eq!(table.expect("a table").rows(), 5);
        }
        if out.exists() && out.join("summary.json").exists() {
            assert_eq!(summary(&folder)["status"], "running");
        }
    }
    if !checkpoints(&out).is_empty() {
        let (code, text) = run(&folder, &["resume", "case.out", "-q"]);
        assert_eq!(code, Some(1), "{text}");
        assert_eq!(
            text,
            "error: case.out: another run writes into this folder (process N on HOST): wait for it, or choose another folder; if that run is over, remove run.lock\n"
        );
    }
    let (code, text) = run(&folder, &["explain", "case.out"]);
    assert!(code.is_some_and(|code| code < 3), "{text}");
    drop(guard);
}

#[test]
fn resume_says_why_it_does_not_go_on() {
    let folder = place("not-resumed");
    let (code, text) = run(&folder, &["resume", "nowhere"]);
    assert_eq!(code, Some(1));
    assert!(text.contains("nowhere: there is no such folder"));
    let (_, text) = run(&folder, &["resume", "."]);
    assert!(text.contains("there is no checkpoint in this folder"));
    let all = killed(&folder);
    let before = results(&folder.join("killed"));
    let (code, text) = run(&folder, &["resume", "killed", "--from", "100000"]);
    assert_eq!(code, Some(1));
    let known = format!("there are those after {}", all[all.len() - 1]);
    assert!(text.contains(&known), "{text}");
    let mu = "interface.base.friction.coulomb.mu=0.2";
    let (code, text) = run(&folder, &["resume", "killed", "--set", mu]);
    assert_eq!(code, Some(1));
    let named = "`interface.base.friction.coulomb.mu` has changed since the run began";
    assert!(text.contains(named), "{text}");
    for n in all {
        let path = folder.join(format!("killed/checkpoint_{n}.bin"));
        let mut bytes = std::fs::read(&path).expect("a checkpoint");
        let middle = bytes.len() / 2;
        bytes[middle] ^= 1;
        std::fs::write(&path, bytes).expect("a bit is another");
    }
    let (code, text) = run(&folder, &["resume", "killed"]);
    assert_eq!(code, Some(1));
    assert!(text.contains("the checkpoint is damaged"), "{text}");
    assert!(
        results(&folder.join("killed")) == before,
        "nothing was touched"
    );
}

#[test]
fn a_full_disk_is_told_wherever_it_happens() {
    // Standard output.
    let folder = place("full");
    let full = std::fs::OpenOptions::new().write(true).open("/dev/full");
    let full = full.expect("a device that is always full");
    let output = support::command(&folder)
        .arg("schema")
        .stdout(full)
        .output();
    let (code, text) = said(output.expect("the binary runs"));
    assert_eq!(code, Some(1));
    assert_eq!(
        text,
        "error: standard output: No space left on device (os error 28)\n"
    );
    // Files: none may grow beyond two blocks. The first that does is the fields.
    let mut limited = support::command(&folder);
    limited.args(["run", "case.toml", "-q"]);
    let (code, text) = with_limit(&mut limited, libc::RLIMIT_FSIZE, 2048);
    assert_eq!(code, Some(1), "{text}");
    let first = text.lines().next().unwrap_or_default();
    assert!(first.starts_with("error: case.out/"), "{text}");
    assert!(first.ends_with("File too large (os error 27)"), "{text}");
    // No temporary file is left, and what is there is whole.
    for (path, _) in contents(&folder.join("case.out")) {
        assert!(
            path.extension().is_none_or(|e| e != "tmp"),
            "{}",
            path.display()
        );
    }
    // The history: its rows are whole, and it is the error that is told, whatever cannot be written after it.
    let mut limited = support::command(&folder);
    limited.args(["run", "case.toml", "-q", "--set", "output.every=100000"]);
    limited.args(["--set", "step.1.increments.fixed=1000", "-o", "long"]);
    let (code, text) = with_limit(&mut limited, libc::RLIMIT_FSIZE, 12_000);
    assert_eq!(code, Some(1), "{text}");
    let first = text.lines().next().unwrap_or_default();
    assert_eq!(
        first,
        "error: long/history.csv: File too large (os error 27)"
    );
    let rows = std::fs::read_to_string(folder.join("long/history.csv")).expect("a history");
    assert!(
        rows.len() > 11_000 && rows.ends_with('\n'),
        "{}",
        rows.len()
    );
    // The cache: the run goes on and says so.
    let folder = place("full-cache");
    let more = CASE.replace("cells = [4, 2]", "cells = [40, 20]");
    std::fs::write(folder.join("case.toml"), more).expect("a file");
    let mut limited = support::command(&folder);
    limited.args([
        "run",
        "case.toml",
        "--cache",
        "cache",
        "--set",
        "output.every=1000",
    ]);
    let (_, text) = with_limit(&mut limited, libc::RLIMIT_FSIZE, 60_000);
    assert!(
        text.contains(".sub: not written: File too large (os error 27)"),
        "{text}"
    );
}

#[test]
fn what_cannot_be_written_to_is_told_before_the_run() {
    let folder = place("read-only");
    std::fs::write(folder.join("file"), "").expect("a file");
    let (code, text) = run(&folder, &["run", "case.toml", "-o", "file/out"]);
    assert_eq!(code, Some(1));
    assert_eq!(
        lines(&text, &["error"]),
        "error: file/out: the results need a folder here, and a file or a link to nothing is in its way: choose another folder, or remove it\n"
    );
    // A file system of which even root cannot write.
    let (code, text) = run(&folder, &["run", "case.toml", "-o", "/proc/stickslip.out"]);
    assert_eq!(code, Some(1));
    assert_eq!(
        lines(&text, &["error"]),
        "error: /proc/stickslip.out: No such file or directory (os error 2)\n"
    );
}

#[test]
fn devices_and_folders_are_no_input() {
    let folder = place("devices");
    std::fs::create_dir(folder.join("f.toml")).expect("a folder");
    std::os::unix::fs::symlink("/dev/zero", folder.join("z.msh")).expect("a link");
    let mesh = CASE.replace(
        "generate.rectangle = { to = [0.04, 0.02], cells = [4, 2] }",
        "gmsh.file = \"z.msh\"",
    );
    std::fs::write(folder.join("mesh.toml"), mesh).expect("a file");
    for (file, message) in [
        (
            "/dev/zero",
            "error: /dev/zero: it is a device, not a file\n",
        ),
        (
            "f.toml",
            "error: f.toml: this is a folder, and a problem file is wanted; there is no problem file in it\n",
        ),
        (
            "mesh.toml",
            "error: z.msh: the mesh cannot be read: it is a device, not a file\n",
        ),
    ] {
        let (code, text) = run(&folder, &["check", file]);
        assert_eq!(code, Some(1), "{file}");
        assert_eq!(lines(&text, &["error"]), message);
    }
}

#[test]
fn memory_that_runs_out_is_an_error_and_no_abort() {
    let folder = place("memory");
    // Foreseen, by the size of the mesh ...
    let large = |cells: &str| {
        let text = CASE.replace("cells = [4, 2]", &format!("cells = {cells}"));
        std::fs::write(folder.join("case.toml"), text).expect("a file");
        let mut command = support::command(&folder);
        command.args(["run", "case.toml", "-q", "--threads", "1"]);
        command
    };
    let (code, text) = with_limit(&mut large("[4000, 3000]"), libc::RLIMIT_AS, 400 << 20);
    assert_eq!(code, Some(1), "{text}");
    assert!(
        text.contains("the body would have 12000000 cells, which take about 7.2 GB;"),
        "{text}"
    );
    // ... by the size of the factors ...
    let mut sparse = large("[500, 300]");
    sparse.args(["--set", "solver.method=sparse"]);
    let (code, text) = with_limit(&mut sparse, libc::RLIMIT_AS, 460 << 20);
    assert_eq!(code, Some(3), "{text}");
    assert!(text.contains("memory"), "{text}");
    assert!(text.contains("help:"), "{text}");
    assert!(!text.contains("panicked"), "{text}");
    // ... and not foreseen.
    let (code, text) = with_limit(&mut large("[500, 300]"), libc::RLIMIT_AS, 250 << 20);
    assert_eq!(code, Some(3), "{text}");
    assert!(text.contains("memory"), "{text}");
    assert!(!text.contains("panicked"), "{text}");
}

#[test]
fn threads_are_no_more_than_processors() {
    let folder = place("threads");
    let (code, text) = run(&folder, &["run", "case.toml", "--threads", "100000"]);
    assert_eq!(code, Some(0), "{text}");
    assert!(
        text.contains("100000 threads are asked for, and this machine has "),
        "{text}"
    );
}

/// Runs with a limit of the system.
fn with_limit(
    command: &mut Command,
    what: libc::__rlimit_resource_t,
    limit: u64,
) -> (Option<i32>, String) {
    // SAFETY: both calls are allowed between fork and exec; nothing is allocated.
    unsafe {
        command.pre_exec(move || {
            // A file that would grow too large is an error, not the end.
            libc::signal(libc::SIGXFSZ, libc::SIG_IGN);
            let limits = libc::rlimit {
                rlim_cur: limit,
                rlim_max: limit,
            };
            match libc::setrlimit(what, &limits) {
                0 => Ok(()),
                _ => Err(std::io::Error::last_os_error()),
            }
        });
    }
    said(command.output().expect("the binary runs"))
}
