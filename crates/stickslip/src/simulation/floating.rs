//! Bodies that only contact can hold, in quasi-static steps: they are moved until they touch, and anchored until contact holds them.

use super::accepted::Accepted;
use super::contact::Contact;
use super::drivers::named;
use super::frame::Frame;
use super::free_bodies::FreeBody;
use super::model::{Model, Step};
use super::rigid_closure::{close, pushes};
use super::scene::Scene;
use super::solver::Solver;
use crate::body::{Anchors, Hold, spread};
use crate::contact::interface::Interface;
use crate::math::{Vec3, add_scaled, dot, norm};
use crate::system::{Cause, Culprit, Force, Stage, State, StepFailure};
use crate::time::Trial;

/// What is known of floating bodies: those that only contact can hold.
#[derive(Default)]
pub(super) struct Floating {
    anchors: Option<Anchors>,
    /// The step for which bodies were looked at, and those that interfaces may hold.
    known: Option<(usize, Vec<FreeBody>)>,
    /// Where they may be anchored, body by body.
    places: Vec<Vec<usize>>,
    /// Contact alone was found not to be enough in this step: the anchors stay.
    stay: bool,
    /// Nothing holds the bodies: they have been followed in vain.
    vain: bool,
    /// How often the bodies were moved as rigid ones in this increment.
    moved: usize,
    /// How often anchors proved too weak in this step.
    firmness: usize,
    /// Anchors have failed, and bodies were not adrift.
    weak: bool,
    /// The anchors were laid in the increment at hand.
    fresh: bool,
    /// Energy left in the anchors.
    left: f64,
    /// A body went astray in the last attempt.
    astray: bool,
    /// Where the increment at hand began, before bodies were moved.
    origin: Option<Origin>,
}

/// Where an increment began in which bodies are moved or followed.
struct Origin {
    u: Vec<f64>,
    /// Gaps that bodies may have to close `[m]`: the largest of each interface, all together, and how far obstacles move in the increment.
    gaps: f64,
    /// Height of the cells at the surfaces that may touch, the largest mean of an interface `[m]`.
    size: f64,
}

/// Way in rounds of the anchors that is made without strain before the increment is computed once more.
const LONG: f64 = 0.5;

/// How often bodies are moved as rigid ones in one increment.
const MOST_MOVED: usize = 6;

/// How often anchors are laid anew, firmer.
const MOST_FIRMER: usize = 2;

/// Part of a cell that a body may move in a round.
const REACH: f64 = 0.25;

/// How much further a loose body may go than the gaps it has to close and what moves it do: it may turn about a point near what pushes it.
const LEVER: f64 = 10.0;

/// Component of a motion along a normal from which on contact may resist it.
const RESISTED: f64 = 1e-6;

impl Floating {
    /// Whether a body is among those that contact may hold in the step at hand.
    pub fn knows(&self, body: usize) -> bool {
        let known = self.known.iter().flat_map(|(_, bodies)| bodies);
        known.into_iter().any(|free| free.body == body)
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
    fn bodies(&self) -> &[FreeBody] {
        self.known.as_ref().map_or(&[], |(_, bodies)| bodies)
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

impl Solver {
    /// Finds the bodies that supports leave free and interfaces may hold in the step at hand.
    pub fn find_floating_bodies(&mut self, model: &Model, frame: &Frame, contact: &Contact) {
        if matches!(self.floating.known, Some((step, _)) if step == frame.step) {
            return;
        }
        let step = &model.steps[frame.step];
        let middle = 0.5 * (step.start + step.end);
        let scene = Scene {
            model,
            contact,
            frame,
        };
        let mut bodies = Vec::new();
        if model.follow && !contact.interfaces.is_empty() {
            bodies = scene.free_bodies(middle);
        }
        let active = |i: &&Interface| i.schedule.active(middle);
        let interfaces: Vec<&Interface> = contact.interfaces.iter().filter(active).collect();
        let dofs = model.dofs;
        let mut resisted = false;
        bodies.retain(|free| {
            let points = &model.bodies[free.body].points;
            let mut met = false;
            for interface in &interfaces {
                for (point, normal) in interface.normals() {
                    if points.contains(&point) {
                        met = true;
                        resisted |= free.motions.iter().any(|(_, motion)| {
                            dot(dofs.vector(motion, point), normal).abs() > RESISTED
                        });
                    }
                }
            }
            met
        });
        if !resisted {
            bodies.clear();
        }
        let place = |free: &FreeBody| {
            let points = model.bodies[free.body].points.clone();
            spread(&model.mesh, points, dofs.dim + 1)
        };
        self.floating = Floating {
            places: bodies.iter().map(place).collect(),
            known: Some((frame.step, bodies)),
            left: self.floating.left,
            ..Floating::default()
        };
    }

    /// Whether floating bodies touch nothing yet and are to be moved until they do.
    pub fn has_gaps_to_close(&mut self, model: &Model, frame: &Frame, contact: &Contact) -> bool {
        self.find_floating_bodies(model, frame, contact);
        let floating = &self.floating;
        let bodies = floating.bodies();
        if bodies.is_empty() || floating.anchors.is_some() || floating.vain || floating.moved > 0 {
            return false;
        }
        let untouched = |free: &FreeBody| {
            let points = &model.bodies[free.body].points;
            let mut all = contact.interfaces.iter();
            all.all(|i| !i.touched() || !i.nodes.iter().any(|n| points.contains(n)))
        };
        bodies.iter().any(untouched)
    }

    /// Moves floating bodies that touch nothing yet until they do, and anchors them.
    pub fn close_gaps(
        &mut self,
        model: &Model,
        frame: &mut Frame,
        contact: &mut Contact,
        trial: Trial,
    ) {
        if self.close_all(model, frame, contact, trial) {
            self.anchor(model, frame, contact, trial);
        }
    }

    /// Anchors the bodies that nothing else holds.
    pub fn follow(
        &mut self,
        model: &Model,
        frame: &mut Frame,
        contact: &mut Contact,
        trial: Trial,
    ) {
        self.close_all(model, frame, contact, trial);
        self.floating.stay = true;
        if !self.floating.vain {
            self.anchor(model, frame, contact, trial);
        }
    }

    /// Moves floating bodies until they touch; whether any has moved.
    fn close_all(
        &mut self,
        model: &Model,
        frame: &mut Frame,
        contact: &mut Contact,
        trial: Trial,
    ) -> bool {
        self.set_out(frame, contact, (trial, false));
        let external = frame.external(model, trial.to);
        let bodies = self.floating.bodies();
        let closure = close(model, frame, contact, (bodies, &external), trial);
        let mut names = Vec::new();
        for (free, &moved) in bodies.iter().zip(&closure.moved) {
            if moved > 0.0 {
                names.push(format!("{} by {moved:.3e}", model.bodies[free.body].name));
            }
        }
        if let Some(origin) = &mut self.floating.origin {
            // As far as there is room.
            origin.gaps += closure.moved.iter().copied().fold(0.0, f64::max);
        }
        if !closure.adrift.is_empty() {
            self.floating.vain = true;
            return false;
        }
        if names.is_empty() {
            return false;
        }
        self.log.notes.push(format!(
            "moved without strain until they touch: {}",
            names.join(", ")
        ));
        self.set_displacements(model, frame, contact, closure.u);
        true
    }

    /// Takes other displacements, which differ by motions without strain, as the last state.
    fn set_displacements(
        &mut self,
        model: &Model,
        frame: &mut Frame,
        contact: &mut Contact,
        u: Vec<f64>,
    ) {
        frame.state.u = u;
        model.links.impose(&mut frame.state.u);
        frame.previous = None;
        self.condenser.forget_direction();
        self.choose_candidates(model, frame, contact);
        self.condenser.drop_at_rest();
        self.condense(model, frame, contact);
    }

    /// Lays anchors.
    pub fn anchor(&mut self, model: &Model, frame: &Frame, contact: &mut Contact, trial: Trial) {
        self.set_out(frame, contact, (trial, false));
        let external = frame.external(model, trial.to);
        let pushes = pushes(model, &external).into_iter();
        let force = pushes.map(|p| norm(p.force)).fold(0.0, f64::max);
        let mut anchors = Anchors::new(model.dofs);
        let mut names = Vec::new();
        let floating = &self.floating;
        for (free, points) in floating.bodies().iter().zip(&floating.places) {
            let body = &model.bodies[free.body];
            let (mut spring, mut size) = (0.0_f64, f64::INFINITY);
            for interface in &contact.interfaces {
                if interface.nodes.iter().any(|n| body.points.contains(n)) {
                    let (k, h) = interface.typical();
                    spring = spring.max(k);
                    size = size.min(h);
                }
            }
            let hold = Hold {
                spring,
                force,
                max_step: REACH * size,
                size,
                firmness: floating.firmness,
            };
            anchors.hold(points.clone(), &frame.state.u, hold);
            let motions: Vec<&str> = free.motions.iter().map(|(name, _)| name.as_str()).collect();
            names.push(format!("{} ({})", body.name, motions.join(", ")));
        }
        self.log.notes.push(format!(
            "followed until contact holds them: {}",
            names.join("; ")
        ));
        self.floating.anchors = Some(anchors);
        self.floating.fresh = true;
        self.choose_candidates(model, frame, contact);
        self.condense(model, frame, contact);
    }

    /// Takes note of where the increment at hand began, and of the gaps there, if bodies float in it. While increments are `pending` interfaces know
    /// more of the last state than displacements do.
    pub fn set_out(
        &mut self,
        frame: &Frame,
        contact: &mut Contact,
        (trial, pending): (Trial, bool),
    ) {
        if self.floating.bodies().is_empty() || self.floating.origin.is_some() {
            return;
        }
        // Of condensed bodies the points that may touch, and those that are anchored, are known at once.
        let here = match self.condenser.at_rest() {
            Some(condensed) => condensed.state.clone(),
            None => frame.state.clone(),
        };
        let at = State {
            t: trial.to,
            ..here.clone()
        };
        let stage = Stage {
            from: &here,
            at: &at,
            dt: trial.to - trial.from,
            rate: None,
        };
        let (mut gaps, mut size) = (0.0, 0.0_f64);
        let interfaces = contact.interfaces.iter_mut();
        for interface in interfaces.filter(|i| i.schedule.active(trial.to)) {
            let own = match pending {
                true => interface.initial_gaps(),
                false => interface.gaps_at(&stage),
            };
            let own = own.into_iter().filter(|gap| gap.is_finite());
            gaps += own.map(f64::abs).fold(0.0, f64::max);
            gaps += interface.obstacle_way(trial.from, trial.to);
            size = size.max(interface.typical().1);
        }
        self.floating.origin = Some(Origin {
            u: here.u,
            gaps,
            size,
        });
    }

    /// Lets the increment start where anchored bodies have come as rigid ones.
    pub fn restart_from_rigid_motion(
        &mut self,
        model: &Model,
        frame: &mut Frame,
        contact: &mut Contact,
        trial: Trial,
    ) {
        let floating = &mut self.floating;
        floating.moved += 1;
        let Some(anchors) = floating.anchors.take() else {
            return;
        };
        let mut u = frame.state.u.clone();
        let mut names = Vec::new();
        for (k, free) in floating.bodies().iter().enumerate() {
            let way = rigid_part(free, &anchors.moved(k), model.dofs, &mut u);
            names.push(format!("{} by {way:.3e}", model.bodies[free.body].name));
        }
        self.log.notes.push(format!(
            "moved without strain to where contact holds them: {}",
            names.join(", ")
        ));
        self.set_displacements(model, frame, contact, u);
        self.anchor(model, frame, contact, trial);
    }
}

impl Floating {
    /// Whether a failure may come from bodies that nothing holds yet, and that have not been anchored.
    pub fn may_follow(&self, step: &Step, failure: &StepFailure) -> bool {
        let floating = self;
        step.dynamic.is_none()
            && (floating.astray || matches!(failure.cause, Cause::Singular | Cause::LinearSolver))
            && floating.anchors.is_none()
            && !floating.vain
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
                let adrift = anchors.adrift();
                floating.anchors = None;
                floating.moved = 0;
                floating.weak = !adrift;
                if !adrift {
                    // Smaller increments may help; anchors once more would not.
                    let cause = match failure.cause {
                        Cause::Singular | Cause::LinearSolver => Cause::NotConverged,
                        other => other,
                    };
                    return Err(StepFailure { cause, ..failure });
                }
                floating.vain = true;
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
    /// the anchors have done their part; `followed` counts such increments.
    pub fn wants_restart(&mut self, followed: &mut usize) -> bool {
        let floating = self;
        let Some(anchors) = &mut floating.anchors else {
            floating.moved = 0;
            floating.origin = None;
            return false;
        };
        if anchors.travel() > LONG && floating.moved < MOST_MOVED {
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
        let utmost = model.mesh.diameter() + origin.gaps + prescribed;
        let mut moved = prescribed;
        let held = model.bodies.iter().enumerate();
        let held = held.filter(|(b, _)| bodies.iter().all(|free| free.body != *b));
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
            let most = (LEVER * (origin.gaps + moved + strained) + origin.size).min(utmost);
            if way > most || way.is_nan() {
                return Some(Astray {
                    body: free.body,
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
        let drivers = scene.drivers(first.body, trial.to);
        let name = &scene.model.bodies[first.body].name;
        match drivers.is_empty() {
            true => format!("body {name}"),
            false => format!("body {name}, which {},", named(&drivers, "drives", "drive")),
        }
    }
}

/// A floating body that has gone too far in an increment.
struct Astray {
    /// Its index.
    body: usize,
    /// How far it went, and how far it might `[m]`.
    way: f64,
    most: f64,
}

/// The failure of an increment in which a body went astray.
fn thrown(scene: Scene, astray: Astray, trial: Trial) -> StepFailure {
    let Astray { body, way, most } = astray;
    let name = &scene.model.bodies[body].name;
    let drivers = scene.drivers(body, trial.to);
    let by = match drivers.is_empty() {
        true => String::new(),
        false => format!(", {} it", named(&drivers, "drives", "drive")),
    };
    let mut failure = StepFailure::new(
        Cause::TooFar,
        format!(
            "body {name}, which only contact can hold, was thrown by {way:.3e}: what it has to follow and to close allows {most:.3e}{by}"
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

/// Adds to `u` the free motion of a body that comes nearest to what some of its points have `moved`; its largest displacement there.
fn rigid_part(
    free: &FreeBody,
    moved: &[(usize, Vec3)],
    dofs: crate::system::Dofs,
    u: &mut [f64],
) -> f64 {
    let mut basis: Vec<Vec<f64>> = Vec::new();
    let over = |a: &[f64], b: &dyn Fn(usize, usize) -> f64| -> f64 {
        let mut sum = 0.0;
        for (n, (p, _)) in moved.iter().enumerate() {
            for c in 0..dofs.dim {
                sum += a[dofs.of(*p, c)] * b(n, c);
            }
        }
        sum
    };
    // Orthonormal with regard to the anchored points.
    for (_, motion) in &free.motions {
        let mut v = motion.clone();
        for _ in 0..2 {
            for q in &basis {
                let s = over(&v, &|n, c| q[dofs.of(moved[n].0, c)]);
                v.iter_mut().zip(q).for_each(|(v, q)| *v -= s * q);
            }
        }
        let size = over(&v, &|n, c| v[dofs.of(moved[n].0, c)]).sqrt();
        if size > 1e-8 {
            v.iter_mut().for_each(|v| *v /= size);
            basis.push(v);
        }
    }
    let mut way: f64 = 0.0;
    let mut total = vec![0.0; u.len()];
    for q in &basis {
        let s = over(q, &|n, c| moved[n].1[c]);
        total.iter_mut().zip(q).for_each(|(t, q)| *t += s * q);
    }
    for (n, _) in moved.iter().enumerate() {
        way = way.max(norm(dofs.vector(&total, moved[n].0)));
    }
    u.iter_mut().zip(&total).for_each(|(u, t)| *u += t);
    way
}
