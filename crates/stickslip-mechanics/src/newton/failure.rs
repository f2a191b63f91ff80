//! Failures of linear systems as those of an increment.

use crate::linear::LinearError;
use crate::system::{Cause, StepFailure};

/// What a linear solver complains of.
pub fn describe(error: LinearError) -> StepFailure {
    let cause = match error {
        LinearError::Singular { .. }
        | LinearError::NotPositive { .. }
        | LinearError::Indefinite => Cause::Singular,
        LinearError::Engine { .. } => Cause::Engine,
        LinearError::NotFinite { .. } => Cause::NotFinite,
        LinearError::OutOfMemory { .. } => Cause::Memory,
        _ => Cause::LinearSolver,
    };
    StepFailure {
        dof: error.dof(),
        help: match &error {
            LinearError::Engine { help, .. } => Some(help.clone()),
            _ => None,
        },
        ..StepFailure::new(cause, error.to_string())
    }
}

/// The solution has an infinity or NaN.
pub(super) fn not_finite() -> StepFailure {
    StepFailure::new(Cause::NotFinite, "the linear solution is not finite")
}

/// The iteration ended before its tolerance.
pub(super) fn not_reached(iterations: usize) -> StepFailure {
    StepFailure::new(
        Cause::LinearSolver,
        format!("the linear solver did not reach its tolerance in {iterations} iterations"),
    )
    .help("a body may be nearly free to move; `stickslip check` lists free rigid-body modes")
}
