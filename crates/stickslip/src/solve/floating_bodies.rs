//! Floating bodies, those that only contact can hold: what is known of them, and what an attempt says of them.

use super::accepted::Accepted;
use crate::body::Anchors;
use crate::model::contact::Contact;
use crate::model::definition::{Model, Step};
use crate::model::frame::ContactMemory;
use crate::model::rigid::astray::Origin;
use crate::model::rigid::drivers;
use crate::model::rigid::drivers::named;
use crate::model::rigid::floating::FloatingBodies;
use crate::model::rigid::free_bodies::FreeBody;
use crate::model::scene::Scene;
use crate::system::{Cause, Force, StepFailure};
use crate::time::Trial;

/// What is known of floating bodies: those that only contact can hold.
#[derive(Default, Clone, crate::keep::Keep)]
pub(crate) struct Floating {
    pub(super) anchors: Option<Anchors>,
    /// The step for which bodies were looked at; none if they are to be looked for anew.
    pub(super) step: Option<usize>,
    /// The bodies of that step.
    pub(super) bodies: FloatingBodies,
    /// Contact alone was found not to be enough in this step: the anchors stay.
    pub(super) stay: bool,
    /// The bodies are unconstrained: they have been followed without coming to rest.
    pub(super) no_progress: bool,
    /// How often the bodies were moved as rigid ones in this increment.
    pub(super) moved: usize,
    /// How often anchors proved too weak in this step.
    pub(super) firmness: usize,
    /// Anchors have failed, and bodies were not adrift.
    pub(super) weak: bool,
    /// The anchors were laid in the increment at hand.
    pub(super) fresh: bool,
    /// Energy left in the anchors.
    pub(super) left: f64,
    /// A body went astray in the last attempt.
    pub(super) astray: bool,
    /// Where the increment at hand began, before bodies were moved.
    pub(super) origin: Option<Origin>,
    /// The bodies that nothing presses any more, and of which that was said in this step.
    pub(super) told: Vec<usize>,
}

/// How often bodies are moved as rigid ones in one increment.
const MOST_MOVED: usize = 6;

/// How often anchors are laid anew, firmer.
const MOST_FIRMER: usize = 2;

impl Floating {
    /// Whether a body is among those that contact may hold in the step at hand.
    pub fn knows(&self, body: usize) -> bool {
        self.bodies().iter().any(|free| free.bodies.contains(&body))
    }

    /// Looks for floating bodies anew before the next increment.
    pub fn forget(&mut self) {
        self.step = None;
        self.bodies = FloatingBodies::default();
        self.anchors = None;
    }

    /// Forgets which bodies float, their anchors, and what attempts have said of them; what anchors have taken up stays told.
    pub fn forget_all(&mut self) {
        *self = Floating {
            left: self.left,
            ..Floating::default()
        };
    }

    /// Whether bodies are anchored.
    pub fn is_anchored(&self) -> bool {
        self.anchors.is_some()
    }

    /// The forces with the anchors among them.
    pub fn with<'a>(&'a mut self, mut forces: Vec<&'a mut dyn Force>) -> Vec<&'a mut dyn Force> {
        if let Some(anchors) = &mut self.anchors {
            forces.push(anchors);
        }
        forces
    }

    /// Points of the mesh that are anchored, or may be. Without them a body that touches nothing has no point that is kept, and cannot be
    /// condensed.
    pub fn points(&self) -> Vec<usize> {
        match &self.anchors {
            Some(anchors) => anchors.points().collect(),
            None => self.bodies.places.concat(),
        }
    }
}

impl Floating {
    pub(super) fn bodies(&self) -> &[FreeBody] {
        &self.bodies.free
    }

    /// Whether springs hold bodies that nothing else does.
    pub fn anchored(&self) -> bool {
        self.anchors.is_some()
    }

    /// Energy left in anchors over the strain energy of the model.
    pub fn artificial_energy(&self, strain: f64) -> f64 {
        if self.left == 0.0 {
            0.0
        } else {
            self.left / strain.max(f64::MIN_POSITIVE)
        }
    }
}

impl Floating {
    /// Whether unconstrained motions that are not stabilised yet may explain a failure.
    pub fn may_follow(&self, step: &Step, failure: &StepFailure) -> bool {
        let floating = self;
        step.dynamic.is_none()
            && (floating.astray || matches!(failure.cause, Cause::Singular | Cause::LinearSolver))
            && floating.anchors.is_none()
            && !floating.no_progress
            && !floating.bodies().is_empty()
    }

    /// Whether a body went astray in the last attempt.
    pub fn went_astray(&self) -> bool {
        self.astray
    }

    /// What an attempt with anchors says of the bodies: those that are still on their way are held by nothing, and those that have gone further than
    /// they had to have been thrown.
    pub fn judge(
        &mut self,
        scene: Scene,
        outcome: Result<Accepted, StepFailure>,
        trial: Trial,
    ) -> Result<Accepted, StepFailure> {
        let accepted = outcome.as_ref().ok();
        let known = self.step.is_some();
        let origin = self.origin.as_ref().filter(|_| known);
        let both = accepted.zip(origin);
        let astray = both.and_then(|(a, origin)| origin.astray(&scene, &self.bodies, &a.state));
        self.astray = astray.is_some();
        if let Some(astray) = astray {
            // The anchors stay where they were: without them nothing would hold the body at all.
            return Err(astray.failure(&scene, trial));
        }
        let floating = self;
        let Some(anchors) = &floating.anchors else {
            return outcome;
        };
        match outcome {
            Err(failure) if matches!(failure.cause, Cause::Reach | Cause::Interrupted) => {
                Err(failure)
            }
            Err(failure) => {
                let unbalanced = anchors.unbalanced();
                floating.anchors = None;
                floating.moved = 0;
                floating.weak = !unbalanced;
                if !unbalanced {
                    // Smaller increments may help; anchors once more would not.
                    let cause = match failure.cause {
                        Cause::Singular | Cause::LinearSolver => Cause::NotConverged,
                        other => other,
                    };
                    return Err(StepFailure { cause, ..failure });
                }
                floating.no_progress = true;
                let far = floating.first(scene, trial);
                Err(StepFailure {
                    cause: Cause::Singular,
                    message: format!("{far} has been followed, but contact does not hold it"),
                    ..failure
                })
            }
            Ok(accepted) => Ok(Accepted {
                followed: floating.fresh,
                ..accepted
            }),
        }
    }

    /// Whether an increment that failed is to be computed again with stiffer anchors.
    pub fn wants_stiffer_anchors(&mut self, failure: &StepFailure) -> bool {
        let floating = self;
        if !floating.weak || failure.cause == Cause::Reach || floating.firmness >= MOST_FIRMER {
            return false;
        }
        floating.weak = false;
        floating.firmness += 1;
        true
    }

    /// Whether an increment is to be computed again, as the bodies went so far that it should start where they have come. If not, the increment stands, and
    /// the anchors have done their part; `followed` counts such increments. Where a body rubs on something as the increment begins its way is slip, and is not
    /// to be made before.
    pub fn wants_restart(
        &mut self,
        model: &Model,
        contact: &Contact,
        contacts: &ContactMemory,
        followed: &mut usize,
    ) -> bool {
        let rubs = self
            .bodies()
            .iter()
            .any(|free| free.rubs(model, contact, contacts));
        let floating = self;
        let Some(anchors) = &mut floating.anchors else {
            floating.moved = 0;
            floating.origin = None;
            return false;
        };
        // The increment is computed once more if more than half of a round of the anchors is made without strain before.
        if anchors.travel() > 0.5 && floating.moved < MOST_MOVED && !rubs {
            return true;
        }
        floating.moved = 0;
        floating.origin = None;
        floating.left = anchors.left();
        floating.fresh = false;
        *followed += 1;
        match floating.stay {
            true => anchors.rest(),
            false => floating.anchors = None,
        }
        false
    }

    /// The first of the bodies that were followed and what drives it, for a sentence.
    fn first(&self, scene: Scene, trial: Trial) -> String {
        let Some(first) = self.bodies().first() else {
            return "a body".into();
        };
        let drivers = drivers::drivers(&scene, first.bodies[0], trial.to);
        let name = first.name(scene.model);
        match drivers.is_empty() {
            true => format!("body {name}"),
            false => format!("body {name}, which {},", named(&drivers, "drives", "drive")),
        }
    }
}
