//! What programs and people see of a run while it goes on, and that it can be stopped.

use crate::support::{self, CASE, text};
use std::path::PathBuf;
use std::process::{Command, Stdio};

use serde_json::Value;

fn place(name: &str) -> PathBuf {
    support::place("progress", name, &CASE.replace("fixed = 2", "fixed = 3"))
}

#[test]
fn programs_get_a_line_of_json_for_each_event() {
    let folder = place("json");
    let output = support::command(&folder)
        .args(["run", "case.toml", "--json"])
        .output();
    let output = output.expect("the binary runs");
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let lines: Vec<Value> = text(&output.stdout)
        .lines()
        .map(|line| serde_json::from_str(line).unwrap_or_else(|e| panic!("{line}: {e}")))
        .collect();
    let of = |event: &str| {
        lines
            .iter()
            .filter(|l| l["event"] == event)
            .collect::<Vec<_>>()
    };
    let increments = of("increment");
    assert_eq!(increments.len(), 3);
    assert_eq!(increments[2]["row"]["TIME"], 1.0);
    assert_eq!(increments[0]["step"], "press");
    assert_eq!(lines.last().map(|l| l["event"].clone()), Some("end".into()));
    assert_eq!(of("end")[0]["summary"]["increments"], 3);
    // nothing else is in the way of who reads it
    assert!(output.stderr.is_empty(), "{}", text(&output.stderr));
}

#[test]
fn a_pipe_gets_no_line_an_increment() {
    let folder = place("piped");
    let output = support::command(&folder)
        .args(["run", "case.toml"])
        .output()
        .expect("the binary runs");
    let said = text(&output.stderr);
    assert!(said.contains("done: 3 increments"), "{said}");
    assert!(!said.lines().any(|l| l.starts_with("press")), "{said}");
    let output = support::command(&folder)
        .args(["run", "case.toml", "--verbose"])
        .output();
    let said = text(&output.expect("the binary runs").stderr);
    assert_eq!(
        said.lines().filter(|l| l.starts_with("press")).count(),
        3,
        "{said}"
    );
}

/// A run that does not outlive its test.
#[cfg(unix)]
struct Guard(std::process::Child);

#[cfg(unix)]
impl Drop for Guard {
    fn drop(&mut self) {
        let _ = self.0.kill();
    }
}

/// Ctrl-C is a signal where there are signals.
#[cfg(unix)]
#[test]
fn a_run_that_is_interrupted_leaves_valid_results() {
    for signal in ["INT", "TERM", "HUP"] {
        interrupted(signal);
    }
}

fn interrupted(signal: &str) {
    let folder = place(&format!("interrupted-{signal}"));
    let run = support::command(&folder)
        .args([
            "run",
            "case.toml",
            "--json",
            "--set",
            "step.0.increments.fixed=100000000",
        ])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn();
    let mut run = Guard(run.expect("the binary runs"));
    let run = &mut run.0;
    // It is under way when it tells of an increment; notes come before.
    let mut lines =
        std::io::BufRead::lines(std::io::BufReader::new(run.stdout.take().expect("a pipe")));
    let told = |line: &std::io::Result<String>| {
        line.as_ref()
            .is_ok_and(|l| l.contains(r#""event":"increment""#))
    };
    assert!(lines.any(|line| told(&line)), "no increment");
    let sent = Command::new("kill")
        .args([format!("-{signal}"), run.id().to_string()])
        .status();
    assert!(sent.expect("kill").success());
    let rest: Vec<String> = lines.map_while(Result::ok).collect();
    let status = run.wait().expect("it ends");
    assert_eq!(status.code(), Some(130));
    let end: Value = serde_json::from_str(rest.last().expect("an end")).expect("JSON");
    assert_eq!(end["event"], "end");
    let summary = std::fs::read_to_string(folder.join("case.out/summary.json")).expect("a summary");
    let summary: Value = serde_json::from_str(&summary).expect("JSON");
    let history = std::fs::read_to_string(folder.join("case.out/history.csv")).expect("a history");
    let rows = history.lines().filter(|l| !l.starts_with('#')).count() - 1;
    assert_eq!(summary["increments"], rows);
    assert!(rows > 0);
    // and other commands take them for what they are
    let explained = support::command(&folder)
        .args(["explain", "case.out"])
        .output()
        .expect("the binary runs");
    assert!(
        explained.status.code().is_some_and(|c| c < 4),
        "{}",
        text(&explained.stderr)
    );
}
