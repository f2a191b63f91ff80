//! What sliding has worn off both surfaces, each in its own coordinates, and by how much that opens the gap.
//!
//! The secondary has a depth at each contact point. With dual functions as weights, the mean gap of a point sees the depth of that point and of no other, so that
//! the depth of a point times its area is volume lost. The primary has a depth at its nodes, linear in between: what a point takes from it is divided among the
//! corners of the facets that it lies over by the weights they have in its gap, over the area of each of them, and the gap takes the mean with the same
//! weights. An obstacle has no nodes, and those of a primary are of no use where its material moves past under the mesh: there the depth is kept on a track
//! ([`WearTrack`](crate::contact::worn::WearTrack)). What is lost on one side and the other is the volume that the laws say, to rounding, wherever one slides on the other.
//!
//! Within an increment the depth of both follows from the pressure of the point at its end, most often in proportion: a compliance in series with the contact
//! ([`LawInput::worn`](crate::contact::response::LawInput::worn)). The path in it is that which the iterate slides. Its derivative is in the tangent where there is
//! friction; without friction it is left out, so that the tangent stays symmetric: the solution does not depend on that.

use super::super::definition::InterfaceDefinition;
use super::super::evaluation::{Evaluation, Evaluations};
use super::super::history::{History, PointHistory};
use super::super::input::InterfaceInput;
use super::super::scene::Scene;
use super::super::sides::facet_weights;
use super::along_track::track_depth;
use crate::contact::kinematics::Stencil;
use crate::contact::law::wear::{Feedback, Sliding, WearPoint, WearRate};
use crate::contact::response::{LawInput, Response, Status, Worn, respond};
use crate::math::{Vec3, add_scaled, norm, scale};

/// Evaluations of the laws after which path and pressure of a point that wears are taken as they are.
const EVALUATIONS: usize = 50;

/// Length of a way along two directions.
pub(in crate::contact) fn length(frame: [Vec3; 2], way: [f64; 2]) -> f64 {
    norm(add_scaled(scale(way[0], frame[0]), way[1], frame[1]))
}

/// Length of the way that a point slid, which moved by `moved` in all; a sticking point slides nowhere, a frictionless one all the way it moves.
pub(in crate::contact) fn path(
    response: &Response,
    frictional: bool,
    frame: [Vec3; 2],
    moved: Vec3,
) -> f64 {
    match (response.status, frictional) {
        (Status::Open, _) => 0.0,
        (_, true) => length(frame, response.sliding_path),
        (_, false) => norm(moved),
    }
}

/// Depth that is open at a point before the increment, which lies over the nodes of `sides` `[m]`.
pub(in crate::contact) fn wear_gap(i: usize, scene: &Scene, sides: &[(usize, f64)]) -> f64 {
    let interface = scene.interface;
    if !interface.laws.wears_away() {
        return 0.0;
    }
    if interface.opposite_wear.track.is_some() {
        return interface.state.worn.own_depth(i) + track_depth(i, scene, sides);
    }
    let worn = &interface.state.worn;
    let theirs = sides.iter().filter(|(n, _)| *n < interface.primary_nodes);
    let theirs = theirs.map(|&(n, w)| -w * worn.opposite_depth(n));
    interface.state.worn.own_depth(i) + theirs.sum::<f64>()
}

/// By how much a point that slides a `path` over a time wears both sides away, near a pressure. `rubs`: the part of the pressure that resists its slip, where that is not the limit.
pub(in crate::contact) fn wear_compliance(
    interface: InterfaceInput,
    i: usize,
    path: f64,
    dt: f64,
    pressure: f64,
    rubs: Option<f64>,
) -> Worn {
    let laws = &interface.laws;
    if !laws.wears_away() || laws.feedback != Feedback::Implicit {
        return Worn::default();
    }
    let h = &interface.state.points[i];
    // The part of the pressure that the shear was at the last accepted state.
    let shear = match (rubs, h.pressure > 0.0) {
        (Some(part), _) => part,
        (None, true) => h.limit / h.pressure,
        (None, false) => 0.0,
    };
    let way = interface.conditions.cycles() * path;
    let at = WearPoint {
        path: h.path,
        way,
        energy: h.spent,
        spent: match rubs {
            Some(part) => way * part * pressure,
            None => way * h.limit,
        },
        pressure,
        speed: path / dt,
    };
    // h = k(p) p s has the tangent k p s + (k + p k') s (p' - p).
    let mut worn = Worn::default();
    let felt = interface
        .state
        .worn
        .track
        .felt
        .get(i)
        .copied()
        .unwrap_or(1.0);
    for (rate, part) in wear_rates(interface.definition, &at)
        .into_iter()
        .zip([1.0, felt])
    {
        let change = pressure * rate.d_pressure;
        worn.slope += part * (rate.per_path(shear) + change) * way;
        worn.base -= part * pressure * change * way;
    }
    worn
}

/// What friction dissipates over a path, per pressure and path; `None` where that is the limit, as shear is against the slip in all directions alike.
fn rubs(response: &Response, path: f64) -> Option<f64> {
    let [pressure, shear @ ..] = response.traction;
    (response.ellipse.is_some() && path > 0.0 && pressure > 0.0).then(|| {
        let [first, second] = response.sliding_path;
        -(shear[0] * first + shear[1] * second).min(0.0) / (path * pressure)
    })
}

/// What the laws answer a point that wears as it slides. How far it slides depends on the pressure, which falls with what is worn off: the way rises from what it
/// is without wear and is never longer than the whole, so that evaluations one after the other come to its end. Where the rate depends on the pressure they are those of
/// Newton's method, of a depth that rises with the pressure.
pub(in crate::contact) fn wearing(
    interface: InterfaceInput,
    i: usize,
    stencil: &Stencil,
    moved: Vec3,
    at: &mut LawInput,
) -> Response {
    let mut response = respond::respond(&interface.laws, stencil, at);
    if at.pressed {
        return response;
    }
    for _ in 0..EVALUATIONS {
        let path = sliding_distance(interface.definition, &response, stencil.frame_before, moved);
        let pressure = response.traction[0].max(0.0);
        let rubs = rubs(&response, path);
        let worn = wear_compliance(interface, i, path, at.dt, pressure, rubs);
        let off = worn.depth(pressure) - at.worn.depth(pressure);
        let turned = worn.slope - at.worn.slope;
        // A smaller change of the depth is none.
        if off.abs() <= 1e-13 * worn.slope * pressure && turned.abs() <= 1e-13 * worn.slope {
            break;
        }
        at.worn = worn;
        response = respond::respond(&interface.laws, stencil, at);
    }
    deepen(interface, stencil, moved, at, &mut response);
    response
}

/// Adds that what is worn off grows with the path that a point slides, and that with slip and pressure. Where there is no friction the tangent is symmetric, and
/// stays so.
fn deepen(
    interface: InterfaceInput,
    stencil: &Stencil,
    moved: Vec3,
    at: &LawInput,
    response: &mut Response,
) {
    let slope = response.d_gap[0][0];
    let path = sliding_distance(interface.definition, response, stencil.frame_before, moved);
    if slope == 0.0 || path <= 0.0 {
        return;
    }
    let per_path = at.worn.depth(response.traction[0]) / path;
    let [with_pressure, with_slip @ ..] = response.d_path.map(|d| per_path * d);
    let settled = 1.0 / (1.0 - slope * with_pressure);
    // Shear follows the pressure.
    for (row, multipliers) in response.d_gap.iter_mut().zip(&mut response.d_multiplier) {
        let [with_gap, with_slips @ ..] = row;
        *with_gap *= settled;
        multipliers[0] *= settled;
        for (d, with_slip) in with_slips.iter_mut().zip(with_slip) {
            *d += *with_gap * with_slip;
        }
    }
}

/// What a point wears off its own side and the other over an increment, per area that it stands for `[m]`. `pressed`: pressure times path by the
/// trapezoidal rule.
pub(in crate::contact) fn wear_increment(
    interface: InterfaceInput,
    h: &PointHistory,
    e: &Evaluation,
    pressed: f64,
    dissipated: f64,
    dt: f64,
) -> [f64; 2] {
    let path = sliding_distance(interface.definition, &e.response, e.frames.before, e.moved);
    let pressed = match interface.laws.feedback {
        Feedback::None => pressed,
        // That is what the gap was opened by.
        _ => e.response.traction[0].max(0.0) * path,
    };
    let slid = Sliding {
        pressed,
        dissipated,
    };
    let at = WearPoint {
        path: h.path,
        way: interface.conditions.cycles() * path,
        energy: h.spent,
        spent: interface.conditions.cycles() * dissipated,
        pressure: if path > 0.0 { pressed / path } else { 0.0 },
        speed: path / dt,
    };
    wear_rates(interface.definition, &at).map(|r| interface.conditions.cycles() * r.depth(slid))
}

/// Adds volumes that points take from the primary to the depths of its corners.
pub(in crate::contact) fn add_nodal_wear(
    definition: &InterfaceDefinition,
    last: &Evaluations,
    volumes: &[f64],
    next: &mut History,
) {
    if definition.opposite_wear.is_empty() || volumes.iter().all(|v| *v == 0.0) {
        return;
    }
    let mut lost = vec![0.0; definition.nodes.len()];
    for (i, volume) in volumes.iter().enumerate() {
        for (node, w) in facet_weights(definition.primary_nodes, last, i) {
            for end in definition.opposite_wear.ends[node] {
                lost[end] += 0.5 * w * volume;
            }
        }
    }
    let depths = &mut next.worn.opposite;
    depths.resize(definition.nodes.len(), 0.0);
    let areas = definition.opposite_wear.area.iter().zip(&lost);
    for (depth, (area, lost)) in depths.iter_mut().zip(areas) {
        if *area > 0.0 {
            *depth += lost / area;
        }
    }
    for node in 0..definition.opposite_wear.ends.len() {
        let [a, b] = definition.opposite_wear.ends[node];
        if a != b {
            depths[node] = 0.5 * (depths[a] + depths[b]);
        }
    }
}

/// How fast the side with the points and the other one wear at a point.
fn wear_rates(definition: &InterfaceDefinition, at: &WearPoint) -> [WearRate; 2] {
    let mut rates = definition.laws.wear.as_dyn().rates(at);
    if definition.exchanged {
        rates.reverse();
    }
    rates
}

/// Length of the way over which a point wears: what the spring of a point that sticks gives way is none, in motion neither.
pub(in crate::contact) fn sliding_distance(
    definition: &InterfaceDefinition,
    response: &Response,
    frame: [Vec3; 2],
    moved: Vec3,
) -> f64 {
    let frictional = definition.laws.friction_law().frictional();
    let sticks = frictional && definition.laws.slip.as_dyn().sticks();
    match response.status {
        Status::Stick if sticks => 0.0,
        _ => path(response, frictional, frame, moved),
    }
}
