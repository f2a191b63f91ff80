use super::Problem;
use crate::error::Diagnostic;
pub(super) fn check(_p: &Problem) -> Vec<Diagnostic> {
    Vec::new()
}
