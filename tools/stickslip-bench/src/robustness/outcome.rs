//! One problem, run and judged by what it leaves behind.

use std::fs::{self, File};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::Value;
use stickslip_audit::audit::audit;
use stickslip_audit::verdict::Verdict;

/// What came of a problem.
pub struct Outcome {
    /// The judgement.
    pub verdict: Verdict,
    /// The exit code; none if it was stopped.
    pub exit: Option<i32>,
    /// How many things the audit does not know how to judge.
    pub skipped: usize,
    /// Wall time `[s]`.
    pub seconds: f64,
    /// Newton iterations of each accepted increment.
    pub iterations: Vec<u64>,
    /// All iterations, those of rejected attempts too.
    pub total: u64,
    /// Increments that were solved as friction problems, by the solver that they took.
    pub solvers: Vec<(String, u64)>,
    /// Increments that were cut.
    pub cutbacks: u64,
    /// Displacement dofs.
    pub dofs: u64,
    /// What the audit and the program say against the result.
    pub lines: Vec<String>,
}

/// Runs the binary with words that leave results in `case.out` of a folder, for so long at most, and audits them.
pub fn run(
    binary: &Path,
    words: &[String],
    folder: &Path,
    limit: Duration,
) -> Result<Outcome, String> {
    let say = |e: std::io::Error| format!("{}: {e}", folder.display());
    let out = folder.join("case.out");
    // What an earlier run left must not pass for the result of this one; what is gone on with is its result.
    if words.first().is_some_and(|word| word == "run") {
        let _ = fs::remove_dir_all(&out);
    }
    let log = folder.join("log.txt");
    let mut child = Command::new(binary)
        .args(words)
        .stdout(Stdio::null())
        .stderr(File::create(&log).map_err(say)?)
        .spawn()
        .map_err(|e| format!("cannot run {}: {e}", binary.display()))?;
    let started = Instant::now();
    let status = loop {
        if let Some(status) = child.try_wait().map_err(say)? {
            break Some(status);
        }
        if started.elapsed() > limit {
            child.kill().map_err(say)?;
            child.wait().map_err(say)?;
            break None;
        }
        std::thread::sleep(Duration::from_millis(5));
    };
    let seconds = started.elapsed().as_secs_f64();
    let said = fs::read_to_string(&log).unwrap_or_default();
    let summary = fs::read_to_string(out.join("summary.json")).unwrap_or_default();
    let summary: Value = serde_json::from_str(&summary).unwrap_or_default();
    let history = fs::read_to_string(out.join("history.csv")).unwrap_or_default();
    // Without a code it was ended by a signal.
    let exit = status.map(|s| s.code().unwrap_or(-1));
    let report = match exit {
        Some(0 | 2) => audit(&out),
        _ => Err(String::new()),
    };
    let verdict = Verdict::new(exit, &report);
    let mut lines = Vec::new();
    match (&report, verdict) {
        (_, Verdict::Sound) => {}
        (Ok(report), _) => {
            let chosen = if verdict == Verdict::Wrong {
                report.wrong()
            } else {
                report.doubtful()
            };
            lines.extend(chosen.iter().map(|figure| figure.to_string()));
            lines.extend(failed(&summary));
        }
        (Err(why), _) if !why.is_empty() => lines.push(why.clone()),
        _ => lines.push(sentence(&summary, &said)),
    }
    let count = |key: &str| summary.pointer(key).and_then(Value::as_u64).unwrap_or(0);
    // What the audit leaves out, that it be counted.
    let skipped = report.map_or(0, |report| report.skipped.len());
    Ok(Outcome {
        verdict,
        exit,
        skipped,
        seconds,
        iterations: column(&history, "ITRS"),
        total: count("/iterations"),
        solvers: solvers(&summary),
        cutbacks: count("/cutbacks"),
        dofs: count("/size/dofs"),
        lines,
    })
}

/// How many increments took which solver of friction problems.
fn solvers(summary: &Value) -> Vec<(String, u64)> {
    let counts = summary["friction-solvers"].as_object();
    let counts = counts.into_iter().flatten();
    let counts = counts.map(|(name, count)| (name.clone(), count.as_u64().unwrap_or(0)));
    counts.collect()
}

/// The figures of the quality gate that were not met.
fn failed(summary: &Value) -> Vec<String> {
    let figures = summary
        .pointer("/quality/figures")
        .and_then(Value::as_array);
    let not_met = figures
        .into_iter()
        .flatten()
        .filter(|f| f["met"] == Value::Bool(false));
    not_met
        .map(|f| {
            let word = |key: &str| f[key].as_str().unwrap_or("").to_string();
            let number = |key: &str| f[key].as_f64().unwrap_or(f64::NAN);
            format!(
                "the gate: {} of {} {:.2e} above {:.0e}",
                word("figure"),
                word("place"),
                number("value"),
                number("limit")
            )
        })
        .collect()
}

/// What is wrong, in one line: the last finding, or else the first line of error.
fn sentence(summary: &Value, said: &str) -> String {
    // Those before the last are notes on what was read.
    let findings = summary["findings"].as_array();
    let finding = findings.and_then(|f| f.last()?["message"].as_str());
    let lines: Vec<&str> = said.lines().filter(|l| !l.trim().is_empty()).collect();
    let error = lines.iter().find(|l| l.trim_start().starts_with("error"));
    let line = finding.or(error.copied()).or(lines.first().copied());
    line.unwrap_or("nothing was said").trim().to_string()
}

/// The whole numbers of a column.
fn column(csv: &str, name: &str) -> Vec<u64> {
    let mut lines = csv.lines();
    let heads = lines.next().unwrap_or_default();
    let Some(place) = heads.split(',').position(|head| head == name) else {
        return Vec::new();
    };
    lines
        .filter_map(|line| line.split(',').nth(place)?.parse::<f64>().ok())
        .map(|number| number as u64)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::{column, sentence, solvers};
    use serde_json::{Value, json};

    #[test]
    fn iterations_are_read_by_the_head_of_their_column() {
        assert_eq!(column("STEP,ITRS\n1,4\n1,7\n", "ITRS"), [4, 7]);
        assert!(column("", "ITRS").is_empty());
    }

    #[test]
    fn solvers_are_read_with_their_counts() {
        let summary = json!({ "friction-solvers": { "gauss-seidel": 2, "proximal point": 1 } });
        let counts = [
            ("gauss-seidel".to_string(), 2),
            ("proximal point".into(), 1),
        ];
        assert_eq!(solvers(&summary), counts);
        assert!(solvers(&Value::Null).is_empty());
    }

    #[test]
    fn a_finding_says_more_than_a_log() {
        let said = "a note\nerror: step 1 failed\nhelp: no";
        assert_eq!(sentence(&json!({}), said), "error: step 1 failed");
        let summary = json!({ "findings": [{ "message": "the block is unconstrained" }] });
        assert_eq!(sentence(&summary, said), "the block is unconstrained");
    }
}
