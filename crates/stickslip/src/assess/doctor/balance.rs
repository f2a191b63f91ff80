//! Whether contact can balance what acts on a body that nothing else holds.

use super::finding::{DoctorCause, Finding};
use super::friction::friction_coefficient;
use super::places;
use super::surfaces::{FACING_COSINE, Opposite};
use super::suspect::Suspect;
use crate::assess::view::View;
use crate::contact::interface::Primary;
use crate::math::{Vec3, add, add_scaled, dot, norm, normalize, scale, vector};
use crate::model::definition::Body;
use crate::model::rigid::modes::modes;
use crate::model::scene::Scene;
use crate::number::figure;
use crate::tolerance::{NEGLIGIBLE, SAME};

/// Directions in which contact can push one body.
#[derive(Default)]
struct Push {
    directions: Vec<Vec3>,
    /// Largest coefficient of friction; `None` where a limit does not depend on pressure.
    friction: Option<f64>,
    interface: String,
}

/// Bodies without supports, springs and couplings to others on which the loads at time `t` and contact cannot be in balance.
pub(super) fn unbalanced(view: &View, t: f64) -> Option<Finding> {
    beyond(view, t, NEGLIGIBLE)
}

/// The same of loads that come to the limit of friction, where nothing is left to hold a body.
pub(super) fn at_limit(view: &View, t: f64) -> Option<Finding> {
    beyond(view, t, -NEGLIGIBLE)
}

fn beyond(view: &View, t: f64, slight: f64) -> Option<Finding> {
    let model = view.model;
    let held = view.constraints(t).fixed;
    let loads = view.loads(t);
    let scale_of_loads = vector::norm(&loads);
    let modes = modes(model);
    let couplings = view.couplings();
    let rows: Vec<_> = couplings.acting(t).chain(couplings.stops(t)).collect();
    for (index, body) in model.bodies.iter().enumerate() {
        let mut dofs: Vec<usize> =
            (model.dofs.of(body.points.start, 0)..model.dofs.of(body.points.end, 0)).collect();
        if let Some(rigid) = body.rigid {
            // Its points are no unknowns; what is supported or loaded is the body itself.
            let link = &model.links.all()[rigid.link];
            dofs = link.motions(model.dofs).iter().map(|m| m.0).collect();
        }
        // What holds or loads a reference point that is tied to it does so to the body.
        let own = model.references.iter().filter(|r| r.body == Some(index));
        let own = own.map(|r| &model.links.all()[r.link]);
        dofs.extend(own.flat_map(|link| link.motions(model.dofs)).map(|m| m.0));
        let sprung = model.actions.springs.iter().flat_map(|s| s.entries());
        let sprung = sprung
            .into_iter()
            .any(|(dof, k)| *k > 0.0 && dofs.contains(dof));
        let own = modes.iter().filter(|m| m.body == index);
        let coupled = own
            .into_iter()
            .any(|m| rows.iter().any(|row| m.along(model, row).abs() > SAME));
        if sprung || coupled || dofs.iter().any(|&dof| held[dof]) {
            continue;
        }
        let Some(push) = push(view, body, t) else {
            continue;
        };
        let mut force = [0.0; 3];
        for &dof in &dofs {
            let (point, component) = model.dofs.locate(dof);
            if !model.links.turns(point) {
                force[component] += loads[dof];
            }
        }
        let sum = push.directions.iter().fold([0.0; 3], |s, d| add(s, *d));
        let Some(mean) = normalize(sum) else {
            continue;
        };
        let narrowest = push.directions.iter().map(|d| dot(*d, mean));
        let narrowest = narrowest.fold(f64::INFINITY, f64::min);
        let found = judge(
            &body.name,
            &push,
            mean,
            narrowest,
            force,
            SAME * scale_of_loads,
            slight,
        );
        if let Some((cause, message)) = found {
            let finding = cause
                .warning(message)
                .blame(places::body(model, &body.name, "held by contact alone"))
                .blame(Suspect::interface(&push.interface, ""));
            return Some(match cause {
                DoctorCause::FreeRigidMode => {
                    finding.advise("support the body on its other side, or hold it by springs")
                }
                _ => finding
                    .advise("no equilibrium exists: lower the load, raise friction or support the motion")
                    .advise("make the step dynamic if the body is meant to take off"),
            });
        }
    }
    None
}

/// Why a body cannot be in balance, given the mean direction in which contact pushes and the smallest cosine to it.
fn judge(
    name: &str,
    push: &Push,
    mean: Vec3,
    narrowest: f64,
    force: Vec3,
    nothing: f64,
    slight: f64,
) -> Option<(DoctorCause, String)> {
    let mu = push.friction?;
    if norm(force) <= nothing {
        // What pushes back along the mean direction is friction at most.
        return (narrowest > mu / (1.0 + mu * mu).sqrt()).then(|| {
            (
                DoctorCause::FreeRigidMode,
                format!(
                    "contact pushes body {name} away and nothing pushes back: no support, no spring and no load holds it"
                ),
            )
        });
    }
    // The surface is flat if no contact normal differs from their mean by more than acos(0.999), 2.6 degrees.
    if narrowest < 0.999 {
        return None;
    }
    let pressing = -dot(force, mean);
    let along = norm(add_scaled(force, pressing, mean));
    if pressing < -nothing {
        return Some((
            DoctorCause::SlidesAway,
            format!(
                "the loads pull body {name} off what it lies on, by {}",
                figure(-pressing)
            ),
        ));
    }
    (along > (1.0 + slight) * mu * pressing + nothing).then(|| {
        (
            DoctorCause::SlidesAway,
            format!(
                "body {name} slides away: the loads push it along its contact by {along}, and friction resists {} at most",
                figure(mu * pressing),
                along = figure(along),
            ),
        )
    })
}

/// How contact can push a body; `None` if it cannot, or does more than push.
fn push(scene: &Scene, body: &Body, t: f64) -> Option<Push> {
    let mut push = Push {
        friction: Some(0.0),
        ..Push::default()
    };
    for interface in &scene.contact.interfaces {
        if !interface.schedule.active(t) {
            continue;
        }
        let within = |local: usize| body.points.contains(&interface.nodes[local]);
        let ours = interface.points.iter().any(|p| within(p.nodes[0]));
        let theirs = match &interface.primary {
            Primary::Facets(facets) => facets.iter().any(|f| within(f.nodes[0])),
            Primary::Rigid(..) => false,
        };
        if !ours && !theirs {
            continue;
        }
        // What is glued to another body is one with it, and pulled as well as pushed.
        if interface.laws.tied {
            return None;
        }
        let sign = if ours { 1.0 } else { -1.0 };
        let mut opposite = Opposite::new(interface, t);
        for p in &interface.points {
            let Some(nearest) = opposite.nearest(p.position(&interface.reference)) else {
                continue;
            };
            if dot(nearest.normal, p.normal) < FACING_COSINE {
                push.directions.push(scale(sign, nearest.normal));
            }
        }
        push.interface.clone_from(&interface.name);
        let frictional = interface.laws.friction_law().frictional();
        push.friction = match (push.friction, friction_coefficient(interface)) {
            (Some(a), Some(b)) => Some(a.max(b)),
            (before, None) if !frictional => before,
            _ => None,
        };
    }
    (!push.directions.is_empty()).then_some(push)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn friction_holds_a_block_up_to_its_limit() {
        let push = Push {
            friction: Some(0.3),
            ..Push::default()
        };
        let up = [0.0, 1.0, 0.0];
        let cause =
            |force: Vec3| judge("block", &push, up, 1.0, force, 1e-9, NEGLIGIBLE).map(|f| f.0);
        assert_eq!(cause([0.29, -1.0, 0.0]), None);
        assert_eq!(cause([0.31, -1.0, 0.0]), Some(DoctorCause::SlidesAway));
        assert_eq!(cause([0.0, 0.1, 0.0]), Some(DoctorCause::SlidesAway));
        assert_eq!(cause([0.0; 3]), Some(DoctorCause::FreeRigidMode));
        // A seat that holds from both sides.
        assert!(judge("pin", &push, up, -0.2, [0.0; 3], 1e-9, NEGLIGIBLE).is_none());
    }
}
