//! Findings of a run, and what is known of an attempt before it.

use super::finding::Finding;
use super::suspect::Suspect;
use crate::error::RunError;
use crate::newton::Statistics;

/// Most findings that a summary keeps.
const MOST_FINDINGS: usize = 200;

/// What the doctor has to know of an attempt from before it began.
#[derive(Debug, Clone, Copy, Default, crate::keep::Keep)]
pub(crate) struct Counters {
    pub(super) iterations: usize,
    pub(super) fallbacks: usize,
    pub(super) augmentations: usize,
}

impl Counters {
    /// Counts at the start of an attempt.
    pub fn of(statistics: &Statistics) -> Self {
        Counters {
            iterations: statistics.iterations,
            fallbacks: statistics.fallbacks,
            augmentations: statistics.augmentations,
        }
    }
}

/// The error of a run at time `t` that ends because of a mistake in the model.
pub(crate) fn mistake(finding: &Finding, t: f64) -> RunError {
    let step = finding
        .step
        .as_deref()
        .map_or(String::new(), |s| format!("step {s}: "));
    RunError {
        message: format!("{step}{}", finding.message),
        time: t,
        culprits: finding.suspects.iter().map(Suspect::to_string).collect(),
        help: (!finding.advice.is_empty()).then(|| finding.advice.join("; ")),
    }
}

/// Adds a finding to those of a run. Where there are too many the last one takes the place of the one before it.
pub(crate) fn note(findings: &mut Vec<Finding>, finding: Finding) {
    if findings.len() >= MOST_FINDINGS {
        findings.pop();
    }
    findings.push(finding);
}
