//! How far bodies have turned and moved: figures that see what the linear theory does not.

use super::doctor::{self, DoctorCause, Finding, LocationKind, Suspect};
use super::figures::{DISPLACEMENT, LOCAL_ROTATION, ROTATION, STRAIN};
use super::gate::Gate;
use super::view::View;
use crate::assess::rotation;
use crate::body::{Turning, turning};
use crate::math::{Vec3, dot, norm};
use crate::model::definition::Body;
use crate::model::limits::{GateMode, Limits};
use crate::number::{digits, figure};
use crate::system::State;

/// The rotation of a link as a vector in space: in the plane its one component comes first.
fn rotation_vector(turn: Vec3, dim: usize) -> Vec3 {
    match dim {
        2 => [0.0, 0.0, turn[0]],
        _ => turn,
    }
}

/// Takes note of how far bodies have turned, the most in `largest`, and moved.
pub(crate) fn judge_travel(
    view: &View,
    limits: &Limits,
    gate: &mut Gate,
    largest: &mut f64,
    findings: &mut Vec<Finding>,
) {
    let judged = limits.gate != GateMode::Off;
    let size = view.model.size + prescribed_way(view);
    let t = view.frame.state.t;
    let mut far = Vec::new();
    let mut turns = Vec::new();
    let strained = view.strained();
    for body in &view.model.bodies {
        let place = format!("body {}", body.name);
        let turning = turning(view, body, &strained);
        *largest = largest.max(turning.mean);
        turns.push(match view.model.has_frames(body) {
            true => [0.0; 3],
            false => turning.vector,
        });
        if !judged {
            continue;
        }
        gate.note(&ROTATION, &place, [turning.mean, 1.0], limits.rotation, t);
        if body.rigid.is_none() {
            let pair = [turning.largest, 1.0];
            gate.note(&LOCAL_ROTATION, &place, pair, limits.local_rotation, t);
        }
        // Of the others who asked for it wants to know.
        let asked = view.model.has_frames(body) || limits.strain.is_some();
        if asked && body.rigid.is_none() {
            let pair = [turning::strain_level(&body.elastic, &*strained), 1.0];
            gate.note(&STRAIN, &place, pair, limits.strain_limit(), t);
        }
        let way = way(view, body);
        let moved = way / size.max(f64::MIN_POSITIVE);
        if view.inertia().is_none() && view.explicit.is_none() {
            gate.note(&DISPLACEMENT, &place, [way, size], limits.displacement, t);
        } else if moved.is_nan() || moved > limits.displacement {
            far.push((body.name.clone(), way, moved));
        }
    }
    if judged {
        judge_references(view, limits, gate);
        rotation::judge_rotations(view, &turns, limits, gate);
    }
    for (body, way, moved) in far {
        note_far(view, &body, way, moved, findings);
    }
}

/// Reference points that carry no frame: what is tied to one follows its rotation linearly, whatever frames its body has.
fn judge_references(view: &View, limits: &Limits, gate: &mut Gate) {
    let (dofs, u) = (view.model.dofs, &view.frame.state.u);
    for reference in &view.model.references {
        let link = &view.model.links.all()[reference.link];
        if !link.framed && !view.model.frames.carries(link) {
            let place = format!("reference point {}", reference.name);
            let turned = norm(link.rotation(dofs, u));
            let t = view.frame.state.t;
            gate.note(&ROTATION, &place, [turned, 1.0], limits.rotation, t);
        }
    }
}

/// How far a body has turned at the last accepted state.
fn turning(view: &View, body: &Body, strained: &State) -> Turning {
    match body.rigid {
        Some(rigid) if view.model.links.all()[rigid.link].framed => Turning::default(),
        Some(rigid) => {
            let link = &view.model.links.all()[rigid.link];
            let turned = rotation_vector(
                link.rotation(view.model.dofs, &view.frame.state.u),
                view.model.dofs.dim,
            );
            Turning {
                mean: norm(turned),
                vector: turned,
                ..Turning::default()
            }
        }
        // Of what turns freely that is what it is bent by.
        None => turning::turning(&body.elastic, &strained.u),
    }
}

/// The largest displacement of a body `[m]`.
pub(crate) fn way(view: &View, body: &Body) -> f64 {
    let (dofs, u) = (view.model.dofs, view.displacements());
    let squares = body.points.clone().map(|p| {
        let way = dofs.vector(&u, p);
        dot(way, way)
    });
    let larger = |m: f64, s: f64| if s > m || s.is_nan() { s } else { m };
    squares.fold(0.0, larger).sqrt()
}

/// How far supports and obstacles have gone by now, at most `[m]`.
fn prescribed_way(view: &View) -> f64 {
    let constraints = view.constraints(view.frame.state.t);
    let values = constraints.fixed.iter().zip(&constraints.values);
    let held = values
        .filter(|(fixed, _)| **fixed)
        .map(|(_, value)| value.abs());
    let mut way = held.fold(0.0, f64::max);
    let start = view.model.steps.first().map_or(0.0, |s| s.start);
    for interface in &view.contact.interfaces {
        way = way.max(interface.obstacle_way(start, view.frame.state.t));
    }
    way
}

/// A body in motion that has left the model, once for each.
fn note_far(view: &View, body: &str, way: f64, moved: f64, findings: &mut Vec<Finding>) {
    let known = |f: &Finding| {
        let about = |g: &Suspect| g.what == LocationKind::Body && g.name == body;
        f.cause == DoctorCause::FarAway && f.suspects.iter().any(about)
    };
    if findings.iter().any(known) {
        return;
    }
    let mut finding = DoctorCause::FarAway.warning(format!(
        "body {body} has moved by {way}, {moved} times the size of the model and the way that is prescribed",
        way = figure(way),
        moved = digits(moved, 3),
    ))
    .blame(Suspect::body(body, "far from where it was"))
    .advise("if it is not meant to fly or fall, look for an obstacle or a support that is missing, and for loads, masses and velocities in the wrong unit");
    finding.step = Some(view.step_name().to_string());
    finding.time = Some(view.frame.state.t);
    doctor::note(findings, finding);
}
