//! Floating bodies that go further in an increment than there is reason to.

use super::super::scene::Scene;
use super::drivers;
use super::drivers::named;
use super::floating::FloatingBodies;
use super::nearest::rigid_part;
use crate::math::{add_scaled, norm};
use crate::number::figure;
use crate::system::{Cause, Culprit, State, StepFailure};
use crate::time::Trial;

/// How much further an unconstrained body may go than the gaps it has to close and what moves it do: it may turn about a point near what
/// pushes it. Between 3 and 30 all short cases (see [`tolerance`](crate::tolerance)) have the same digits, and tests of unconstrained bodies pass.
const LARGEST_LEVER: f64 = 10.0;

/// Where an increment began in which bodies are moved or followed.
#[derive(Clone, crate::keep::Keep)]
pub(crate) struct Origin {
    pub u: Vec<f64>,
    /// Gaps that bodies may have to close `[m]`: the largest of each interface, all together, and how far obstacles move in the increment.
    pub gaps: f64,
    /// Height of the cells at the surfaces that may touch, the largest mean of an interface `[m]`.
    pub size: f64,
}

/// A floating body that has gone too far in an increment.
pub(crate) struct Astray {
    /// Its index, the first of those that are tied to it, and its name.
    body: usize,
    name: String,
    /// How far it went, and how far it might `[m]`.
    way: f64,
    most: f64,
}

impl Origin {
    /// The first floating body that has gone further to a state than there is reason to.
    pub fn astray(&self, scene: &Scene, floating: &FloatingBodies, to: &State) -> Option<Astray> {
        let (dofs, model) = (scene.model.dofs, scene.model);
        let change = |p: usize| add_scaled(dofs.vector(&to.u, p), -1.0, dofs.vector(&self.u, p));
        // What the bodies that are held do, they may hand on; inside condensed ones it is not known yet.
        let constraints = scene.constraints(to.t);
        let prescribed = constraints
            .fixed
            .iter()
            .zip(&constraints.values)
            .zip(&self.u);
        let prescribed = prescribed.filter(|((fixed, _), _)| **fixed);
        let moved = prescribed.map(|((_, to), from)| (to - from).abs());
        let prescribed = moved.fold(0.0, f64::max);
        // Whatever bends and pushes, nothing is flung through the whole model.
        let utmost = model.size + self.gaps + prescribed;
        let mut moved = prescribed;
        let held = model.bodies.iter().enumerate();
        let held = held.filter(|(b, _)| floating.free.iter().all(|free| !free.bodies.contains(b)));
        for (_, body) in held {
            moved = body
                .points
                .clone()
                .map(|p| norm(change(p)))
                .fold(moved, f64::max);
        }
        for (free, places) in floating.free.iter().zip(&floating.places) {
            let points: Vec<_> = places.iter().map(|&p| (p, change(p))).collect();
            let mut rigid = vec![0.0; to.u.len()];
            rigid_part(free, &points, dofs, &mut rigid);
            let strained = points
                .iter()
                .map(|&(p, moved)| norm(add_scaled(moved, -1.0, dofs.vector(&rigid, p))));
            let strained = strained.fold(0.0, f64::max);
            let ways = points.iter().map(|&(_, moved)| norm(moved));
            let way = ways.fold(0.0, |m, way| if way > m || way.is_nan() { way } else { m });
            let most = (LARGEST_LEVER * (self.gaps + moved + strained) + self.size).min(utmost);
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
}

impl Astray {
    /// The failure of the increment.
    pub fn failure(self, scene: &Scene, trial: Trial) -> StepFailure {
        let Astray {
            body,
            name,
            way,
            most,
        } = self;
        let drivers = drivers::drivers(scene, body, trial.to);
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
}
