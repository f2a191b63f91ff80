//! Velocities given to points that have no mass.

use super::super::finding::{DoctorCause, Finding};
use super::super::suspect::Suspect;
use crate::model::definition::Initial;
use crate::model::scene::Scene;
use crate::solve::inertia::light;

pub(super) fn check(scene: &Scene) -> Vec<Finding> {
    let model = scene.model;
    let all = model.actions.initials.iter();
    all.filter_map(|initial| massless(scene, initial)).collect()
}

/// Initial velocities of nothing but points of contact, whose mass the step gives to their neighbours: they have no momentum.
fn massless(scene: &Scene, initial: &Initial) -> Option<Finding> {
    let model = scene.model;
    let step = model.steps.get(initial.step)?;
    let dynamic = step.dynamic.as_ref().filter(|_| !step.is_explicit())?;
    let mut light = light(model, scene.contact, dynamic);
    for body in &model.bodies {
        let points = &mut light[body.points.clone()];
        if body.rigid.is_some() || points.iter().all(|l| *l) {
            points.fill(false);
        }
    }
    let moving = initial.velocities.iter().filter(|v| v.1 != 0.0);
    let points: Vec<usize> = moving.map(|v| model.dofs.locate(v.0).0).collect();
    if points.is_empty() || !points.iter().all(|&p| light[p]) {
        return None;
    }
    let name = &initial.name;
    Some(
        DoctorCause::NothingActs.warning(format!(
            "initial {name} gives velocities only to contact points, which have no mass in step {} (it is redistributed to their neighbours): nothing moves",
            step.name
        ))
        .blame(Suspect::key(format!("initial.{name}.set"), "points without mass"))
        .advise("give the velocity to the whole body, or to points behind its surface")
        .advise("keep the mass where it is (`dynamic.contact-mass = \"as-meshed\"`)"),
    )
}
