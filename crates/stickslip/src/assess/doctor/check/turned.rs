//! Rotations that supports prescribe and that are too far for small ones.

use super::super::finding::{DoctorCause, Finding};
use super::super::places::body;
use super::super::suspect::Suspect;
use super::common::{median, times};
use super::driven::pair;
use super::measured::Measured;
use crate::assess::missed::{Turned, missed_gaps};
use crate::contact::interface::{InterfaceDefinition, Start};
use crate::contact::look::Pressing;
use crate::math::{Vec3, norm};
use crate::model::definition::{Body, Model};
use crate::model::limits::GateMode;
use crate::model::rigid::anchors;
use crate::model::scene::Scene;
use crate::number::digits;

/// A rotation that a support prescribes.
struct Turn<'a> {
    /// The support, and the reference point or body that it turns.
    support: &'a str,
    what: &'a str,
    /// The bodies that turn with it, by small rotations.
    bodies: Vec<usize>,
    by: Vec3,
    time: f64,
}

/// One finding for each reference point or rigid body whose rotation is prescribed to go too far.
pub(super) fn check(scene: &Scene, measured: &[Measured]) -> Vec<Finding> {
    let limits = &scene.model.reports.quality;
    if limits.gate == GateMode::Off {
        return Vec::new();
    }
    // The worst of each, by how much it is beyond its limit.
    let mut out: Vec<(&str, f64, Finding)> = Vec::new();
    for t in times(scene.model) {
        for turn in turns(scene, t) {
            let angle = norm(turn.by);
            let far = (angle > limits.rotation).then(|| (angle / limits.rotation, None));
            let interfaces = scene.contact.interfaces.iter().zip(measured);
            let missed = interfaces.filter_map(|(interface, measured)| {
                let [missed, room] = missed(scene, interface, measured, &turn)?;
                let beyond = missed / (limits.rotation_to_approach * room);
                (beyond > 1.0).then_some((beyond, Some((interface.name.as_str(), [missed, room]))))
            });
            let worst = far
                .into_iter()
                .chain(missed)
                .max_by(|a, b| a.0.total_cmp(&b.0));
            let Some((beyond, missed)) = worst else {
                continue;
            };
            let known = out.iter().position(|(what, ..)| *what == turn.what);
            let found = || (turn.what, beyond, finding(scene, &turn, missed));
            match known {
                None => out.push(found()),
                Some(k) if out[k].1 < beyond => out[k] = found(),
                Some(_) => {}
            }
        }
    }
    out.into_iter().map(|(_, _, found)| found).collect()
}

/// The rotations that supports prescribe at a time, of what does not turn in a frame.
fn turns<'a>(scene: &Scene<'a>, t: f64) -> Vec<Turn<'a>> {
    let model = scene.model;
    let mut out: Vec<Turn> = Vec::new();
    let mut tied = None;
    for support in model
        .actions
        .supports
        .iter()
        .filter(|s| s.schedule.active(t))
    {
        let factor = support.schedule.at(t);
        for e in support.entries.iter().filter(|e| !e.hold) {
            let (point, c) = model.dofs.locate(e.dof);
            let Some(index) = model.links.of_hidden(point) else {
                continue;
            };
            let link = &model.links.all()[index];
            let framed = link.framed || model.frames.carries(link);
            if point == link.hidden || framed {
                continue;
            }
            let own = model
                .bodies
                .iter()
                .position(|b| b.rigid.is_some_and(|r| r.link == index));
            let reference = model.references.iter().position(|r| r.link == index);
            let (what, bodies) = match (own, reference) {
                (Some(body), _) => (model.bodies[body].name.as_str(), vec![body]),
                (None, Some(reference)) => {
                    let tied = tied.get_or_insert_with(|| anchors::tied_to_references(scene, t));
                    let own = tied.iter().find(|(r, _)| *r == reference);
                    let bodies = own.map_or(Vec::new(), |(_, bodies)| bodies.clone());
                    (model.references[reference].name.as_str(), bodies)
                }
                (None, None) => continue,
            };
            let axis = if model.dofs.dim == 2 { 2 } else { c };
            let angle = factor * e.value / link.length;
            match out.iter_mut().find(|turn| turn.what == what) {
                Some(turn) => turn.by[axis] = angle,
                None => {
                    let mut by = [0.0; 3];
                    by[axis] = angle;
                    out.push(Turn {
                        support: &support.name,
                        what,
                        bodies,
                        by,
                        time: t,
                    });
                }
            }
        }
    }
    out
}

fn turns_in_cells(body: &Body) -> bool {
    body.rigid.is_none() && body.elastic.is_corotational()
}

/// What an interface misses of its gap at the start, in the mean, and the gap or overlap that counts there `[m]`; `None` where neither is known before anything presses.
fn missed(
    scene: &Scene,
    interface: &InterfaceDefinition,
    measured: &Measured,
    turn: &Turn,
) -> Option<[f64; 2]> {
    let model = scene.model;
    let turning = |body: Option<usize>| {
        body.filter(|b| turn.bodies.contains(b) && !turns_in_cells(&model.bodies[*b]))
    };
    let sides = pair(model, interface);
    let turning = sides.map(turning);
    let counts = matches!(interface.initial.start, Start::AsMeshed | Start::Ramp);
    if turning == [None, None] || !counts || !interface.schedule.active(turn.time) {
        return None;
    }
    let anchors = anchors::anchors(scene, turn.time);
    let turned = turning.map(|body| {
        body.map(|b| Turned {
            by: turn.by,
            anchors: anchors[b],
        })
    });
    let mut points = Vec::new();
    let mut gaps = Vec::new();
    let each = interface.points.iter().zip(&measured.gaps);
    for ((point, &gap), beside) in each.zip(&measured.nearest) {
        let Some(beside) = beside.filter(|_| gap.is_finite()) else {
            continue;
        };
        gaps.push(gap);
        points.push(Pressing {
            place: interface.place(point),
            normal: beside.normal,
            force: point.area,
            sides: [None, None],
        });
    }
    let overlap: Vec<f64> = gaps.iter().filter(|g| **g < 0.0).map(|g| -g).collect();
    let least = gaps.iter().copied().fold(f64::INFINITY, f64::min);
    let room = match 2 * overlap.len() > gaps.len() {
        true => median(overlap),
        // Where surfaces touch at some points, what counts is how far they approach.
        false => least,
    };
    if !(room > 0.0 && room.is_finite()) {
        return None;
    }
    let both = [turned[0].as_ref(), turned[1].as_ref()];
    let missed = missed_gaps(&points, &vec![both; points.len()]);
    let sum: f64 = missed
        .iter()
        .zip(&points)
        .map(|(m, p)| m.abs() * p.force)
        .sum();
    let area: f64 = points.iter().map(|p| p.force).sum();
    Some([sum / area, room])
}

fn finding(scene: &Scene, turn: &Turn, missed: Option<(&str, [f64; 2])>) -> Finding {
    let model: &Model = scene.model;
    let angle = norm(turn.by);
    let names: Vec<&str> = turn
        .bodies
        .iter()
        .map(|&b| model.bodies[b].name.as_str())
        .collect();
    let whose = match names.as_slice() {
        [] => String::new(),
        [one] if *one == turn.what => String::new(),
        names => format!(" and with it {}", names.join(", ")),
    };
    let said = match missed {
        None => format!(
            "and small rotations go to {:.2} rad (`quality.rotation`): bodies grow by half the square of the angle, here by {}",
            model.reports.quality.rotation,
            digits(0.5 * angle * angle, 2)
        ),
        Some((interface, [missed, room])) => format!(
            "and rotations are small ones: at interface {interface} its surface misses {missed} of where it should be, {:.2} times the gap or interference there of {room}",
            missed / room,
            missed = digits(missed, 3),
            room = digits(room, 3)
        ),
    };
    let mut found = DoctorCause::LargeRotation
        .warning(format!(
            "support {} turns {}{whose} by {angle:.3} rad, {said}",
            turn.support, turn.what
        ))
        .blame(Suspect::key(
            format!("support.{}", turn.support),
            format!("{angle:.3} rad"),
        ));
    if let Some((interface, _)) = missed {
        found = found.blame(Suspect::interface(interface, "turned by a small rotation"));
    }
    let remark = format!("turned by {angle:.3} rad");
    found = found.blame_all(names.iter().map(|name| body(model, name, &*remark)));
    match turn.bodies.first().map(|&b| &model.bodies[b]) {
        Some(body) if body.rigid.is_some() && body.name == turn.what => found.advise(format!(
            "`body.{0}.rotation.with` of a reference point that the support turns in its place",
            body.name
        )),
        Some(body) => found.advise(format!(
            "`body.{0}.rotation.with = \"{1}\"` in place of the coupling, and supports that hold the coupled points of {0} in its frame (`x = 0, y = 0` on the set of the coupling)",
            body.name, turn.what
        )),
        None => found.advise("check the unit of the angle: rotations are in radians"),
    }
}
