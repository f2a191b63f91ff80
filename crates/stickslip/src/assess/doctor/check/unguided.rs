//! Bodies that stand on a curved surface as a ball stands on a ball, with nothing beside it.

use super::super::finding::{DoctorCause, Finding};
use super::super::places::body;
use super::super::suspect::Suspect;
use super::curved::rest;
use super::driven::{meets_others, pair};
use crate::assess::view::View;
use crate::contact::interface::InterfaceDefinition;
use crate::contact::look::Opposite;
use crate::math::{dot, norm, scale, sub};
use crate::number::figure;

/// A body under dead loads that roll it off what it stands on. When it rolls by an angle `θ` over a contact with the curvature `κ` between the surfaces, a load at the height `h` above the
/// contact sinks by `(h - 1/κ) θ²/2`: where that is positive it is at rest in the middle only, and any push brings it down.
pub(super) fn check(view: &View, interface: &InterfaceDefinition) -> Option<Finding> {
    let model = view.model;
    let step = model.steps.first().filter(|s| s.dynamic.is_none())?;
    if interface.laws.tied || !interface.schedule.active(step.end) {
        return None;
    }
    let held = view.constraints(step.end).fixed;
    let loads = view.loads(step.end);
    let sides = pair(model, interface);
    for (side, index) in sides.into_iter().enumerate() {
        let Some(index) = index else { continue };
        let owner = &model.bodies[index];
        let dofs = || {
            owner
                .points
                .clone()
                .flat_map(|p| (0..model.dofs.dim).map(move |c| model.dofs.of(p, c)))
        };
        let sprung = model.actions.springs.iter().flat_map(|s| s.entries());
        let sprung = sprung.into_iter().any(|(d, _)| dofs().any(|own| own == *d));
        let led = model.references.iter().any(|r| r.body == Some(index));
        let guided = dofs().any(|d| held[d]) || sprung || led || owner.rigid.is_some();
        if guided || meets_others(view, interface, index) {
            continue;
        }
        let (x, curvature) = rest(interface, step.start)?;
        let mut opposite = Opposite::new(interface, step.start);
        let normal = opposite.nearest(x)?.normal;
        // Out of what the body stands on.
        let up = if side == 0 {
            normal
        } else {
            scale(-1.0, normal)
        };
        let (mut pressed, mut moment, mut all) = (0.0, 0.0, 0.0);
        for p in owner.points.clone() {
            let f = model.dofs.vector(&loads, p);
            pressed -= dot(f, up);
            moment -= dot(f, up) * dot(sub(model.mesh.points[p], x), up);
            all += norm(f);
        }
        // Loads that push against each other say nothing of a height.
        if pressed <= 0.5 * all || all == 0.0 {
            continue;
        }
        let height = moment / pressed;
        // The height may exceed the radius by a thousandth without a word: a wheel under its own weight stands as well here as there.
        if curvature <= 0.0 || height * curvature <= 1.0 + 1e-3 {
            continue;
        }
        let name = &interface.name;
        return Some(
            DoctorCause::FreeRigidMode.warning(format!(
                "interface {name}: nothing guides body {}, which stands like a ball on a ball: the loads press at a height of {height} above the contact, more than the radius of {} between the surfaces, and at the slightest push it rolls off",
                owner.name,
                figure(1.0 / curvature), height = figure(height)))
            .blame(body(model, &owner.name, "held beside its contact by nothing"))
            .blame(Suspect::interface(name, "the only thing that holds it"))
            .advise("support its motion along the contact where it is really guided: `[support.NAME]` of the points that are loaded, across the load"),
        );
    }
    None
}
