//! Who looks on while an analysis runs, and what they are told.

use super::analysis::Analysis;
use super::history::Row;
use crate::assess::doctor::Finding;
use crate::error::Error;
use crate::modal::ModalOutcome;
use crate::newton::Progress;
use crate::system::{StepFailure, Tally};
use crate::time::Trial;

/// What observers are told.
pub enum Event<'a> {
    /// A Newton iteration.
    Iteration(&'a Progress),
    /// An increment was accepted. What comes of it may be told later, with others.
    Accepted(&'a Advance),
    /// What came of an accepted increment: the history row.
    Increment(&'a Row),
    /// A cycle of a step with cycles is over: what it took, a row of `cycles.csv`.
    Cycle(&'a Row),
    /// Something a user should know.
    Note(&'a str),
    /// What the doctor found in the model before the first step.
    Finding(&'a Finding),
    /// Fields are due at the state of the simulation.
    Output,
    /// Modes were found about the state of the simulation.
    Modes(&'a ModalOutcome),
    /// An increment failed and will be tried again, smaller.
    Cutback(&'a Trial, &'a StepFailure),
    /// The state from which the run can go on, as bytes.
    Checkpoint(&'a Snapshot),
    /// The run is over, well or not.
    End,
}

/// The state from which a run can go on, and what is worth knowing of it.
#[derive(Debug, Clone, Default, PartialEq, crate::keep::Keep)]
pub struct Snapshot {
    /// Accepted increments.
    pub increments: usize,
    /// Its time `[the problem's unit of time]`.
    pub time: f64,
    /// The index of the step at hand.
    pub step: usize,
    /// Whether that has ended.
    pub ended: bool,
    /// The state, see [`Checkpoint`](crate::run::Checkpoint).
    pub state: Vec<u8>,
}

/// An accepted increment at a glance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Advance {
    /// Number of the increment in its step, and of the attempt.
    pub increment: usize,
    /// Attempts it took.
    pub attempt: usize,
    /// Newton iterations.
    pub iterations: usize,
    /// Its end `[s]`.
    pub time: f64,
    /// Final residual relative to the scale of forces.
    pub residual: f64,
    /// Points by status.
    pub tally: Tally,
}

/// Looks on while a simulation runs.
pub trait Observer {
    /// Something happened. An error ends the run.
    fn see(&mut self, analysis: &Analysis, event: Event) -> Result<(), Error>;

    /// Waits for what goes on beside the run: asked for before the end is told, which says whether all went well.
    fn settle(&mut self) -> Result<(), Error> {
        Ok(())
    }

    /// What a user should know of what it did and what is no reason to end the run: asked for after every checkpoint, and told as notes.
    fn remarks(&mut self) -> Vec<String> {
        Vec::new()
    }
}
