//! The doctor: what is wrong with a model or a run, who is guilty, and what to try.
//!
//! Before the run `examine` looks at the model: motions that nothing can hold, gaps and overlaps, surfaces that do not face each other, meshes
//! that do not go together, numbers in mixed units. In the run every attempt that fails is turned into a [`Finding`]: the cause is read from what
//! the points of the interfaces did ([`Evidence`](crate::system::Evidence)), from motions that nothing holds, and from the stiffness at the guilty
//! points. Findings of both kinds are the same type; they go into `summary.json`, and their places into `culprits.vtu`.
//!
//! The doctor only looks: nothing here changes a result.

mod balance;
mod check;
mod coupling;
mod culprits;
mod diagnose;
mod finding;
mod motions;
mod signs;
mod surfaces;
mod unjoined;
mod watch;

pub use finding::{DoctorCause, Finding, Guilty, MOST_GUILTY, Severity, What};

pub(super) use check::{body as body_at, examine};
pub(super) use culprits::write as write_culprits;
pub(super) use diagnose::{MORE_MEMORY, diagnose, stopped};
pub(super) use unjoined::Unjoined;
pub(super) use watch::{Watch, watched};

use crate::error::RunError;
use crate::newton::Statistics;

/// Most findings that a summary keeps.
const MOST_FINDINGS: usize = 200;

/// What the doctor has to know of an attempt from before it began.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Chart {
    iterations: usize,
    continuations: usize,
    augmentations: usize,
}

impl Chart {
    /// Counts at the start of an attempt.
    pub fn of(statistics: &Statistics) -> Self {
        Chart {
            iterations: statistics.iterations,
            continuations: statistics.continuations,
            augmentations: statistics.augmentations,
        }
    }
}

/// The error of a run at time `t` that ends because of a mistake in the model.
pub(super) fn mistake(finding: &Finding, t: f64) -> RunError {
    let step = finding
        .step
        .as_deref()
        .map_or(String::new(), |s| format!("step {s}: "));
    RunError {
        message: format!("{step}{}", finding.message),
        time: t,
        culprits: finding.guilty.iter().map(Guilty::to_string).collect(),
        help: (!finding.advice.is_empty()).then(|| finding.advice.join("; ")),
    }
}

/// Adds a finding to those of a run. Where there are too many the last one takes the place of the one before it.
pub(super) fn note(findings: &mut Vec<Finding>, finding: Finding) {
    if findings.len() >= MOST_FINDINGS {
        findings.pop();
    }
    findings.push(finding);
}
