//! Whether points carry what the law of friction says, judged by the tractions that are reported and by how the points have moved: nothing here knows
//! frames, trial tractions or slip rules.

use super::belt::{belt_velocity, steady_velocity};
use super::definition::Primary;
use super::evaluation::{Evaluation, components};
use super::history::FrictionError;
use super::parts::InterfaceForce;
use super::sides::weights_of;
use crate::contact::law::friction::FrictionPoint;
use crate::contact::response::Status;
use crate::friction::cone::Cone;
use crate::math::{Vec3, add, add_scaled, dot, norm, scale, sub};
use crate::system::Stage;

/// Part of the increment before its end over which the velocity of an obstacle is taken: a difference, wrong by half of this part of what the velocity changes
/// by, and by a machine epsilon over it. Between 3e-5 and 3e-4 all short cases (see [`tolerance`](crate::tolerance)) have the same digits.
const VELOCITY_STEP: f64 = 1e-4;

/// Slip that moves a point by less than this part of what its cell yields under the shear has no direction to speak of.
/// Between 0.003 and 0.03 all short cases have the same digits.
const NO_SLIP_DIRECTION: f64 = 1e-2;

/// Judges the last evaluation at the end of an increment, while the history is still that of its start. A point that slips has to carry its
/// limit, in the tangent plane and not along its slip, with the kinematics of the paper against it; one that sticks carries no more than its limit.
pub(super) fn friction_error(interface: &InterfaceForce, stage: &Stage) -> FrictionError {
    let law = interface.laws.friction_law();
    let mut cone = FrictionError::default();
    if !law.frictional() || interface.laws.tied || !interface.schedule.active(stage.at.t) {
        return cone;
    }
    let points = interface
        .cache
        .last
        .points
        .iter()
        .zip(&interface.state.points);
    for (i, (e, before)) in points.enumerate() {
        let pressure = e.response.traction[0];
        if e.response.status == Status::Open || pressure <= 0.0 {
            continue;
        }
        let shear = e.along(&e.frames.now);
        let allowed = allowed(interface, i, e, shear);
        let size = match &allowed {
            Some((cone, parts)) => cone.size(*parts),
            None => norm(shear),
        };
        let (moved, unsure) = relative_slip(interface, i, e, stage);
        let speed = norm(moved) / stage.dt;
        // What the speed changes is the law's, and it sees another measure of it.
        let limit = match interface.laws.user.friction.is_some() || law.flows() {
            true => e.response.limit,
            false => {
                let limit = law.limit(&FrictionPoint {
                    pressure,
                    penetration: (-e.gap).max(0.0),
                    speed,
                    sticking: before.status != Status::Slip,
                    dt: stage.dt,
                    state: interface.state.law_state(i),
                    ..FrictionPoint::default()
                });
                match limit.d_speed == 0.0 {
                    true => limit.value,
                    false => e.response.limit,
                }
            }
        };
        cone.limit = cone.limit.max(limit);
        let slips = e.response.status == Status::Slip;
        let mut wrong = match &allowed {
            // Where nothing rubs across the axis, a point that slips across it may stick along it.
            Some((cone, parts)) if cone.ellipse.is_some_and(|e| e.half.contains(&0.0)) => {
                beyond(&Cone { limit, ..*cone }, *parts)
            }
            _ if slips => (size - limit).abs(),
            _ => size - limit,
        };
        cone.over = cone.over.max(wrong.min(size - limit));
        wrong = wrong.max(dot(shear, e.frames.normal).abs());
        let length = norm(shear);
        let given = (length + norm(before.shear)) * compliance(interface, i, e);
        let (apart, unsure) = (unsure, unsure + given);
        if slips && norm(moved) > unsure {
            let against = -dot(shear, moved) / norm(moved);
            wrong = wrong.max(-against);
        }
        if slips && interface.kinematics.as_dyn().triangles() {
            // With edges of a facet as directions friction need not be against slip, which is what the spring of stick has not taken up. What is unsure
            // may turn it by this angle.
            let spring = match interface.laws.slip.as_dyn().sticks() {
                true => scale(1.0 / e.stiffness[1], sub(shear, before.shear)),
                false => [0.0; 3],
            };
            let slid = add(moved, spring);
            let unsure = apart
                + (length + norm(before.shear)) * NO_SLIP_DIRECTION / interface.points[i].stiffness;
            if norm(slid) > unsure {
                let against = against(interface, e, &allowed, slid);
                let angle = (dot(shear, against) / (length * norm(against)))
                    .clamp(-1.0, 1.0)
                    .acos();
                let turned = (unsure / norm(slid)).asin();
                wrong = wrong.max(length * (1.0 - (angle - turned).max(0.0).cos()));
            }
        }
        cone.worst = cone.worst.max(wrong);
    }
    cone
}

/// What friction allows at a point where it depends on the direction, by the axis at the start of the increment, and the shear in its frame now.
fn allowed(
    interface: &InterfaceForce,
    i: usize,
    e: &Evaluation,
    shear: Vec3,
) -> Option<(Cone, [f64; 2])> {
    let frame = &e.frames.now;
    let x = interface.points[i].position(&interface.cache.geometry.before);
    let cone = Cone {
        limit: 0.0,
        skew: dot(frame[0], frame[1]),
        ellipse: Some(interface.definition.ellipse(x, e.frames.before)?),
    };
    Some((cone, components(shear, frame, interface.dofs.dim)))
}

/// A vector in the direction that the shear of a point has which slid this way.
fn against(
    interface: &InterfaceForce,
    e: &Evaluation,
    allowed: &Option<(Cone, [f64; 2])>,
    slid: Vec3,
) -> Vec3 {
    let Some((cone, _)) = allowed else {
        return scale(-1.0, slid);
    };
    let [first, second] = e.frames.now;
    let parts = components(scale(-1.0, slid), &e.frames.now, interface.dofs.dim);
    let [a, b] = cone.against(parts).along;
    add_scaled(scale(a, first), b, second)
}

/// How far a shear lies beyond what is allowed `[Pa]`.
fn beyond(cone: &Cone, shear: [f64; 2]) -> f64 {
    match cone.size(shear) > cone.limit {
        true => {
            let allowed = cone.returned(shear, 1.0).shear;
            cone.length([0, 1].map(|q| shear[q] - allowed[q]))
        }
        false => 0.0,
    }
}

/// How far a point gives way under a unit of shear before it slips, and where slip has no direction to speak of `[m/Pa]`.
fn compliance(interface: &InterfaceForce, i: usize, e: &Evaluation) -> f64 {
    1.0 / e.stiffness[1] + NO_SLIP_DIRECTION / interface.points[i].stiffness
}

/// How far the point has moved over the material of the primary beneath it, along the surface, belt included, and how uncertain that is. In dynamics
/// what its velocity at the end makes of the increment. What was apart at the start of the increment has swung towards each other as far as the
/// surfaces have turned on the way, and that was no slip: by less than the gap there was.
fn relative_slip(
    interface: &InterfaceForce,
    i: usize,
    e: &Evaluation,
    stage: &Stage,
) -> (Vec3, f64) {
    let tangential = |v: Vec3| add_scaled(v, -dot(v, e.frames.normal), e.frames.normal);
    if e.steady {
        let x = interface.points[i].position(&interface.cache.geometry.x);
        let way = steady_velocity(interface.input(), x, stage.at.t);
        return (tangential(scale(-stage.dt, way)), 0.0);
    }
    let dim = interface.dofs.dim;
    let (mut moved, mut own, mut apart) = ([0.0; 3], [0.0; 3], [0.0; 3]);
    for (node, w) in weights_of(interface, &interface.cache.last, i) {
        apart = add_scaled(apart, w, interface.cache.geometry.before[node]);
        if interface.frames.of_point(interface.nodes[node]).is_some() {
            let way = sub(
                interface.cache.geometry.x[node],
                interface.cache.geometry.before[node],
            );
            own = add_scaled(own, w.max(0.0), way);
            for (c, way) in way.into_iter().enumerate().take(dim) {
                let dof = interface.dofs.of(interface.nodes[node], c);
                moved[c] += w * match stage.rate {
                    Some(rate) => rate.gain[dof] * way + rate.shift[dof],
                    None => way,
                };
            }
            continue;
        }
        for c in 0..dim {
            let dof = interface.dofs.of(interface.nodes[node], c);
            let du = stage.at.u[dof] - stage.from.u[dof];
            own[c] += if w > 0.0 { w * du } else { 0.0 };
            moved[c] += w * match stage.rate {
                Some(rate) => rate.gain[dof] * du + rate.shift[dof],
                None => du,
            };
        }
    }
    moved = add_scaled(
        moved,
        -stage.dt,
        belt_velocity(interface.input(), stage.at.t),
    );
    let mut unsure = dot(apart, e.frames.normal).abs();
    if let Primary::Rigid(_, motion) = &interface.primary {
        let t = stage.at.t;
        let [now, then] = [t, t - VELOCITY_STEP * stage.dt].map(|t| motion.pose(t));
        let x = interface.points[i].position(&interface.cache.geometry.x);
        let surface = sub(x, then.outward(now.inward(x)));
        moved = add_scaled(moved, -1.0 / VELOCITY_STEP, surface);
        // The point has seen other velocities on its way.
        unsure = now.turned_since(&motion.pose(stage.from.t)).abs() * norm(own);
    }
    (tangential(moved), unsure)
}
