//! What may be changed in a problem while a run of it rests: what is still to come.

use std::path::Path;

use toml::{Table, Value};

use super::data::Problem;
use super::document::Document;
use super::key;
use crate::error::{Diagnostic, Error};
use crate::results::{Saved, Source};

/// The problem file with which a run in a folder of results goes on: `problem.toml` there, which may have been changed, or else what was run.
///
/// # Errors
/// [`Error::Io`] if it cannot be read.
pub fn of_results(directory: &Path, source: &Source) -> Result<Document, Error> {
    let own = directory.join("problem.toml");
    match own.is_file() {
        true => Document::read(&own),
        false => Ok(Document::new(source.problem.clone(), None)),
    }
}

/// Refuses what cannot change in the middle of a run.
///
/// # Errors
/// [`Error::Problem`] with each key that has.
pub fn check_changes(document: &Document, problem: &Problem, saved: &Saved) -> Result<(), Error> {
    let before = Document::new(saved.source.problem.clone(), None).problem()?;
    let snapshot = &saved.snapshot;
    let (step, ended) = (snapshot.step, snapshot.ended);
    let findings = changed_keys(&before, problem, step, ended, snapshot.time);
    match findings.is_empty() {
        true => Ok(()),
        false => Err(document.error(findings).into()),
    }
}

/// What has changed from one problem to another and must not, where a run has come to time `t` in the step of index `at.0`, which `at.1` has
/// ended.
pub fn changed_keys(
    before: &Problem,
    after: &Problem,
    step: usize,
    ended: bool,
    t: f64,
) -> Vec<Diagnostic> {
    let table = |problem: &Problem| Table::try_from(problem).unwrap_or_default();
    let mut changed = Vec::new();
    compare(
        &mut Vec::new(),
        Some(&Value::Table(table(before))),
        Some(&Value::Table(table(after))),
        &mut changed,
    );
    changed.retain(|path| !may_change(path, step, ended));
    let mut findings: Vec<Diagnostic> = changed
        .iter()
        .map(|path| {
            let key = path.join(".");
            let message = format!("`{key}` has changed since the run began");
            Diagnostic::new(key, message).help(
                "`resume` accepts changes of `output`, `title`, the duration of the present step and later steps only; for other changes run again",
            )
        })
        .collect();
    if !ended && end_of(after, step) <= t && end_of(before, step) > t {
        let key = format!("step.{}.duration", key::entry(step));
        let message = format!("the run has come to time {t}, and the step would end before");
        findings.push(Diagnostic::new(key, message).help("let it end later"));
    }
    findings
}

/// The time at which a step ends.
fn end_of(problem: &Problem, step: usize) -> f64 {
    problem.step.iter().take(step + 1).map(|s| s.duration).sum()
}

fn may_change(path: &[String], step: usize, ended: bool) -> bool {
    let word = |i: usize| path.get(i).map_or("", String::as_str);
    let number = key::index(word(1));
    match (word(0), number) {
        ("output" | "title", _) => true,
        ("step", Some(i)) => i > step || i == step && !ended && word(2) == "duration",
        _ => false,
    }
}

/// The paths of all values that are not the same.
fn compare(
    path: &mut Vec<String>,
    before: Option<&Value>,
    after: Option<&Value>,
    out: &mut Vec<Vec<String>>,
) {
    let mut inner = |key: String, before: Option<&Value>, after: Option<&Value>| {
        path.push(key);
        compare(path, before, after, out);
        path.pop();
    };
    match (before, after) {
        (Some(Value::Table(before)), Some(Value::Table(after))) => {
            for (key, value) in before {
                inner(key.clone(), Some(value), after.get(key));
            }
            for (key, value) in after.iter().filter(|(key, _)| !before.contains_key(*key)) {
                inner(key.clone(), None, Some(value));
            }
        }
        // Numbers of a list are one value; tables of a list are told apart.
        (Some(Value::Array(before)), Some(Value::Array(after)))
            if before.iter().chain(after).all(Value::is_table) =>
        {
            for i in 0..before.len().max(after.len()) {
                inner(key::entry(i), before.get(i), after.get(i));
            }
        }
        (before, after) if before != after => out.push(path.clone()),
        _ => {}
    }
}
