//! Bodies that only contact can hold, in quasi-static steps: they are moved until they touch, and anchored until contact holds them.

use super::accepted::Accepted;
use super::diagnosis::{FreeBody, free_bodies};
use super::drivers::named;
use super::model::Step;
use super::run::{Observer, Simulation};
use crate::body::{Anchors, Hold, spread};
use crate::contact::interface::Interface;
use crate::error::Error;
use crate::math::{Vec3, add_scaled, dot, norm};
use crate::system::{Cause, Culprit, Force, Stage, State, StepFailure};
use crate::time::Trial;

/// What is known of bodies that only contact can hold.
#[derive(Default)]
pub(super) struct Loose {
    anchors: Option<Anchors>,
    /// The step for which bodies were looked at, and those that interfaces may hold.
    known: Option<(usize, Vec<FreeBody>)>,
    /// Where they may be anchored, body by body.
    places: Vec<Vec<usize>>,
    /// Contact alone was found not to be enough in this step: the anchors stay.
    stay: bool,
    /// Nothing holds the bodies: they have been followed in vain.
    vain: bool,
    /// How often the bodies were put elsewhere in this increment.
    put: usize,
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

/// How often bodies are put elsewhere in one increment.
const MOST_PUT: usize = 6;

/// How often anchors are laid anew, firmer.
const MOST_FIRMER: usize = 2;

/// Part of a cell that a body may move in a round.
const REACH: f64 = 0.25;

/// How much further a loose body may go than the gaps it has to close and what moves it do: it may turn about a point near what pushes it.
const LEVER: f64 = 10.0;

/// Component of a motion along a normal from which on contact may resist it.
const RESISTED: f64 = 1e-6;

impl Loose {
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

impl Simulation {
    /// Finds the bodies that supports leave free and interfaces may hold.
    pub(super) fn know(&mut self) {
        if matches!(self.loose.known, Some((step, _)) if step == self.step) {
            return;
        }
        let step = &self.model.steps[self.step];
        let middle = 0.5 * (step.start + step.end);
        let mut bodies = Vec::new();
        if self.model.follow && !self.model.interfaces.is_empty() {
            bodies = free_bodies(self, middle);
        }
        let active = |i: &&Interface| i.schedule.active(middle);
        let interfaces: Vec<&Interface> = self.model.interfaces.iter().filter(active).collect();
        let dofs = self.model.dofs;
        let mut resisted = false;
        bodies.retain(|free| {
            let points = &self.model.bodies[free.body].points;
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
            let points = self.model.bodies[free.body].points.clone();
            spread(&self.model.mesh, points, dofs.dim + 1)
        };
        self.loose = Loose {
            places: bodies.iter().map(place).collect(),
            known: Some((self.step, bodies)),
            left: self.loose.left,
            ..Loose::default()
        };
    }

    /// Moves loose bodies that touch nothing yet until they do.
    pub(super) fn meet(
        &mut self,
        trial: Trial,
        observers: &mut [&mut dyn Observer],
    ) -> Result<(), Error> {
        self.know();
        let loose = &self.loose;
        let Some((_, bodies)) = &loose.known else {
            return Ok(());
        };
        if bodies.is_empty() || loose.anchors.is_some() || loose.vain || loose.put > 0 {
            return Ok(());
        }
        let untouched = |free: &FreeBody| {
            let points = &self.model.bodies[free.body].points;
            let mut all = self.model.interfaces.iter();
            all.all(|i| !i.touched() || !i.nodes.iter().any(|n| points.contains(n)))
        };
        if !bodies.iter().any(untouched) {
            return Ok(());
        }
        if self.approach_all(trial, observers)? {
            self.anchor(trial, observers)?;
        }
        Ok(())
    }

    /// Whether a failure may come from bodies that nothing holds yet, and that have not been anchored.
    pub(super) fn may_follow(&self, step: &Step, failure: &StepFailure) -> bool {
        let known = self.loose.known.as_ref();
        step.dynamic.is_none()
            && (self.loose.astray || matches!(failure.cause, Cause::Singular | Cause::LinearSolver))
            && self.loose.anchors.is_none()
            && !self.loose.vain
            && known.is_some_and(|(_, bodies)| !bodies.is_empty())
    }

    /// Anchors the bodies that nothing else holds.
    pub(super) fn follow(
        &mut self,
        trial: Trial,
        observers: &mut [&mut dyn Observer],
    ) -> Result<(), Error> {
        self.approach_all(trial, observers)?;
        self.loose.stay = true;
        if !self.loose.vain {
            self.anchor(trial, observers)?;
        }
        Ok(())
    }

    /// Moves loose bodies until they touch; whether any has moved.
    fn approach_all(
        &mut self,
        trial: Trial,
        observers: &mut [&mut dyn Observer],
    ) -> Result<bool, Error> {
        self.flush(observers)?;
        self.set_out(trial);
        let Some((step, bodies)) = self.loose.known.take() else {
            return Ok(false);
        };
        let external = self.external(trial.to);
        let found = self.approach(&bodies, &external, trial);
        if let Some(origin) = &mut self.loose.origin {
            // As far as there is room.
            origin.gaps += found.moved.iter().copied().fold(0.0, f64::max);
        }
        let mut names = Vec::new();
        for (free, &moved) in bodies.iter().zip(&found.moved) {
            if moved > 0.0 {
                let name = &self.model.bodies[free.body].name;
                names.push(format!("{name} by {moved:.3e}"));
            }
        }
        self.loose.known = Some((step, bodies));
        if !found.adrift.is_empty() {
            self.loose.vain = true;
            return Ok(false);
        }
        if names.is_empty() {
            return Ok(false);
        }
        self.notes.push(format!(
            "moved without strain until they touch: {}",
            names.join(", ")
        ));
        self.put(found.u, observers)?;
        Ok(true)
    }

    /// Takes other displacements, which differ by motions without strain, as the last state.
    fn put(&mut self, u: Vec<f64>, observers: &mut [&mut dyn Observer]) -> Result<(), Error> {
        self.flush(observers)?;
        self.state.u = u;
        self.model.links.impose(&mut self.state.u);
        self.forget_direction();
        self.provide(observers, true)
    }

    /// Sees to it that the solver knows the points that may touch now, and those that are anchored.
    fn provide(&mut self, observers: &mut [&mut dyn Observer], moved: bool) -> Result<(), Error> {
        self.choose_candidates();
        if moved {
            self.condensed = None;
        }
        self.condense()?;
        self.tell_notes(observers)
    }

    /// Lays anchors.
    fn anchor(&mut self, trial: Trial, observers: &mut [&mut dyn Observer]) -> Result<(), Error> {
        self.flush(observers)?;
        self.set_out(trial);
        let external = self.external(trial.to);
        let pushes = self.pushes(&external).into_iter();
        let force = pushes.map(|p| norm(p.force)).fold(0.0, f64::max);
        let model = &self.model;
        let mut anchors = Anchors::new(model.dofs);
        let mut names = Vec::new();
        let bodies = self.loose.known.iter().flat_map(|(_, bodies)| bodies);
        for (free, points) in bodies.zip(&self.loose.places) {
            let body = &model.bodies[free.body];
            let (mut spring, mut size) = (0.0_f64, f64::INFINITY);
            for interface in &model.interfaces {
                if interface.nodes.iter().any(|n| body.points.contains(n)) {
                    let (k, h) = interface.typical();
                    spring = spring.max(k);
                    size = size.min(h);
                }
            }
            let hold = Hold {
                spring,
                force,
                reach: REACH * size,
                size,
                firmness: self.loose.firmness,
            };
            anchors.hold(points.clone(), &self.state.u, hold);
            let motions: Vec<&str> = free.motions.iter().map(|(name, _)| name.as_str()).collect();
            names.push(format!("{} ({})", body.name, motions.join(", ")));
        }
        self.notes.push(format!(
            "followed until contact holds them: {}",
            names.join("; ")
        ));
        self.loose.anchors = Some(anchors);
        self.loose.fresh = true;
        self.provide(observers, false)
    }

    /// Takes note of where the increment at hand began, and of the gaps there, if bodies are loose in it.
    pub(super) fn set_out(&mut self, trial: Trial) {
        let known = self.loose.known.as_ref();
        let none = known.is_none_or(|(_, bodies)| bodies.is_empty());
        if none || self.loose.origin.is_some() {
            return;
        }
        // Of condensed bodies the points that may touch, and those that are anchored, are known at once.
        let here = match &self.condensed {
            Some(condensed) => condensed.state.clone(),
            None => self.state.clone(),
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
        let pending = !self.pending.is_empty();
        let interfaces = self.model.interfaces.iter_mut();
        for interface in interfaces.filter(|i| i.schedule.active(trial.to)) {
            // While increments are pending the interfaces know more of the last state than displacements do.
            let own = match pending {
                true => interface.initial_gaps(),
                false => interface.gaps_at(&stage),
            };
            let own = own.into_iter().filter(|gap| gap.is_finite());
            gaps += own.map(f64::abs).fold(0.0, f64::max);
            gaps += interface.obstacle_way(trial.from, trial.to);
            size = size.max(interface.typical().1);
        }
        self.loose.origin = Some(Origin {
            u: here.u,
            gaps,
            size,
        });
    }

    /// A loose body that has gone further since the increment began than there is reason to: its index, how far it went, and how far it might.
    fn astray(&self, accepted: &Accepted) -> Option<(usize, f64, f64)> {
        let (dofs, model) = (self.model.dofs, &self.model);
        let origin = self.loose.origin.as_ref()?;
        let bodies = self.loose.known.as_ref().map(|(_, bodies)| bodies)?;
        let change = |p: usize| {
            let u = dofs.vector(&accepted.state.u, p);
            add_scaled(u, -1.0, dofs.vector(&origin.u, p))
        };
        // What the bodies that are held do, they may hand on; inside condensed ones it is not known yet.
        let constraints = self.constraints(accepted.state.t);
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
        for (free, places) in bodies.iter().zip(&self.loose.places) {
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
                return Some((free.body, way, most));
            }
        }
        None
    }

    /// What an attempt with anchors says of the bodies: those that are still on their way are held by nothing, and those that have gone further than
    /// they had to have been thrown.
    pub(super) fn judge_loose(
        &mut self,
        outcome: Result<Accepted, StepFailure>,
        trial: Trial,
    ) -> Result<Accepted, StepFailure> {
        let astray = outcome.as_ref().ok().and_then(|a| self.astray(a));
        self.loose.astray = astray.is_some();
        if let Some(astray) = astray {
            // The anchors stay where they were: without them nothing would hold the body at all.
            self.forget_direction();
            return Err(self.thrown(astray, trial));
        }
        let Some(anchors) = &self.loose.anchors else {
            return outcome;
        };
        match outcome {
            Err(failure) if matches!(failure.cause, Cause::Reach | Cause::Interrupted) => {
                Err(failure)
            }
            Err(failure) => {
                let adrift = anchors.adrift();
                self.loose.anchors = None;
                self.loose.put = 0;
                self.loose.weak = !adrift;
                if !adrift {
                    // Smaller increments may help; anchors once more would not.
                    let cause = match failure.cause {
                        Cause::Singular | Cause::LinearSolver => Cause::NotConverged,
                        other => other,
                    };
                    return Err(StepFailure { cause, ..failure });
                }
                self.loose.vain = true;
                let far = self.followed_body(trial);
                Err(StepFailure {
                    cause: Cause::Singular,
                    message: format!("{far} has been followed, but contact does not hold it"),
                    ..failure
                })
            }
            Ok(accepted) => Ok(Accepted {
                followed: self.loose.fresh,
                ..accepted
            }),
        }
    }

    /// The failure of an increment in which a body went astray.
    fn thrown(&self, (body, way, most): (usize, f64, f64), trial: Trial) -> StepFailure {
        let name = &self.model.bodies[body].name;
        let drivers = self.drivers(body, trial.to);
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

    /// The first of the bodies that were followed and what drives it, for a sentence.
    fn followed_body(&self, trial: Trial) -> String {
        let bodies = self.loose.known.iter().flat_map(|(_, bodies)| bodies);
        let Some(first) = bodies.into_iter().next() else {
            return "a body".into();
        };
        let drivers = self.drivers(first.body, trial.to);
        let name = &self.model.bodies[first.body].name;
        match drivers.is_empty() {
            true => format!("body {name}"),
            false => format!("body {name}, which {},", named(&drivers, "drives", "drive")),
        }
    }

    /// Whether an increment that failed is to be computed again with firmer anchors.
    pub(super) fn firmer(
        &mut self,
        trial: Trial,
        failure: &StepFailure,
        observers: &mut [&mut dyn Observer],
    ) -> Result<bool, Error> {
        let loose = &mut self.loose;
        if !loose.weak || failure.cause == Cause::Reach || loose.firmness >= MOST_FIRMER {
            return Ok(false);
        }
        loose.weak = false;
        loose.firmness += 1;
        self.forget_direction();
        self.anchor(trial, observers)?;
        Ok(true)
    }

    /// Whether an increment is to be computed again, as the bodies went so far that it should start where they have come.
    pub(super) fn carried_on(
        &mut self,
        trial: Trial,
        observers: &mut [&mut dyn Observer],
    ) -> Result<bool, Error> {
        let Some(anchors) = self.loose.anchors.take() else {
            self.loose.put = 0;
            self.loose.origin = None;
            return Ok(false);
        };
        if anchors.travel() <= LONG || self.loose.put >= MOST_PUT {
            self.loose.put = 0;
            self.loose.origin = None;
            self.loose.left = anchors.left();
            self.loose.fresh = false;
            self.summary.followed += 1;
            if self.loose.stay {
                let mut anchors = anchors;
                anchors.rest();
                self.loose.anchors = Some(anchors);
            }
            return Ok(false);
        }
        self.loose.put += 1;
        self.flush(observers)?;
        let mut u = self.state.u.clone();
        let mut names = Vec::new();
        let bodies = self.loose.known.iter().flat_map(|(_, bodies)| bodies);
        for (k, free) in bodies.enumerate() {
            let way = rigid_part(free, &anchors.moved(k), self.model.dofs, &mut u);
            names.push(format!(
                "{} by {way:.3e}",
                self.model.bodies[free.body].name
            ));
        }
        self.notes.push(format!(
            "moved without strain to where contact holds them: {}",
            names.join(", ")
        ));
        self.put(u, observers)?;
        self.anchor(trial, observers)?;
        Ok(true)
    }

    /// Energy left in anchors over the strain energy.
    pub(super) fn artificial_energy(&self) -> f64 {
        let strain = self.summary.energy.strain;
        if self.loose.left == 0.0 {
            0.0
        } else {
            self.loose.left / strain.max(f64::MIN_POSITIVE)
        }
    }
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
