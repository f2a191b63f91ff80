//! What the laws answer at a point.

use super::belt::steady_velocity;
use super::evaluation::{Batch, Before, Evaluation, Frames, Question, Slots, components};
use super::initial::TOUCHING;
use super::input::InterfaceInput;
use super::scene::{LawQuery, Met, Scene};
use super::stiffness::{own_stiffness, spring, tangential_stiffness};
use super::wear::{length, wear_compliance, wear_gap, wearing};
use crate::contact::enforcement::Multipliers;
use crate::contact::kinematics::{Moving, Stencil, carried_over, rate_slip};
use crate::contact::law::friction::FrictionPoint;
use crate::contact::response::{Kept, LawInput, Sliding, Status, Stiffnesses, Worn, respond};
use crate::math::{Vec3, add_scaled, dot, norm, scale};
use crate::tolerance::ROUNDING;

/// Laws at the stencil of the batch.
pub(super) fn respond(met: Met, scene: &Scene, batch: &mut Batch) -> Evaluation {
    let interface = scene.interface;
    let i = met.i;
    if let Some(glued) = interface.state.start.glued.get(i) {
        batch.stencil.gap -= glued;
    }
    let wear_gap = wear_gap(i, scene, &batch.sides[met.sides..]);
    batch.stencil.gap += wear_gap - interface.offset_at_start(i, scene.t);
    let slots = claim(interface, met, batch);
    let stencil = &batch.stencil;
    let belt = stencil.frame.map(|e| dot(e, scene.belt));
    let slid = [stencil.slip[0] - belt[0], stencil.slip[1] - belt[1]];
    let stiffness = stiffnesses(i, stencil, scene);
    let before = &interface.state.points[i];
    let mut at = LawInput {
        dt: scene.dt,
        stiffness,
        kept: kept(interface, i, stencil),
        slip: Sliding {
            seen: slid,
            path: None,
            sprung: interface.state.springs,
            steady: false,
            slack: match scene.wants.tangent && interface.attempt.flips[i].last[0].is_none() {
                // The first trial traction of an attempt may exceed the limit by this and count as stick.
                true => 1e-2,
                false => 0.0,
            },
        },
        rest: rest(interface, i),
        // A law of the program is asked once, before it is known how much of the way is slid.
        worn: match scene.query {
            LawQuery::Nothing => Worn::default(),
            _ if scene.wants.pressed => Worn::default(),
            _ => {
                let path = length(stencil.frame_before, slid);
                wear_compliance(interface, i, path, scene.dt, before.pressure, None)
            }
        },
        closing: closing(interface, i, stencil.gap, scene.dt),
        sticking: before.status != Status::Slip,
        state: interface.state.law_state(i),
        place: interface.definition.place(&interface.points[i]),
        // By the axis at the start of the increment: how it turns on the way is no part of the tangent then.
        ellipse: interface.ellipse(
            interface.points[i].position(&scene.geometry.before),
            stencil.frame_before,
        ),
        pressed: scene.wants.pressed,
        answers: scene.answers.get(i).copied().unwrap_or_default(),
    };
    use_end_velocity(scene, &slots, batch, &mut at);
    use_steady_velocity(i, scene, batch, &mut at);
    let stencil = &batch.stencil;
    if scene.query != LawQuery::Nothing {
        let friction = match scene.query {
            LawQuery::Friction => respond::question(&interface.laws, stencil, &at),
            _ => Some(FrictionPoint::default()),
        };
        batch.questions.extend(friction.map(|friction| Question {
            point: i,
            gap: stencil.gap - at.rest,
            friction,
        }));
        return Evaluation::default();
    }
    let [e, f] = stencil.frame_before;
    let moved = add_scaled(scale(slid[0], e), slid[1], f);
    let off = match interface.holds_exactly() {
        true => [stencil.gap - at.rest, slid[0], slid[1]],
        false => [0.0; 3],
    };
    let response = wearing(interface, i, stencil, moved, &mut at);
    let worn = at.worn.depth(response.traction[0]);
    Evaluation {
        slots,
        viscosity: response
            .d_rate
            .iter()
            .fold(0.0, |m: f64, d| m.max(-d * at.dt)),
        response,
        gap: stencil.gap + worn,
        wear_gap: wear_gap + worn,
        frames: Frames {
            normal: stencil.normal,
            now: stencil.frame,
            before: stencil.frame_before,
            normal_before: stencil.normal_before,
        },
        moved,
        stiffness: [at.stiffness.normal, at.stiffness.tangential],
        kept: Before {
            multiplier: at.kept.multiplier,
            shear: at.kept.shear,
        },
        over: true,
        steady: at.slip.steady,
        off,
        area: met.area,
        ..Evaluation::default()
    }
}

/// Enters the dofs of the nodes of a point into the batch.
fn claim(interface: InterfaceInput, met: Met, batch: &mut Batch) -> Slots {
    let first = batch.dofs.len();
    for &(node, _) in &batch.sides[met.sides..] {
        for c in 0..interface.dofs.dim {
            batch.dofs.push(interface.dofs.of(interface.nodes[node], c));
        }
    }
    Slots {
        n: batch.dofs.len() - first,
        dofs: first,
        nodes: batch.sides.len() - met.sides,
        sides: met.sides,
        ..Slots::default()
    }
}

/// How stiffly a point is held.
fn stiffnesses(i: usize, stencil: &Stencil, scene: &Scene) -> Stiffnesses {
    let interface = scene.interface;
    let point = &interface.points[i];
    let enforcement = interface.laws.enforcement.as_dyn();
    // Multipliers are exact in the end: how fast they get there depends on all that resists, inertia included. What springs do
    // must not depend on the increment.
    let own = match enforcement.multipliers() {
        Multipliers::Augmented { .. } => own_stiffness(interface, i, scene.rate.map(|_| scene.dt)),
        _ => point.stiffness,
    };
    let normal = match interface.laws.needs_normal_stiffness() {
        true => spring(
            interface.contact,
            interface.attempt,
            enforcement.normal(),
            own,
        ),
        false => f64::INFINITY,
    };
    let tangential = tangential_stiffness(interface.contact, interface.attempt, own);
    let touches = interface.attempt.before_first_contact && stencil.gap <= TOUCHING * point.size;
    Stiffnesses {
        normal,
        tangential,
        weight: own.min(normal).min(tangential),
        first_contact: if touches { point.stiffness } else { 0.0 },
    }
}

/// Multipliers and tractions of before, in the frame of the stencil.
fn kept(interface: InterfaceInput, i: usize, stencil: &Stencil) -> Kept {
    // Where the surface was met before it may have had another normal.
    let in_frame = |shear: Vec3, normal: Vec3| {
        let there = match normal == [0.0; 3] {
            true => shear,
            false => carried_over(shear, normal, stencil.normal_before),
        };
        components(there, &stencil.frame_before, interface.dofs.dim)
    };
    let (multiplier, before) = (
        &interface.attempt.multipliers[i],
        &interface.state.points[i],
    );
    let shear = in_frame(multiplier.shear, multiplier.normal);
    let carried = in_frame(before.shear, before.normal);
    let centre = match interface.laws.enforcement.as_dyn().multipliers() {
        Multipliers::Augmented { .. } => {
            let t = in_frame(multiplier.centre_shear, multiplier.centre_normal);
            [multiplier.centre_pressure, t[0], t[1]]
        }
        _ => [0.0, carried[0], carried[1]],
    };
    Kept {
        unknown: interface.unknown(),
        multiplier: [multiplier.pressure, shear[0], shear[1]],
        centre,
        shear: carried,
    }
}

/// Gap that counts as none.
///
/// A constraint that is met to a tolerance leaves a gap, which multipliers would go on to correct in every increment to come. Where supports hold the
/// point in it, that has no end: pressure would grow without anything that asks for it. What the tolerance has accepted is accepted for
/// as long as the point is in contact.
fn rest(interface: InterfaceInput, i: usize) -> f64 {
    if !interface.unknown() {
        return interface.state.rest.get(i).copied().unwrap_or(0.0);
    }
    let (before, accepted) = (&interface.state.points[i], interface.attempt.accepted_gap);
    match before.status {
        Status::Open => 0.0,
        _ => before.gap.max(-accepted).min(accepted),
    }
}

/// Closing velocity over the increment; zero for a point that had no gap before.
fn closing(interface: InterfaceInput, i: usize, gap: f64, dt: f64) -> f64 {
    let before = &interface.state.points[i];
    if before.normal == [0.0; 3] || !before.gap.is_finite() {
        return 0.0;
    }
    (before.gap - gap) / dt
}

/// In sliding that lasts friction sees the motion of the primary's surface alone, which no displacement changes.
fn use_steady_velocity(i: usize, scene: &Scene, batch: &mut Batch, at: &mut LawInput) {
    let interface = scene.interface;
    if interface.conditions.steady.is_none() {
        return;
    }
    let stencil = &batch.stencil;
    let x = interface.points[i].position(&scene.geometry.x);
    let way = scale(scene.dt, steady_velocity(interface, x, scene.t));
    let belt = stencil.frame.map(|e| dot(e, way));
    let across = dot(stencil.normal, way);
    // What moves along its normal alone does not slide.
    if norm(add_scaled(way, -across, stencil.normal)) <= ROUNDING * norm(way) {
        return;
    }
    at.slip.path = at.slip.path.or(Some(at.slip.seen));
    at.slip.seen = belt.map(|b| -b);
    at.slip.steady = true;
    let n = stencil.n;
    for row in &mut batch.rated {
        row.clear();
        row.resize(n, 0.0);
    }
}

/// In motion friction sees the velocity at the end of the increment. A tie holds places: of points without mass velocities are means over the increment, and a body with mass that went
/// as fast at its end would fall behind them.
fn use_end_velocity(scene: &Scene, slots: &Slots, batch: &mut Batch, at: &mut LawInput) {
    let interface = scene.interface;
    for row in &mut batch.rated {
        row.clear();
    }
    let Some(rate) = scene.rate.filter(|_| !interface.laws.tied) else {
        return;
    };
    let stencil = &batch.stencil;
    let nodes = batch.sides[slots.sides..].iter().map(|(node, _)| node);
    let moving = Moving {
        x: &scene.geometry.x,
        before: &scene.geometry.before,
        rate,
        dim: interface.dofs.dim,
    };
    let dofs = &batch.dofs[slots.dofs..];
    let seen = rate_slip(stencil, nodes, dofs, &moving, &mut batch.rated);
    let belt = stencil.frame.map(|e| dot(e, scene.belt_end));
    at.slip.path = Some(at.slip.seen);
    at.slip.seen = [seen[0] - belt[0], seen[1] - belt[1]];
}
