//! Findings of building as errors.

use crate::error::{Diagnostic, Error, ProblemError};

impl Diagnostic {
    /// The same with its key below `parent`.
    pub(crate) fn under(mut self, parent: &str) -> Self {
        self.key = match self.key.as_str() {
            "" => parent.to_string(),
            key => format!("{parent}.{key}"),
        };
        self
    }
}

/// An error of these findings.
pub(super) fn problem_error(findings: Vec<Diagnostic>) -> Error {
    Error::Problem(ProblemError {
        file: None,
        source: String::new(),
        findings,
    })
}
