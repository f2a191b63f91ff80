//! Rules that bind the tables of a problem to each other.
//!
//! One file per kind of rule: names that are used (`names.rs`), tables on their own (`tables.rs`), time (`steps.rs`),
//! motion (`motion.rs`).
//! Ranges of single numbers are stated where the key is declared and checked with the schema.

mod motion;
mod names;
mod steps;
mod tables;

use super::{FORMAT, Problem, key};
use crate::error::Diagnostic;

/// All findings, without places.
pub(super) fn check(problem: &Problem) -> Vec<Diagnostic> {
    let mut findings = Findings(Vec::new());
    if problem.format != FORMAT {
        let message = format!("this version reads format {FORMAT}, not {}", problem.format);
        findings.add(&["format"], message, "");
    }
    names::check(problem, &mut findings);
    tables::check(problem, &mut findings);
    steps::check(problem, &mut findings);
    motion::check(problem, &mut findings);
    findings.0
}

struct Findings(Vec<Diagnostic>);

impl Findings {
    /// An empty help is none.
    fn add(&mut self, key: &[&str], message: impl Into<String>, help: impl Into<String>) {
        let help: String = help.into();
        self.0.push(Diagnostic {
            message: message.into(),
            key: key::join(key),
            span: None,
            help: (!help.is_empty()).then_some(help),
        });
    }

    /// What a model says about its own parameters; a parameter may be a path.
    fn faults(&mut self, key: &[&str], faults: Vec<(&'static str, String)>) {
        for (parameter, message) in faults {
            self.0.push(Diagnostic::new(
                format!("{}.{parameter}", key::join(key)),
                format!("`{parameter}` {message}"),
            ));
        }
    }

    /// A vector must have a component a dimension, all finite.
    fn vector(&mut self, problem: &Problem, key: &[&str], vector: &[f64]) {
        let space = problem.model.space;
        let (dim, components) = match space.dim() {
            2 => (2, "x, y"),
            n => (n, "x, y, z"),
        };
        if vector.len() != dim {
            let message = format!(
                "expected {dim} components ({components}) because the model is {}, found {}",
                space.name(),
                vector.len()
            );
            self.add(key, message, "");
        }
    }
}
