//! How far an analysis has come.

use super::checkpoint::Standing;
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
    /// By how much the balance of energies opened over the first attempt at the increment at hand that was weighed and found too open, and how often it
    /// was halved since.
    pub(super) opened: Option<(f64, i32)>,
    /// The last increment must not be followed by a longer one.
    pub(super) tight: bool,
    /// An attempt that failed, kept until the increments before it are reported.
    pub(super) failed: Option<Failed>,
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
            tight: false,
            failed: None,
        }
    }

    /// Where they stand.
    pub fn standing(&self) -> Standing {
        Standing {
            pace: self.stepper.pace(),
            accepted: self.accepted,
            attempt: self.attempt,
            opened: self.opened,
            tight: self.tight,
            failed: self.failed.clone(),
        }
    }

    /// Those of a step that go on from where they stood.
    pub fn at(step: &Step, standing: Standing) -> Self {
        let Standing {
            pace,
            accepted,
            attempt,
            opened,
            tight,
            failed,
        } = standing;
        let fresh = Increments::of(step);
        Increments {
            stepper: fresh.stepper.at(pace),
            accepted,
            attempt,
            opened,
            tight,
            failed,
        }
    }
}
