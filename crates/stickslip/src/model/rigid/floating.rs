//! Floating bodies, those that only contact can hold: which they are in a step, what pushes them, and the springs that hold them until contact does.

use super::super::definition::Model;
use super::super::scene::Scene;
use super::closing::pushes;
use super::free_bodies::{FreeBody, free_bodies};
use crate::body::{Anchors, Hold, spread};
use crate::contact::interface::Interface;
use crate::contact::look;
use crate::math::{dot, norm};
use crate::tolerance::NEGLIGIBLE;

/// The floating bodies of a step.
#[derive(Default, Clone, crate::keep::Keep)]
pub(crate) struct FloatingBodies {
    /// The bodies.
    pub free: Vec<FreeBody>,
    /// Points of the mesh where they may be anchored, body by body.
    pub places: Vec<Vec<usize>>,
    /// The largest load along free motions at the ends of the steps so far and when they were looked for, body by body `[N]`.
    pub pushed: Vec<f64>,
}

impl FloatingBodies {
    /// Those of the step at hand: bodies that supports leave free and interfaces may hold.
    pub fn find(scene: &Scene) -> Self {
        let Scene { model, contact, .. } = *scene;
        let step = &model.steps[scene.frame.step];
        let middle = 0.5 * (step.start + step.end);
        if !model.solution.follow || contact.interfaces.is_empty() {
            return FloatingBodies::default();
        }
        let mut free = free_bodies(scene, middle);
        let active = |i: &&Interface| i.schedule.active(middle);
        let interfaces: Vec<&Interface> = contact.interfaces.iter().filter(active).collect();
        let dofs = model.dofs;
        let mut resisted = false;
        free.retain(|body| {
            let mut met = false;
            for interface in &interfaces {
                for (point, normal) in look::normals(interface) {
                    if body.has(model, point) {
                        met = true;
                        resisted |= body.motions.iter().any(|(_, motion)| {
                            dot(dofs.vector(motion, point), normal).abs() > NEGLIGIBLE
                        });
                    }
                }
            }
            met
        });
        if !resisted {
            return FloatingBodies::default();
        }
        let place = |body: &FreeBody| {
            let each = body.bodies.iter();
            let each = each.map(|&b| model.bodies[b].points.clone());
            each.flat_map(|points| spread(&model.mesh, points, dofs.dim + 1))
                .collect()
        };
        FloatingBodies {
            places: free.iter().map(place).collect(),
            pushed: largest_loads(&free, scene),
            free,
        }
    }

    /// The largest force at a point of each body, of forces by dof `[N]`.
    pub fn largest_forces(&self, model: &Model, forces: &[f64]) -> Vec<f64> {
        let largest = |free: &FreeBody| {
            let points = free.points(model);
            points.fold(0.0, |m, p| f64::max(m, norm(model.dofs.vector(forces, p))))
        };
        self.free.iter().map(largest).collect()
    }

    /// Whether a body that had a load has none at time `t`.
    pub fn lose_load(&self, scene: &Scene, t: f64) -> bool {
        let none = no_load(scene.model);
        let both = self.pushed.iter().zip(self.loads(scene, t));
        both.into_iter()
            .any(|(most, now)| *most > 0.0 && now <= none * most)
    }

    /// Whether there were loads and all are gone at time `t`.
    pub fn lose_all_loads(&self, scene: &Scene, t: f64) -> bool {
        let largest = self.pushed.iter().copied().fold(0.0, f64::max);
        let none = no_load(scene.model) * largest;
        largest > 0.0 && self.loads(scene, t).into_iter().all(|now| now <= none)
    }

    /// The loads along free motions at a time, body by body `[N]`.
    fn loads(&self, scene: &Scene, t: f64) -> Vec<f64> {
        if self.pushed.iter().all(|most| *most == 0.0) {
            return vec![0.0; self.free.len()];
        }
        let external = scene.loads(t);
        self.free.iter().map(|f| along(f, &external)).collect()
    }

    /// Springs that hold the bodies where they are, of a stiffness that takes the loads at time `t`: the springs, and in words what they hold.
    pub fn anchors(&self, scene: &Scene, t: f64, firmness: usize) -> (Anchors, String) {
        let Scene {
            model,
            contact,
            frame,
        } = *scene;
        let pushes = pushes(model, &scene.loads(t)).into_iter();
        // What draws the parts of a bolt together is no load on the whole of it.
        let tension = scene.couplings().tension(t);
        let mut force = pushes.map(|p| norm(p.force)).fold(tension, f64::max);
        let before = self.largest_forces(model, &frame.contact).into_iter();
        let largest = before.chain(self.pushed.iter().copied());
        let largest = largest.fold(0.0, f64::max);
        if force <= no_load(model) * largest {
            // What is left of forces that are gone is small beside them.
            force = largest;
        }
        let mut anchors = Anchors::new(model.dofs);
        let mut names = Vec::new();
        for (free, points) in self.free.iter().zip(&self.places) {
            let (mut spring, mut size) = (0.0_f64, f64::INFINITY);
            for interface in &contact.interfaces {
                if interface.nodes.iter().any(|&n| free.has(model, n)) {
                    let (k, h) = interface.typical();
                    spring = spring.max(k);
                    size = size.min(h);
                }
            }
            let hold = Hold {
                spring,
                force,
                // A body may move a quarter of a cell in a round.
                max_step: 0.25 * size,
                size,
                firmness,
            };
            anchors.hold(points.clone(), &frame.state.u, hold);
            let motions: Vec<&str> = free.motions.iter().map(|(name, _)| name.as_str()).collect();
            names.push(format!("{} ({})", free.name(model), motions.join(", ")));
        }
        (anchors, names.join("; "))
    }
}

/// The load on a floating body along its free motions: the largest, each of which has a largest displacement of one.
fn along(free: &FreeBody, external: &[f64]) -> f64 {
    let of = |motion: &[f64]| -> f64 { motion.iter().zip(external).map(|(m, f)| m * f).sum() };
    let motions = free.motions.iter();
    motions.fold(0.0, |most, (_, m)| f64::max(most, of(m).abs()))
}

/// The largest loads along free motions, body by body, at the ends of the steps so far and now.
fn largest_loads(bodies: &[FreeBody], scene: &Scene) -> Vec<f64> {
    let steps = &scene.model.steps[..=scene.frame.step];
    let ends = steps.iter().flat_map(|s| [s.start, s.end]);
    let mut largest = vec![0.0; bodies.len()];
    for t in ends.chain([scene.frame.state.t]) {
        let external = scene.loads(t);
        for (most, free) in largest.iter_mut().zip(bodies) {
            *most = f64::max(*most, along(free, &external));
        }
    }
    largest
}

/// The part of the largest load so far below which a load counts as zero: the residual that increments may leave, and so the remainder of the reaction of a released
/// support.
fn no_load(model: &Model) -> f64 {
    model.solution.settings.tolerance
}
