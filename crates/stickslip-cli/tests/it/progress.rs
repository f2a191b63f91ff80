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

/// What a run says, with other arguments and variables of the environment, but for the seconds it took.
fn said(name: &str, more: &[&str], variables: &[(&str, &str)]) -> String {
    let folder = place(name);
    let mut command = support::command(&folder);
    command.args(["run", "case.toml"]).args(more);
    let output = command.envs(variables.iter().copied()).output();
    let output = output.expect("the binary runs");
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    assert!(output.stdout.is_empty(), "{}", text(&output.stdout));
    text(&output.stderr)
}

/// The whole of it: increments, then what came out.
const SAID: &str = "\
its: Newton iterations; stick, slip, open: contact points; force: contact force of base
step                inc         time   its   stick    slip    open        force     left
press                 1     0.333333     4       3       2       0      1.737e6
press                 2     0.666667     2       3       2       0      3.475e6
press                 3            1     2       3       2       0      5.212e6
done: 3 increments, 8 iterations, 0 cut-backs
interface base at time 1, forces on its secondary
  peak pressure  139.4e6 at (0, 0), time 1; now 139.4e6
  normal force   5.212e6 (0, 5.212e6)
  shear force    0
  contact area   0.04
  points         3 stick, 2 slip, 0 open
  friction work  0.1813
quality: all 15 limits are kept; nearest: oscillation of interface base, 0.013 of 0.25
results in case.out
  stickslip plot case.out      a picture
  stickslip report case.out    all of it, as a page to browse
";

#[test]
fn a_run_says_what_contact_does_and_what_came_of_it() {
    for (name, variables) in [("said", vec![]), ("said-plain", vec![("NO_COLOR", "1")])] {
        let said = said(name, &[], &variables);
        assert!(!said.contains(['\x1b', '\r']), "{said:?}");
        let lines = said.lines().map(|line| match line.strip_prefix("done: ") {
            Some(rest) => format!(
                "done: {}\n",
                rest.rsplit_once(", ").map_or(rest, |(a, _)| a)
            ),
            None => format!("{line}\n"),
        });
        assert_eq!(lines.collect::<String>(), SAID);
    }
}

#[test]
fn what_the_solver_does_is_for_who_asks() {
    let words = [
        "residual",
        "krylov",
        "factorisation",
        "condensed",
        "flops",
        "worst node",
    ];
    let plain = said("asked-not", &[], &[]);
    let verbose = said("asked", &["--verbose"], &[]);
    for word in words {
        assert!(!plain.contains(word), "{word}: {plain}");
        assert!(verbose.contains(word), "{word}: {verbose}");
    }
    for said in [&plain, &verbose] {
        let increments = said.lines().filter(|l| l.starts_with("press"));
        assert_eq!(increments.count(), 3, "{said}");
        assert!(said.lines().all(|l| l.chars().count() <= 100), "{said}");
    }
    assert_eq!(said("asked-quiet", &["--quiet"], &[]), "");
}

#[test]
fn a_pipe_gets_fewer_lines_after_a_while() {
    let set = ["--set", "step.1.increments.fixed=60"];
    let said = said("piped", &set, &[]);
    let increments = said.lines().filter(|l| l.starts_with("press")).count();
    assert!((40..60).contains(&increments), "{said}");
    assert!(said.contains("from here on a line every 10 s"), "{said}");
    assert!(said.contains("done: 60 increments"), "{said}");
}

#[test]
fn the_summary_has_what_the_end_says() {
    let folder = place("physics");
    // Pressed, and half let go: the largest pressure is not the last.
    let turned = CASE.replace("y = -1e-5", "y = -1e-5, amplitude = \"turn\"")
        + "amplitude.turn.table = [[0, 0], [0.5, 1], [1, 0.5]]\noutput.checkpoint.increments = 1\nsolver.method = \"sparse\"\n";
    std::fs::write(folder.join("case.toml"), turned).expect("the folder can be written to");
    let run = support::command(&folder)
        .args(["run", "case.toml", "-q"])
        .status();
    assert!(run.expect("the binary runs").success());
    let summary = std::fs::read_to_string(folder.join("case.out/summary.json")).expect("a summary");
    let summary: Value = serde_json::from_str(&summary).expect("JSON");
    let base = &summary["interfaces"][0];
    let peak = &base["peak-pressure"];
    assert_eq!(peak["time"], 0.5);
    let number = |v: &Value| v.as_f64().expect("a number");
    let last = |column: &str| number(&summary["last"][column]);
    assert!(
        number(&peak["value"]) > 1.5 * last("base.CPRESSMAX"),
        "{base}"
    );
    assert_eq!(peak["at"].as_array().map(Vec::len), Some(3));
    assert_eq!(number(&base["pressure"]), last("base.CPRESSMAX"));
    assert_eq!(number(&base["normal-force"][1]), last("base.CFN2"));
    assert_eq!(number(&base["area"]), last("base.CAREA"));
    assert_eq!(number(&base["friction-work"]), last("base.ALLFD"));
    for (key, column) in [("stick", "STICK"), ("slip", "SLIP"), ("open", "OPEN")] {
        assert_eq!(number(&base["points"][key]), last(column), "{base}");
    }
    // A run that goes on after the largest pressure still knows of it.
    let resumed = support::command(&folder)
        .args(["resume", "case.out", "-q", "--from", "1"])
        .output()
        .expect("the binary runs");
    assert!(resumed.status.success(), "{}", text(&resumed.stderr));
    let again = std::fs::read_to_string(folder.join("case.out/summary.json")).expect("a summary");
    let again: Value = serde_json::from_str(&again).expect("JSON");
    assert_eq!(again["interfaces"], summary["interfaces"]);
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
            "step.1.increments.fixed=100000000",
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
