//! What waits: accepted increments for their interiors, or to be reported, and an attempt that failed until they are.

use std::sync::Arc;

use crate::assess::doctor;
use crate::model::frame::ContactMemory;
use crate::newton::Progress;
use crate::results::observer::Advance;
use crate::solve::accepted::Accepted;
use crate::solve::condenser::Candidates;
use crate::system::StepFailure;
use crate::time::Trial;

/// An accepted increment that has not been reported.
#[derive(Clone, crate::keep::Keep)]
pub(crate) struct Pending {
    pub trial: Trial,
    pub accepted: Accepted,
    /// Number of the increment in its step, and of the attempt.
    pub increment: usize,
    pub attempt: usize,
    /// Whether fields, and a row of the history, are due.
    pub fields: bool,
    pub row: bool,
    /// Newton iterations that have not been reported.
    pub(super) seen: Vec<Progress>,
    /// What interfaces and couplings knew after it; `None` if it is reported at once.
    pub(super) after: Option<Arc<ContactMemory>>,
    /// What the interior of a condensed increment follows from; `None` where it is known.
    pub(super) found: Option<Candidates>,
}

impl Pending {
    /// It at a glance.
    pub fn advance(&self) -> Advance {
        Advance {
            increment: self.increment,
            attempt: self.attempt,
            iterations: self.accepted.effort.iterations,
            time: self.trial.to,
            residual: self.accepted.effort.residual,
            tally: self.accepted.effort.tally,
        }
    }
}

/// An increment that was accepted and taken back, with all that came after it.
pub(crate) struct TakenBack {
    pub(super) trial: Trial,
    /// Its number in the step.
    pub(super) increment: usize,
    pub(super) failure: StepFailure,
}

/// An attempt that failed.
#[derive(Clone, crate::keep::Keep)]
pub(super) struct Failed {
    pub(super) trial: Trial,
    /// Counts from before it.
    pub(super) counters: doctor::Counters,
    pub(super) failure: StepFailure,
}
