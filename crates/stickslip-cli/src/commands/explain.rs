use std::path::{Path, PathBuf};
use std::process::ExitCode;

use serde_json::Value;
use stickslip::assess::doctor::{DoctorCause, Finding, Severity, Suspect};
use stickslip::assess::{Figure, told_apart};

use crate::failure::{Failure, Outcome};
use crate::given;
use crate::print;
use stickslip::number::digits;

/// Width of the printed text in characters.
const WIDTH: usize = 100;

/// Explain a run: outcome, effort, problems with their places, and remedies.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// The result folder, or its summary.json.
    #[arg(value_hint = clap::ValueHint::DirPath)]
    directory: PathBuf,
    /// Print the findings as JSON.
    #[arg(long)]
    json: bool,
}

/// Prints the explanation.
pub fn run(arguments: &Arguments) -> Outcome {
    if !is_summary(&arguments.directory) {
        given::results(&arguments.directory)?;
    }
    let summary = read(&arguments.directory)?;
    let findings = findings(&summary, &arguments.directory)?;
    if arguments.json {
        let text = serde_json::to_string_pretty(&findings)
            .map_err(|e| Failure::Output(std::io::Error::other(e)))?;
        print::out(&(text + "\n"))?;
    } else {
        print::out(&explain(&summary, &findings))?;
    }
    Ok(ExitCode::SUCCESS)
}

/// Whether it is a summary by itself, which may have any name.
fn is_summary(path: &Path) -> bool {
    path.is_file() && path.extension().is_some_and(|e| e == "json")
}

fn read(directory: &Path) -> Result<Value, Failure> {
    let path = match directory.is_dir() {
        true => directory.join("summary.json"),
        false => directory.to_path_buf(),
    };
    let text = stickslip::io::input::read_text(&path).map_err(|e| {
        Failure::Arguments(
            format!("{} cannot be read: {e}", path.display()),
            "give the directory that `stickslip run` wrote; a run that was killed leaves no summary".into(),
        )
    })?;
    match serde_json::from_str(&text) {
        Ok(summary @ Value::Object(_)) => Ok(summary),
        Ok(_) => Err(damaged(&path, "it is no summary")),
        Err(e) => Err(damaged(&path, &e.to_string())),
    }
}

fn damaged(path: &Path, why: &str) -> Failure {
    Failure::Arguments(
        format!("{} is damaged: {why}", path.display()),
        "run the analysis again".into(),
    )
}

fn findings(summary: &Value, path: &Path) -> Result<Vec<Finding>, Failure> {
    match summary.get("findings") {
        Some(list) => {
            serde_json::from_value(list.clone()).map_err(|e| damaged(path, &e.to_string()))
        }
        None if summary.get("completed").is_some() => Err(Failure::Arguments(
            format!("{} has no findings", path.display()),
            "it was written by an older version; run the analysis again".into(),
        )),
        None => Err(damaged(path, "it is no summary")),
    }
}

/// The whole text.
fn explain(summary: &Value, findings: &[Finding]) -> String {
    let mut text = String::new();
    if let Some(title) = summary["title"].as_str().filter(|t| !t.is_empty()) {
        text += &format!("{title}\n");
    }
    text += &print::wrap(&course(summary), 0, WIDTH);
    text += &print::wrap(&effort(summary), 0, WIDTH);
    let mut causes: Vec<(Severity, DoctorCause)> = Vec::new();
    for finding in findings {
        match causes.iter_mut().find(|c| c.1 == finding.cause) {
            Some(cause) => cause.0 = cause.0.max(finding.severity),
            None => causes.push((finding.severity, finding.cause)),
        }
    }
    causes.sort_by_key(|c| std::cmp::Reverse(c.0));
    if causes.is_empty() && sound(summary) {
        text += "Nothing went wrong.\n";
    }
    text += &gate(summary, findings);
    for (severity, cause) in causes {
        let all: Vec<&Finding> = findings.iter().filter(|f| f.cause == cause).collect();
        text += "\n";
        text += &group(severity, cause, &all);
    }
    if findings
        .iter()
        .any(|f| f.suspects.iter().any(|g| g.position.is_some()))
    {
        text += "\nThe places are in culprits.vtu, for ParaView.\n";
    }
    text
}

/// Whether the run reached its end with a good result.
fn sound(summary: &Value) -> bool {
    summary["completed"].as_bool() == Some(true) && poor(summary).is_empty() && !running(summary)
}

/// Whether the summary is that of a run that never came to write its last one.
fn running(summary: &Value) -> bool {
    summary["status"].as_str() == Some("running")
}

/// The figures of the quality gate above their limits.
fn poor(summary: &Value) -> Vec<&Value> {
    let figures = summary["quality"]["figures"].as_array();
    let figures = figures.into_iter().flatten();
    figures
        .filter(|f| f["met"].as_bool() == Some(false))
        .collect()
}

/// What the quality gate said.
fn gate(summary: &Value, findings: &[Finding]) -> String {
    let mut text = String::new();
    let severity = match summary["quality"]["gate"].as_str() {
        Some("warn") => Severity::Warning,
        _ => Severity::Error,
    };
    for figure in poor(summary) {
        let name = figure["figure"].as_str().unwrap_or_default();
        let place = figure["place"].as_str().unwrap_or_default();
        // JSON has no NaN: what is no number is null.
        let number = |key: &str| figure[key].as_f64();
        let limit = number("limit").unwrap_or(f64::INFINITY);
        let both = number("value").map(|value| told_apart(value, limit));
        let [value, limit] = both.unwrap_or(["not a number".into(), digits(limit, 2)]);
        let when = number("time").map_or(String::new(), |t| format!(", at time {}", digits(t, 6)));
        let (what, help) = Figure::meaning(name, findings).unwrap_or((
            "it is not known to this version",
            "see the version that ran it".to_string(),
        ));
        text += &format!("\n{severity}: quality, {name} of {place}{when}\n");
        text += &print::wrap(
            &format!("{value}, above its limit {limit}: {what}."),
            2,
            WIDTH,
        );
        text += &item("try", &help);
    }
    text
}

fn course(summary: &Value) -> String {
    let outcome = summary["outcome"].as_str().unwrap_or("unknown");
    if running(summary) {
        return "The run has not ended: it is still going on, or it was killed before it could say how it ended. \
            What follows is the state when this summary was written."
            .into();
    }
    if summary["completed"].as_bool() == Some(true) {
        let failed = summary["quality"]["gate"].as_str() != Some("warn");
        return match (poor(summary).is_empty(), failed) {
            (true, _) => "The run finished.".into(),
            (false, true) => {
                "The run finished, but its result is not good enough: figures of the quality gate are above their limits (exit code 2)."
                    .into()
            }
            (false, false) => {
                "The run finished. Figures of the quality gate are above their limits, and `quality.gate = \"warn\"` lets that pass."
                    .into()
            }
        };
    }
    // Places and help follow below, in order.
    let first = outcome.lines().next().unwrap_or_default();
    format!("The run stopped {first}.")
}

fn effort(summary: &Value) -> String {
    let number = |key: &str| summary[key].as_u64().unwrap_or(0);
    let (increments, iterations) = (number("increments"), number("iterations"));
    let mut parts = vec![format!(
        "{}, {}",
        plural(increments, "accepted increment"),
        plural(iterations, "Newton iteration")
    )];
    if increments > 0 {
        parts.push(format!(
            "{:.1} an increment",
            iterations as f64 / increments as f64
        ));
    }
    let solver = &summary["solver"];
    for (count, what) in [
        (number("cutbacks"), "cut-back"),
        (
            solver["augmentations"].as_u64().unwrap_or(0),
            "multiplier update",
        ),
        (
            solver["fallbacks"].as_u64().unwrap_or(0),
            "friction problem",
        ),
    ] {
        if count > 0 {
            parts.push(plural(count, what));
        }
    }
    let hard = match (
        number("cutbacks"),
        iterations as f64 / increments.max(1) as f64,
    ) {
        _ if increments == 0 => "It did not get off the ground",
        (0, mean) if mean <= 10.0 => "It was easy",
        (0, _) => "It took many iterations",
        (cut, _) if cut * 4 > increments => "It was hard",
        _ => "It had to cut increments",
    };
    format!("{hard}: {}.{}", parts.join(", "), by_forces(summary))
}

/// The increments that plain iteration did not solve, by the solver of friction problems that they took.
fn by_forces(summary: &Value) -> String {
    let counts = summary["friction-solvers"].as_object();
    let each: Vec<String> = counts
        .into_iter()
        .flatten()
        .map(|(name, n)| format!("{n} by {name}"))
        .collect();
    match each.is_empty() {
        true => String::new(),
        false => format!(" Solved as friction problems: {}.", each.join("; ")),
    }
}

fn plural(count: u64, what: &str) -> String {
    match count {
        1 => format!("1 {what}"),
        n => format!("{n} {what}s"),
    }
}

/// What is to be said of one cause. The last finding speaks for the others, those of an error before all.
fn group(severity: Severity, cause: DoctorCause, all: &[&Finding]) -> String {
    let worst = all.iter().rev().find(|f| f.severity == severity);
    let Some(one) = worst.or(all.last()) else {
        return String::new();
    };
    let count = match all.len() {
        1 => "once".to_string(),
        n => format!("{n} times"),
    };
    let mut when = match one.step {
        None => ", before the run".to_string(),
        Some(_) => String::new(),
    };
    let times: Vec<f64> = all.iter().filter_map(|f| f.time).collect();
    if let (Some(first), Some(last)) = (times.first(), times.last()) {
        when = match first == last {
            true => format!(", at time {}", digits(first, 6)),
            false => format!(
                ", from time {first} to {last}",
                first = digits(first, 6),
                last = digits(last, 6)
            ),
        };
    }
    if let Some(step) = one.step.as_ref().filter(|s| !s.is_empty()) {
        when += &format!(", step {step}");
    }
    let mut text = format!("{severity}: {cause}, {count}{when}\n");
    text += &print::wrap(&format!("{}.", one.message), 2, WIDTH);
    for suspect in &one.suspects {
        text += &item("where", &suspect.to_string());
    }
    let others = others(one, all);
    if !others.is_empty() {
        text += &item("also", &others.join("; "));
    }
    for tried in &one.tried {
        text += &item("tried", tried);
    }
    let mut advice: Vec<&String> = Vec::new();
    for a in all.iter().rev().flat_map(|f| &f.advice) {
        if !advice.contains(&a) {
            advice.push(a);
        }
    }
    for a in advice {
        text += &item("try", a);
    }
    text
}

/// Places of the other findings that are not among those of this one, five at most.
fn others(one: &Finding, all: &[&Finding]) -> Vec<String> {
    let same = |a: &Suspect, b: &Suspect| (a.what, &a.name, a.id) == (b.what, &b.name, b.id);
    let mut found: Vec<&Suspect> = Vec::new();
    for suspect in all.iter().flat_map(|f| &f.suspects) {
        let known = one.suspects.iter().chain(found.iter().copied());
        if !known.into_iter().any(|k| same(k, suspect)) {
            found.push(suspect);
        }
    }
    let brief = |g: &Suspect| Suspect {
        remark: String::new(),
        ..g.clone()
    };
    found.iter().take(5).map(|g| brief(g).to_string()).collect()
}

fn item(label: &str, text: &str) -> String {
    let wrapped = print::wrap(text, 9, WIDTH);
    format!("  {label:6} {}", wrapped.trim_start())
}
