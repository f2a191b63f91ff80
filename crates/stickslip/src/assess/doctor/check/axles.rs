//! Reference points that lie far from what they lead, and turn by numbers that look like degrees.

use std::f64::consts::TAU;

use super::super::finding::{DoctorCause, Finding};
use super::super::suspect::Suspect;
use super::common::{diameter, times};
use super::units::SIZE_RATIO;
use crate::math::{Vec3, distance};
use crate::model::definition::{Model, Reference};
use crate::model::scene::Scene;
use crate::number::figure;

pub(super) fn check(scene: &Scene) -> Vec<Finding> {
    let model = scene.model;
    let references = model.references.iter();
    let mut out: Vec<Finding> = references.filter_map(|r| far(scene, r)).collect();
    out.extend(degrees(model));
    out
}

/// The points of the mesh that a reference point leads or follows.
fn led(scene: &Scene, reference: &Reference) -> Vec<Vec3> {
    let model = scene.model;
    let hidden = model.links.all()[reference.link].hidden;
    let mut points: Vec<usize> = Vec::new();
    for frame in model.frames.all() {
        if frame.hidden() == Some(hidden) {
            points.extend(frame.points.clone());
        }
    }
    for coupling in scene.contact.couplings.all().iter().filter(|c| c.referred) {
        let dofs = coupling.rows.iter().flat_map(|r| &r.dofs);
        let touched: Vec<usize> = dofs.map(|&d| model.dofs.locate(d).0).collect();
        if touched.iter().any(|p| (hidden..hidden + 2).contains(p)) {
            points.extend(touched);
        }
    }
    let mesh = &model.mesh.points;
    let points = points.into_iter().filter_map(|p| mesh.get(p).copied());
    points.collect()
}

/// One that is farther from its points than bodies in one unit of length are.
fn far(scene: &Scene, reference: &Reference) -> Option<Finding> {
    let model = scene.model;
    let points = led(scene, reference);
    let size = diameter(&points);
    let centre = model.links.all()[reference.link].centre;
    let nearest = points.iter().map(|x| distance(*x, centre));
    let nearest = nearest.fold(f64::INFINITY, f64::min);
    let name = &reference.name;
    (nearest.is_finite() && size > 0.0 && nearest > SIZE_RATIO * size).then(|| {
        DoctorCause::MixedUnits.warning(format!(
            "reference point {name} is {nearest} away from the bodies and surfaces that move with it, {:.0} times their size {size}: is one in millimetres and the other in metres?",
            nearest / size,
            nearest = figure(nearest),
            size = figure(size),
        ))
        .blame(Suspect::key(format!("reference.{name}.point"), format!("{} away", figure(nearest))).at(centre))
        .advise("put the point where the axle is, in the unit of the meshes")
    })
}

/// Rotations of a whole number of radians beyond a turn: of a turn in radians the number has no end.
fn degrees(model: &Model) -> Vec<Finding> {
    let mut out = Vec::new();
    for support in &model.actions.supports {
        let mut largest: Option<(f64, &str)> = None;
        for e in support.entries.iter().filter(|e| !e.hold) {
            let (point, _) = model.dofs.locate(e.dof);
            let turned = |r: &&Reference| model.links.all()[r.link].hidden + 1 == point;
            let Some(reference) = model.references.iter().find(turned) else {
                continue;
            };
            let angle = e.value / model.links.all()[reference.link].length;
            for t in times(model) {
                let angle = angle * support.schedule.at(t);
                let turn = angle.abs();
                let whole = (turn - turn.round()).abs() < 1e-9 * turn;
                if turn > TAU && whole && largest.is_none_or(|l| turn > l.0.abs()) {
                    largest = Some((angle, &reference.name));
                }
            }
        }
        let Some((angle, reference)) = largest else {
            continue;
        };
        let name = &support.name;
        out.push(
            DoctorCause::MixedUnits.note(format!(
                "support {name} turns reference point {reference} by {angle:.6} rad, {:.2} turns: rotations are in radians, and a whole number of them looks like degrees",
                angle.abs() / TAU
            ))
            .blame(Suspect::key(format!("support.{name}"), format!("{angle:.6} rad")))
            .advise(format!("if degrees are meant, write {:.9}", angle.to_radians())),
        );
    }
    out
}
