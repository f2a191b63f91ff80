//! Floating bodies, those that only contact can hold: what is known of them, and what an attempt says of them.

use super::accepted::Accepted;
use super::rigid_part::rigid_part;
use crate::body::Anchors;
use crate::math::{add_scaled, norm};
use crate::model::contact::Contact;
use crate::model::definition::{Model, Step};
use crate::model::frame::ContactMemory;
use crate::model::rigid::drivers;
use crate::model::rigid::drivers::named;
use crate::model::rigid::free_bodies::FreeBody;
use crate::model::scene::Scene;
use crate::number::figure;
use crate::system::{Cause, Culprit, Force, StepFailure};
use crate::time::Trial;

/// What is known of floating bodies: those that only contact can hold.
#[derive(Default, Clone, crate::keep::Keep)]
pub(crate) struct Floating {
    pub(super) anchors: Option<Anchors>,
    /// The step for which bodies were looked at, and those that interfaces may hold.
    pub(super) known: Option<(usize, Vec<FreeBody>)>,
    /// Where they may be anchored, body by body.
    pub(super) places: Vec<Vec<usize>>,
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
    /// The largest load along free motions so far, body by body.
    pub(super) pushed: Vec<f64>,
    /// The bodies that nothing presses any more, and of which that was said in this step.
    pub(super) told: Vec<usize>,
}

/// Where an increment began in which bodies are moved or followed.
#[derive(Clone, crate::keep::Keep)]
pub(super) struct Origin {
    pub(super) u: Vec<f64>,
    /// Gaps that bodies may have to close `[m]`: the largest of each interface, all together, and how far obstacles move in the increment.
    pub(super) gaps: f64,
    /// Height of the cells at the surfaces that may touch, the largest mean of an interface `[m]`.
    pub(super) size: f64,
}

/// How often bodies are moved as rigid ones in one increment.
const MOST_MOVED: usize = 6;

/// How often anchors are laid anew, firmer.
const MOST_FIRMER: usize = 2;

/// How much further an unconstrained body may go than the gaps it has to close and what moves it do: it may turn about a point near what
/// pushes it. Tuned.
const LARGEST_LEVER: f64 = 10.0;

impl Floating {
    /// Whether a body is among those that contact may hold in the step at hand.
    pub fn knows(&self, body: usize) -> bool {
        let known = self.known.iter().flat_map(|(_, bodies)| bodies);
        known.into_iter().any(|free| free.bodies.contains(&body))
    }

    /// Looks for floating bodies anew before the next increment.
    pub fn forget(&mut self) {
        self.known = None;
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
            None => self.places.concat(),
        }
    }
}

impl Floating {
    pub(super) fn bodies(&self) -> &[FreeBody] {
        self.known.as_ref().map_or(&[], |(_, bodies)| bodies)
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
        let astray = accepted.and_then(|a| self.gone_astray(scene, a));
        self.astray = astray.is_some();
        if let Some(astray) = astray {
            // The anchors stay where they were: without them nothing would hold the body at all.
            return Err(thrown(scene, astray, trial));
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

    /// A floating body that has gone further since the increment began than there is reason to.
    fn gone_astray(&self, scene: Scene, accepted: &Accepted) -> Option<Astray> {
        let (dofs, model) = (scene.model.dofs, scene.model);
        let origin = self.origin.as_ref()?;
        let (_, bodies) = self.known.as_ref()?;
        let change = |p: usize| {
            let u = dofs.vector(&accepted.state.u, p);
            add_scaled(u, -1.0, dofs.vector(&origin.u, p))
        };
        // What the bodies that are held do, they may hand on; inside condensed ones it is not known yet.
        let constraints = scene.constraints(accepted.state.t);
        let prescribed = constraints
            .fixed
            .iter()
            .zip(&constraints.values)
            .zip(&origin.u);
        let prescribed = prescribed.filter(|((fixed, _), _)| **fixed);
        let moved = prescribed.map(|((_, to), from)| (to - from).abs());
        let prescribed = moved.fold(0.0, f64::max);
        // Whatever bends and pushes, nothing is flung through the whole model.
        let utmost = model.size + origin.gaps + prescribed;
        let mut moved = prescribed;
        let held = model.bodies.iter().enumerate();
        let held = held.filter(|(b, _)| bodies.iter().all(|free| !free.bodies.contains(b)));
        for (_, body) in held {
            moved = body
                .points
                .clone()
                .map(|p| norm(change(p)))
                .fold(moved, f64::max);
        }
        for (free, places) in bodies.iter().zip(&self.places) {
            let points: Vec<_> = places.iter().map(|&p| (p, change(p))).collect();
            let mut rigid = vec![0.0; accepted.state.u.len()];
            rigid_part(free, &points, dofs, &mut rigid);
            let strained = points
                .iter()
                .map(|&(p, moved)| norm(add_scaled(moved, -1.0, dofs.vector(&rigid, p))));
            let strained = strained.fold(0.0, f64::max);
            let ways = points.iter().map(|&(_, moved)| norm(moved));
            let way = ways.fold(0.0, |m, way| if way > m || way.is_nan() { way } else { m });
            let most = (LARGEST_LEVER * (origin.gaps + moved + strained) + origin.size).min(utmost);
            if way > most || way.is_nan() {
                return Some(Astray {
                    body: free.bodies[0],
                    name: free.name(model),
                    way,
                    most,
                });
            }
        }
        None
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

/// A floating body that has gone too far in an increment.
struct Astray {
    /// Its index, the first of those that are tied to it, and its name.
    body: usize,
    name: String,
    /// How far it went, and how far it might `[m]`.
    way: f64,
    most: f64,
}

/// The failure of an increment in which a body went astray.
fn thrown(scene: Scene, astray: Astray, trial: Trial) -> StepFailure {
    let Astray {
        body,
        name,
        way,
        most,
    } = astray;
    let drivers = drivers::drivers(&scene, body, trial.to);
    let by = match drivers.is_empty() {
        true => String::new(),
        false => format!(", {} it", named(&drivers, "drives", "drive")),
    };
    let mut failure = StepFailure::new(
        Cause::TooFar,
        format!(
            "body {name}, which only contact can hold, was thrown by {way}: what it has to follow and to close allows {most}{by}",
            way = figure(way),
            most = figure(most)
        ),
    );
    for driver in drivers {
        failure.culprits.push(Culprit {
            place: driver.key,
            what: driver.what,
            evidence: None,
        });
    }
    failure.help(
        "smaller increments; a law that presses across the gap, or points that are pressed in far by one increment, can throw a body that nothing else holds: support it, or hold it by weak springs (`[load.NAME] spring`)",
    )
}

/// The part of the largest load so far below which a load counts as zero: the residual that increments may leave, and so the remainder of the reaction of a released
/// support.
pub(super) fn no_load(model: &Model) -> f64 {
    model.solution.settings.tolerance
}
