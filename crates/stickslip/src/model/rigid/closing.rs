//! Moves unconstrained bodies, as rigid ones, the way their loads push them until they touch.

use super::super::contact::Contact;
use super::super::definition::Model;
use super::super::frame::Frame;
use super::free_bodies::FreeBody;
use super::null_space_below;
use crate::contact::interface::{Conditions, meeting};
use crate::math::{Vec3, add, add_scaled, dot, norm, scale};
use crate::mesh::geometry;
use crate::time::Trial;
use crate::tolerance::SAME;

/// Where unconstrained bodies come to touch.
pub(crate) struct Closure {
    /// Displacements there.
    pub u: Vec<f64>,
    /// How far each unconstrained body has moved `[m]`, as the largest displacement.
    pub moved: Vec<f64>,
    /// Unconstrained bodies that their loads push away from everything.
    pub unbalanced: Vec<usize>,
}

/// Most stretches of the way.
const MOST_STRETCHES: usize = 20_000;

/// Bodies that move together: those that have met.
struct Clusters<'a> {
    /// The cluster of each body, by the index of one of its bodies; the last is that of what cannot move.
    of: Vec<usize>,
    free: &'a [FreeBody],
}

impl Clusters<'_> {
    fn ground(&self) -> usize {
        self.of[self.of.len() - 1]
    }

    fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.of[a], self.of[b]);
        for of in &mut self.of {
            if *of == a {
                *of = b;
            }
        }
    }

    fn members(&self, cluster: usize) -> impl Iterator<Item = &FreeBody> {
        let free = self.free.iter();
        free.filter(move |f| self.of[f.bodies[0]] == cluster)
    }
}

/// Moves the bodies in `free`, the others at rest, from the last state with the loads `external`, in an increment that begins. What rubs on something stays: its way
/// would be slip.
pub(crate) fn close(
    model: &Model,
    frame: &Frame,
    contact: &mut Contact,
    conditions: &[Conditions],
    free: &[FreeBody],
    external: &[f64],
    trial: Trial,
) -> Closure {
    let count = model.bodies.len();
    let mut clusters = Clusters {
        of: vec![count; count + 1],
        free,
    };
    for f in free
        .iter()
        .filter(|f| !f.rubs(model, contact, &frame.contacts))
    {
        f.bodies.iter().for_each(|&b| clusters.of[b] = f.bodies[0]);
    }
    let pushes = pushes(model, external);
    let mut pulls = vec![0.0; external.len()];
    let drawn = contact.coupled(frame).pulls(trial.to);
    for (dof, force) in drawn.into_values().flatten() {
        pulls[dof] += force;
    }
    let mut u = frame.state.u.clone();
    let mut unbalanced = Vec::new();
    for _ in 0..MOST_STRETCHES {
        let w = velocities(model, &clusters, external, &pulls, &pushes);
        if w.iter().all(|w| *w == 0.0) {
            break;
        }
        let (mut way, mut touching) = (f64::INFINITY, Vec::new());
        for interface in &mut contact.forces(&frame.contacts, conditions).interfaces {
            if interface.schedule.active(trial.to) {
                let meeting = meeting(interface, &u, &w, trial.from);
                way = way.min(meeting.way);
                touching.extend(meeting.touching);
            }
        }
        let bodies = &model.bodies;
        let body_of = |p: usize| bodies.iter().position(|b| b.points.contains(&p));
        for &(secondary, primary) in &touching {
            let a = body_of(secondary).unwrap_or(count);
            let b = primary.and_then(body_of).unwrap_or(count);
            clusters.join(a, b);
        }
        if !touching.is_empty() {
            continue;
        }
        if way == f64::INFINITY {
            let moving = |f: &&FreeBody| {
                let dofs = model.dofs;
                f.points(model).any(|p| norm(dofs.vector(&w, p)) != 0.0)
            };
            let all = free.iter().enumerate();
            unbalanced = all.filter(|(_, f)| moving(f)).map(|(k, _)| k).collect();
            break;
        }
        u.iter_mut().zip(&w).for_each(|(u, w)| *u += way * w);
    }
    let dofs = model.dofs;
    let moved = free.iter().map(|f| {
        let points = f
            .bodies
            .iter()
            .flat_map(|&b| model.bodies[b].points.clone());
        points
            .map(|p| {
                let (now, then) = (dofs.vector(&u, p), dofs.vector(&frame.state.u, p));
                norm(add_scaled(now, -1.0, then))
            })
            .fold(0.0, f64::max)
    });
    Closure {
        moved: moved.collect(),
        u,
        unbalanced,
    }
}

/// Velocities of all dofs, the fastest cluster's of size one: along the load, as a body without friction starts from rest.
fn velocities(
    model: &Model,
    clusters: &Clusters,
    external: &[f64],
    pulls: &[f64],
    pushes: &[Push],
) -> Vec<f64> {
    let dofs = model.dofs;
    let mut w = vec![0.0; external.len()];
    for cluster in 0..model.bodies.len() {
        let members: Vec<&FreeBody> = clusters.members(cluster).collect();
        if cluster == clusters.ground() || members.is_empty() {
            continue;
        }
        let (mut mass, mut force, mut size) = (0.0, [0.0; 3], 0.0);
        for &b in members.iter().flat_map(|f| &f.bodies) {
            let push = &pushes[b];
            mass += push.volume;
            force = add(force, push.force);
            size += push.size;
        }
        let basis = common(&members);
        if basis.is_empty() {
            // One body that can only turn.
            if let [only] = members.as_slice() {
                turn(only, external, pulls, mass, &mut w);
            }
            continue;
        }
        // A push that turns a body as well is left to contact.
        let along = basis
            .iter()
            .fold([0.0; 3], |s, &e| add_scaled(s, dot(force, e), e));
        if norm(along) <= SAME * size {
            continue;
        }
        let v = scale(1.0 / mass, along);
        for f in &members {
            for p in f.points(model) {
                for (c, v) in v.iter().enumerate().take(dofs.dim) {
                    w[dofs.of(p, c)] = *v;
                }
            }
        }
    }
    let fastest = w.iter().fold(0.0_f64, |m, w| m.max(w.abs()));
    if fastest > 0.0 {
        w.iter_mut().for_each(|w| *w /= fastest);
    }
    w
}

/// Directions in which all bodies can move without turning.
fn common(members: &[&FreeBody]) -> Vec<Vec3> {
    // The sum of the projections on what is held vanishes along them.
    let mut held = vec![vec![0.0; 3]; 3];
    for f in members {
        for (i, row) in held.iter_mut().enumerate() {
            for (j, h) in row.iter_mut().enumerate() {
                let free: f64 = f.slides.iter().map(|s| s[i] * s[j]).sum();
                *h += if i == j { 1.0 - free } else { -free };
            }
        }
    }
    let free = null_space_below(&held, SAME).into_iter();
    free.map(|v| [v[0], v[1], v[2]]).collect()
}

/// Adds the motion that the load gives a body which can only turn, or of which a pretension has cut off a part: against that no load moves the part.
fn turn(free: &FreeBody, external: &[f64], pulls: &[f64], mass: f64, w: &mut [f64]) {
    for (_, motion) in &free.motions {
        let parts = motion.iter().zip(external).map(|(m, f)| m * f);
        let (force, size) = parts.fold((0.0, 0.0), |(s, a): (f64, f64), p| (s + p, a + p.abs()));
        let pull: f64 = motion.iter().zip(pulls).map(|(m, f)| m * f).sum();
        if force.abs() <= SAME * size || force * (force + pull) <= 0.0 {
            continue;
        }
        let square: f64 = motion.iter().map(|m| m * m).sum();
        let factor = force / (square * mass);
        w.iter_mut().zip(motion).for_each(|(w, m)| *w += factor * m);
    }
}

/// What the loads do to each body.
pub(crate) fn pushes(model: &Model, external: &[f64]) -> Vec<Push> {
    let mut pushes = Vec::new();
    for (index, body) in model.bodies.iter().enumerate() {
        let mut push = Push::default();
        for p in model.displaced_with(index) {
            let on = model.dofs.vector(external, p);
            push.force = add(push.force, on);
            push.size += norm(on);
        }
        let blocks = body.blocks.clone();
        let cells = model.mesh.cells().filter(|c| blocks.contains(&c.block));
        push.volume = cells.map(|c| geometry::cell_measure(&model.mesh, c)).sum();
        pushes.push(push);
    }
    pushes
}

/// What the loads do to a body.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Push {
    /// Their sum, and that of their sizes `[N]`.
    pub force: Vec3,
    size: f64,
    /// Volume of the body, for its inertia.
    volume: f64,
}
