//! Findings of building as errors.

use crate::error::{Diagnostic, Error, ProblemError};

/// An error of these findings.
pub(super) fn problem_error(findings: Vec<Diagnostic>) -> Error {
    ProblemError::from(findings).into()
}
