//! The balance of each body: what acts on it from outside has no resultant.

use super::figures::EQUILIBRIUM;
use super::gate::Gate;
use super::view::View;
use crate::body::Space;
use crate::math::{Vec3, add, cross, norm, sub};
use crate::model::definition::Body;
use crate::model::limits::Limits;
use crate::tolerance::NEGLIGIBLE;

/// Resultant of forces about a point.
#[derive(Debug, Clone, Copy, Default)]
struct Torsor {
    force: Vec3,
    moment: Vec3,
}

/// What acts on a body.
#[derive(Debug, Clone, Copy, Default)]
struct Acting {
    /// Sum of everything.
    left: Torsor,
    /// The largest of the sums of magnitudes of loads, contact forces, reactions, springs and, in motion, inertia, elastic forces and what would stop it `[N]`.
    scale: f64,
    /// Half the size of the body `[m]`.
    arm: f64,
}

/// Resultants of what acts on the bodies from outside. The forces inside a body have none, so that it is a check of the solution that
/// does not depend on how it was found. In motion the out-of-balance forces of the scheme are taken, in which inertia and damping
/// stand as well.
pub(crate) fn judge_bodies(view: &View, limits: &Limits, gate: &mut Gate) {
    let fixed = view.constraints(view.frame.state.t).fixed;
    let mut springs = vec![0.0; view.frame.forces.len()];
    for &(dof, k) in view.model.actions.springs.iter().flat_map(|s| s.entries()) {
        springs[dof] -= k * view.frame.state.u[dof];
    }
    let inertia = view.inertia().map(|inertia| {
        let inertial = inertia.mass_times(&view.frame.state.a);
        [
            inertial,
            view.frame.motion.internal.clone(),
            arresting(view),
        ]
    });
    let inside = inertia.unwrap_or_default();
    let bodies = view.model.bodies.iter();
    let acting = bodies.map(|b| acting(view, b, &fixed, &springs, &inside));
    let acting: Vec<Acting> = acting.collect();
    // Before anything touches there may be nothing but what rounding of the displacements leaves.
    let stiff = view.solver.diagonal.iter().zip(&view.frame.state.u);
    let rounding = stiff.map(|(k, u)| (k * u).powi(2)).sum::<f64>().sqrt();
    // Sums of forces may be off by a thousand roundings of stiffness times displacement.
    let rounding = 1e3 * f64::EPSILON * rounding;
    let stopping = stopping(view);
    for (body, a) in view.model.bodies.iter().zip(&acting) {
        let moment = if a.arm > 0.0 {
            norm(a.left.moment) / a.arm
        } else {
            0.0
        };
        let left = (norm(a.left.force).max(moment) - rounding).max(0.0);
        let place = format!("body {}", body.name);
        // A body that flies freely has no forces to compare with.
        let dofs = body.points.clone().flat_map(|p| {
            let all = 0..view.model.dofs.dim;
            all.map(move |c| view.model.dofs.of(p, c))
        });
        let stop: f64 = dofs.filter_map(|dof| stopping.get(dof)).sum();
        // Forces below this part of those that would stop the motion are negligible.
        let scale = a.scale.max(NEGLIGIBLE * stop);
        let (pair, limit, t) = ([left, scale], limits.equilibrium, view.frame.state.t);
        match view.inertia().is_some() {
            true => gate.note_in_motion(&EQUILIBRIUM, &place, pair, limit, t),
            false => gate.note(&EQUILIBRIUM, &place, pair, limit, t),
        }
    }
}

/// Forces `[N]` that would stop everything over the step, momentum over its length: one that is left out of balance by a part of them changes
/// velocities by that part. What flies freely, a rigid body above all, has nothing else to compare with.
fn arresting(view: &View) -> Vec<f64> {
    let mut momenta = view.momenta(&view.frame.state.v);
    let length = view.step().map_or(f64::INFINITY, |s| s.end - s.start);
    momenta.iter_mut().for_each(|p| *p /= length);
    momenta
}

/// Forces `[N]` by which the stiffness would stop the fastest motion at each dof, `v √(k m)`; nothing where nothing is in motion.
fn stopping(view: &View) -> Vec<f64> {
    let Some(inertia) = view.inertia() else {
        return Vec::new();
    };
    let fastest = view
        .frame
        .state
        .v
        .iter()
        .fold(0.0_f64, |m, v| m.max(v.abs()));
    let masses = inertia.mass_times(&vec![1.0; view.frame.state.u.len()]);
    let both = view.solver.diagonal.iter().zip(masses);
    both.map(|(k, m)| fastest * (k * m).max(0.0).sqrt())
        .collect()
}

/// `inside`: forces of inertia, elastic forces, and what would stop everything, where there is motion.
fn acting(
    view: &View,
    body: &Body,
    fixed: &[bool],
    springs: &[f64],
    inside: &[Vec<f64>; 3],
) -> Acting {
    let model = view.model;
    let dofs = model.dofs;
    // Of a rigid body the hidden points carry everything: the second has moments over a length.
    let link = body.rigid.map(|rigid| &model.links.all()[rigid.link]);
    let points = match link {
        Some(link) => link.hidden..link.hidden + 2,
        None => body.points.clone(),
    };
    // Of what turns by any angle the moment is that about where points are.
    let turns =
        (model.corotations).of_point(body.points.start).is_some() || body.elastic.is_corotational();
    let place = |p: usize| {
        let place = model.mesh.points.get(p).copied().unwrap_or_default();
        match turns {
            true => add(place, dofs.vector(&view.frame.state.u, p)),
            false => place,
        }
    };
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for p in body.points.clone() {
        for c in 0..3 {
            low[c] = low[c].min(place(p)[c]);
            high[c] = high[c].max(place(p)[c]);
        }
    }
    let centre = std::array::from_fn(|c| 0.5 * (low[c] + high[c]));
    let mut a = Acting {
        arm: 0.5 * norm(sub(high, low)),
        ..Acting::default()
    };
    let mut sums = [0.0; 7];
    for p in points.clone() {
        let mut left = [0.0; 3];
        let mut parts = [[0.0; 3]; 7];
        for (c, left) in left.iter_mut().enumerate().take(dofs.dim) {
            let dof = dofs.of(p, c);
            let reaction = if fixed[dof] {
                view.frame.forces[dof]
            } else {
                0.0
            };
            let all = [
                view.frame.load[dof],
                -view.frame.contact[dof],
                reaction,
                springs[dof],
            ];
            let within = inside
                .each_ref()
                .map(|f| f.get(dof).copied().unwrap_or(0.0));
            for (part, x) in parts.iter_mut().zip(all.into_iter().chain(within)) {
                part[c] = x;
            }
            *left = match view.inertia().is_some() || link.is_some() {
                true if fixed[dof] => 0.0,
                true => -view.frame.forces[dof],
                false => all.iter().sum(),
            };
        }
        for (sum, part) in sums.iter_mut().zip(parts) {
            *sum += norm(part);
        }
        match (model.space, link) {
            // Around the axis forces balance by hoop stress, and there is nothing to turn.
            (Space::Axisymmetric, _) => a.left.force[1] += left[1],
            (_, Some(link)) if p > link.hidden => {
                a.left.moment = left.map(|f| f * link.length);
            }
            _ => {
                a.left.force = add(a.left.force, left);
                if link.is_none() {
                    let arm = sub(place(p), centre);
                    a.left.moment = add(a.left.moment, cross(arm, left));
                }
            }
        }
    }
    a.scale = sums.into_iter().fold(0.0, f64::max);
    a
}
