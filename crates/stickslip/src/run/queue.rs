//! What waits: accepted increments for their interiors, or to be reported, and an attempt that failed until they are.

use std::collections::VecDeque;

use crate::assess::doctor;
use crate::body::couplings::CouplingsMemory;
use crate::contact::interface::History;
use crate::newton::Progress;
use crate::results::observer::Advance;
use crate::solve::accepted::Accepted;
use crate::solve::condenser::Candidates;
use crate::system::StepFailure;
use crate::time::Trial;

/// An accepted increment that nobody has been told of.
#[derive(Clone)]
pub(crate) struct Pending {
    pub trial: Trial,
    pub accepted: Accepted,
    /// Number of the increment in its step, and of the attempt.
    pub increment: usize,
    pub attempt: usize,
    /// Whether fields, and a row of the history, are due.
    pub fields: bool,
    pub row: bool,
    /// Newton iterations nobody has been told of.
    pub(super) seen: Vec<Progress>,
    /// The histories of the interfaces after it; empty if it is reported at once.
    pub(super) histories: Vec<History>,
    /// The same of the couplings.
    pub(super) couplings: CouplingsMemory,
    /// What both knew before it, where nobody else remembers: in the first of those that wait.
    pub(super) before: Option<(Vec<History>, CouplingsMemory)>,
    /// What the interior of a condensed increment follows from; `None` where it is known.
    pub(super) found: Option<Candidates>,
}

impl Pending {
    /// An increment and attempt of these numbers, for which fields and a row of the history are due or not.
    pub fn new(
        trial: Trial,
        accepted: Accepted,
        (increment, attempt): (usize, usize),
        (fields, row): (bool, bool),
    ) -> Self {
        Pending {
            trial,
            accepted,
            increment,
            attempt,
            fields,
            row,
            seen: Vec::new(),
            histories: Vec::new(),
            couplings: CouplingsMemory::default(),
            before: None,
            found: None,
        }
    }

    /// It at a glance.
    pub fn advance(&self) -> Advance {
        Advance {
            increment: self.increment,
            attempt: self.attempt,
            iterations: self.accepted.iterations,
            time: self.trial.to,
            residual: self.accepted.residual,
            tally: self.accepted.tally,
        }
    }
}

crate::keep!(Pending {
    trial,
    accepted,
    increment,
    attempt,
    fields,
    row,
    seen,
    histories,
    couplings,
    before,
    found
});
crate::keep!(Recovered { queue, coupled });

/// Increments whose interiors are known, on their way to the observers.
#[derive(Clone)]
pub(crate) struct Recovered {
    pub(super) queue: VecDeque<Pending>,
    /// What the couplings knew after the last of them.
    pub(super) coupled: CouplingsMemory,
}

/// An increment that was accepted and taken back, with all that came after it.
pub(crate) struct TakenBack {
    pub(super) trial: Trial,
    /// Its number in the step.
    pub(super) increment: usize,
    pub(super) failure: StepFailure,
}

/// An attempt that failed.
#[derive(Clone)]
pub(super) struct Failed {
    pub(super) trial: Trial,
    /// Counts from before it.
    pub(super) counters: doctor::Counters,
    pub(super) failure: StepFailure,
}

crate::keep!(Failed {
    trial,
    counters,
    failure
});
