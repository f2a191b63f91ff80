//! Points of an interface as a friction problem knows them.

use super::cache::Cache;
use super::evaluation::{Batch, Evaluation};
use super::input::InterfaceInput;
use super::parts::InterfaceForce;
use super::pass::evaluate_all;
use super::scene::Wants;
use crate::friction::PointLaw;
use crate::math::vector::dot;
use crate::math::{add_scaled, scale};
use crate::system::{InSpace, Stage, StickTrial};

/// What every point would carry if it was pressed and stuck, and within which limit. `None` where laws are not asked point by point, or are none.
pub(super) fn stick_trials(
    interface: InterfaceInput,
    cache: &mut Cache,
    stage: &Stage,
) -> Option<Vec<Option<StickTrial>>> {
    if interface.laws.tied
        || interface.laws.user.friction.is_some()
        || interface.laws.user.normal.is_some()
    {
        return None;
    }
    if !interface.schedule.active(stage.at.t) {
        return Some(vec![None; interface.points.len()]);
    }
    let wants = Wants {
        tangent: true,
        pressed: true,
        ..Wants::default()
    };
    evaluate_all(interface, cache, stage, wants);
    let (evaluations, in_space) = (&cache.trial, &cache.geometry.in_space);
    let found = evaluations.points.iter().enumerate();
    let found = found
        .map(|(i, e)| point_alone(interface, i, e, evaluations.batch(i), in_space))
        .collect();
    Some(found)
}

fn point_alone(
    interface: InterfaceInput,
    i: usize,
    e: &Evaluation,
    batch: &Batch,
    in_space: &InSpace,
) -> Option<StickTrial> {
    let tangent = batch.tangent(e)?;
    let n = e.slots.n;
    let line = |q: usize| q * n..(q + 1) * n;
    // by how much the traction falls along its own row
    let stiffness = [0, 1, 2].map(|q| {
        let (row, change) = (&tangent.rows[line(q)], &tangent.change[line(q)]);
        match dot(row, row) {
            size if size > 0.0 => e.area * dot(row, change) / size,
            _ => 0.0,
        }
    });
    if !(stiffness[0] > 0.0 && stiffness[0].is_finite()) {
        return None;
    }
    let traction = match e.saddle {
        Some((_, shift)) => [0, 1, 2].map(|q| e.kept.multiplier[q] - shift[q]),
        None => e.response.traction,
    };
    let (mut dofs, mut rows) = (batch.dofs(e).to_vec(), tangent.rows.to_vec());
    in_space.gradients(&mut dofs, &mut rows);
    Some(StickTrial {
        dofs,
        rows,
        area: e.area,
        body: e.area * interface.points[i].stiffness,
        stiffness,
        forces: traction.map(|t| e.area * t),
        rubs: interface.laws.friction_law().frictional(),
        law: limit_alone(interface, e),
    })
}

/// The tangent of the limit of friction at the pressure and the speed of the evaluation, in forces.
fn limit_alone(interface: InterfaceInput, e: &Evaluation) -> PointLaw {
    let r = &e.response;
    if !interface.laws.friction_law().frictional() {
        return PointLaw::default();
    }
    let mu = r.d_limit.max(0.0);
    PointLaw {
        mu,
        adhesion: e.area * (r.limit - mu * r.traction[0].max(0.0)).max(0.0),
        ellipse: r.ellipse,
    }
}

/// Takes the forces of a friction problem for multipliers where these are unknowns; a point without any carries nothing.
pub(super) fn set_multipliers(interface: &mut InterfaceForce, forces: &[Option<[f64; 3]>]) {
    if !interface.view().unknown() {
        return;
    }
    let points = interface.cache.last.points.iter().zip(forces);
    for (m, (e, forces)) in interface.attempt.multipliers.iter_mut().zip(points) {
        let f = forces.unwrap_or_default();
        let traction = f.map(|f| if e.area > 0.0 { f / e.area } else { 0.0 });
        let frame = &e.frames.before;
        m.pressure = traction[0];
        m.shear = add_scaled(scale(traction[1], frame[0]), traction[2], frame[1]);
        m.normal = e.frames.normal_before;
    }
}
