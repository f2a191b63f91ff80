//! Rules that bind the tables of a problem to each other.
//!
//! One file per kind of rule: names that are used (`names.rs`), tables on their own (`tables.rs`), time (`steps.rs`),
//! motion (`motion.rs`), engines (`engine.rs`), cuts through bolts (`pretensions.rs`), bodies that turn (`turning.rs`).
//! Ranges of single numbers are stated where the key is declared and checked with the schema.

mod cycles;
mod engine;
mod findings;
mod motion;
mod names;
mod pretensions;
mod steps;
mod tables;
mod turning;

use super::{FORMAT, Problem};
use crate::error::Diagnostic;
use findings::Findings;

/// All findings, without places.
pub(super) fn check(problem: &Problem) -> Vec<Diagnostic> {
    let mut findings = Findings(Vec::new());
    if problem.format != FORMAT {
        let message = format!("this version reads format {FORMAT}, not {}", problem.format);
        findings.add(&["format"], message, "");
    }
    names::check(problem, &mut findings);
    tables::check(problem, &mut findings);
    pretensions::check(problem, &mut findings);
    turning::check(problem, &mut findings);
    steps::check(problem, &mut findings);
    motion::check(problem, &mut findings);
    engine::check(problem, &mut findings);
    findings.0
}
