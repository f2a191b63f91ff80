//! How far an analysis has come.

use super::checkpoint::StepProgress;
use super::jumps::Jumps;
use super::queue::Failed;
use crate::model::definition::Step;
use crate::time::Stepper;

/// How far an analysis has come.
#[derive(Default)]
pub(crate) struct Steps {
    pub(super) begun: bool,
    pub(super) over: bool,
    /// The next step to begin.
    pub(super) next: usize,
    /// Increments of the step at hand.
    pub(super) running: Option<Increments>,
}

/// Increments of a step.
pub(super) struct Increments {
    pub(super) stepper: Stepper,
    pub(super) accepted: usize,
    pub(super) attempt: usize,
    /// By how much the balance of energies opened over the last increment that was found too long, and how many halvings in a row had not helped by then.
    pub(super) opened: Option<(f64, i32)>,
    /// Smaller increments make the balance of energies open no less.
    pub(super) no_progress: bool,
    /// The length of that increment; infinite before there was one.
    pub(super) too_long: f64,
    /// The last increment must not be followed by a longer one.
    pub(super) tight: bool,
    /// An attempt that failed, kept until the increments before it are reported.
    pub(super) failed: Option<Failed>,
    /// Jumps over cycles, where they are chosen.
    pub(super) jumps: Jumps,
}

impl Increments {
    pub fn of(step: &Step) -> Self {
        let stepper = Stepper::new(step.start, step.milestones.clone(), step.increments);
        Increments {
            stepper: match step.dynamic {
                Some(_) => stepper.doubling(),
                None => stepper,
            },
            accepted: 0,
            attempt: 1,
            opened: None,
            no_progress: false,
            too_long: f64::INFINITY,
            tight: false,
            failed: None,
            jumps: Jumps::default(),
        }
    }

    /// Where they stand.
    pub fn standing(&self) -> StepProgress {
        StepProgress {
            pace: self.stepper.pace(),
            accepted: self.accepted,
            attempt: self.attempt,
            opened: self.opened,
            no_progress: self.no_progress,
            too_long: self.too_long,
            tight: self.tight,
            failed: self.failed.clone(),
            jumps: self.jumps.clone(),
        }
    }

    /// Those of a step that go on from where they stood.
    pub fn at(step: &Step, standing: StepProgress) -> Self {
        Increments {
            stepper: Increments::of(step).stepper.at(standing.pace),
            accepted: standing.accepted,
            attempt: standing.attempt,
            opened: standing.opened,
            no_progress: standing.no_progress,
            too_long: standing.too_long,
            tight: standing.tight,
            failed: standing.failed,
            jumps: standing.jumps,
        }
    }
}
