//! Judges what small rotations leave out at interfaces.

use super::figures::ROTATION_TO_APPROACH;
use super::gate::Gate;
use super::missed::{Turned, missed_gaps};
use super::view::View;
use crate::contact::interface::ContactView;
use crate::contact::look;
use crate::math::{Vec3, dot};
use crate::model::limits::Limits;
use crate::model::rigid::anchors;

/// Angle in radians below which it is not judged: half its square is less than rounding leaves of most coordinates.
const NO_ROTATION: f64 = 1e-7;

/// Judges what rotations of bodies, by body `[rad]`, leave out at interfaces; `turns` are zero of those that turn in frames.
pub(super) fn judge_rotations(view: &View, turns: &[Vec3], limits: &Limits, gate: &mut Gate) {
    let t = view.frame.state.t;
    let far = |turn: &Vec3| dot(*turn, *turn) > NO_ROTATION * NO_ROTATION;
    let turned: Vec<Option<Turned>> = match turns.iter().any(far) {
        true => (turns.iter().zip(anchors::anchors(view, t)))
            .map(|(by, anchors)| far(by).then_some(Turned { by: *by, anchors }))
            .collect(),
        false => vec![None; turns.len()],
    };
    let energy = view.elastic_energy();
    for interface in view.contacts() {
        let place = format!("interface {}", interface.name);
        let r = look::resultant(interface, &view.frame.state.u);
        if r.carried <= 0.0 {
            continue;
        }
        let missed = missed(view, interface, &turned);
        // Beside the elastic approach, as penetration is; both sides times the force.
        let elastic = (2.0 * energy).max(r.carried * look::quality(interface).layer);
        let pair = [missed * r.carried, elastic];
        let limit = limits.rotation_to_approach;
        match view.inertia().is_some() || view.explicit.is_some() {
            true => gate.note_in_motion(&ROTATION_TO_APPROACH, &place, pair, limit, t),
            false => gate.note(&ROTATION_TO_APPROACH, &place, pair, limit, t),
        }
    }
}

/// The mean of what is missed of the gap where an interface presses `[m]`.
fn missed(view: &View, interface: ContactView, turned: &[Option<Turned>]) -> f64 {
    if turned.iter().all(Option::is_none) {
        return 0.0;
    }
    let points = look::pressing(interface);
    let of = |point: Option<usize>| turned[body_of(view, point?)?].as_ref();
    let sides: Vec<_> = points.iter().map(|p| p.sides.map(of)).collect();
    let missed = missed_gaps(&points, &sides);
    let each = missed.iter().zip(&points);
    let [sum, force] = each.fold([0.0; 2], |[sum, force], (m, p)| {
        [sum + m.abs() * p.force, force + p.force]
    });
    sum / force.max(f64::MIN_POSITIVE)
}

fn body_of(view: &View, point: usize) -> Option<usize> {
    let mut bodies = view.model.bodies.iter();
    bodies.position(|b| b.points.contains(&point))
}
