//! What acts in the first instant of a motion.

use std::sync::Arc;

use super::conditions::Conditions;
use super::energies::initial_energy;
use super::history::History;
use super::initial::TOUCHING;
use super::parts::{Interface, InterfaceForce};
use super::pass::evaluate_all;
use super::scene::Wants;
use crate::contact::response::Status;
use crate::math::Vec3;
use crate::system::{Force, Stage, StepFailure};

/// Tractions at the end of an attempt, by point.
#[derive(Debug, Clone, Default)]
pub struct Tried(Vec<(Status, f64, Vec3)>);

/// Adds the forces that the laws ask for at `stage.at` to the residual, before anything is solved and without touching the
/// history: for the acceleration at the start. What overlap stores then `[J]`.
///
/// Multipliers against penetration have no force before something is solved, and nothing is stored in them: overlap is pressed out in the first
/// increment, whose energy is told apart by the gaps that are noted here.
pub fn add_initial_forces(
    interface: &mut Interface,
    state: &mut History,
    conditions: &Conditions,
    stage: &Stage,
    residual: &mut [f64],
) -> Result<f64, StepFailure> {
    if !interface.schedule.active(stage.at.t) {
        return Ok(0.0);
    }
    evaluate_initial(&mut interface.force(state, conditions), stage);
    let evaluations = &interface.cache.trial;
    if interface.view(state).unknown() && interface.laws.needs_normal_stiffness() {
        let points = evaluations.points.iter();
        let overlap = points.map(|e| if e.over { e.gap.min(0.0) } else { 0.0 });
        Arc::make_mut(&mut state.start).overlap = match state.acting {
            true => Vec::new(),
            false => overlap.collect(),
        };
        return Ok(0.0);
    }
    for (i, e) in evaluations.points.iter().enumerate() {
        let batch = evaluations.batch(i);
        let force = batch.force(e).unwrap_or_default();
        for (&dof, r) in batch.dofs(e).iter().zip(force) {
            residual[dof] += r;
        }
    }
    let stored = initial_energy(interface.view(state), &evaluations.points);
    if state.springs {
        // How stiff and viscous what touches is bounds explicit increments from the first on.
        interface.cache.take_trial();
    }
    Ok(stored)
}

/// Takes what laws say at `stage.at` for the last evaluation: how stiff and viscous they are there bounds explicit increments.
pub fn evaluate_laws(interface: &mut InterfaceForce, stage: &Stage) {
    interface.cache.last.points.clear();
    if interface.schedule.active(stage.at.t) {
        evaluate_initial(interface, stage);
        interface.cache.take_trial();
    }
}

/// What laws say before anything is solved.
fn evaluate_initial(interface: &mut InterfaceForce, stage: &Stage) {
    interface.prepare(stage);
    interface.begin();
    let wants = Wants {
        initial: true,
        ..Wants::default()
    };
    let (input, cache) = interface.parts();
    evaluate_all(input, cache, stage, wants);
}

/// Whether points without mass overlap what they meet at `stage.at`, before the interface has ever acted.
pub fn presses_light_points(interface: &mut InterfaceForce, stage: &Stage) -> bool {
    if !interface.schedule.active(stage.at.t) || interface.state.acting || interface.laws.tied {
        return false;
    }
    evaluate_initial(interface, stage);
    let masses = interface.conditions.inertia.iter().zip(&interface.points);
    let mut points = interface.cache.trial.points.iter().zip(masses);
    let presses =
        points.any(|(e, (mass, point))| *mass == 0.0 && e.over && e.gap < -TOUCHING * point.size);
    // It is not reported.
    interface.cache.trial.points.clear();
    presses
}

/// Takes the tractions of an attempt as those from which points without mass go on: what presses them has pressed them before the motion begins.
pub fn adopt_light_tractions(state: &mut History, conditions: &Conditions, tried: &Tried) {
    let masses = conditions.inertia.iter();
    let all = state.points.iter_mut().zip(&tried.0).zip(masses);
    for ((history, &(status, pressure, shear)), _) in all.filter(|(_, m)| **m == 0.0) {
        history.status = status;
        history.pressure = pressure;
        history.shear = shear;
    }
}

/// The tractions of the present attempt.
pub fn tried_tractions(interface: &Interface) -> Tried {
    let points = interface.cache.last.points.iter();
    let traction = points.map(|e| {
        let r = &e.response;
        (r.status, r.traction[0], e.along(&e.frames.now))
    });
    Tried(traction.collect())
}

/// Takes the tractions of an attempt as those of the last accepted state: what acts from the first instant of a motion. Where a point sticks, what the
/// others carry is only being built up, and all is left as it is.
pub fn adopt_tractions(state: &mut History, tried: &Tried) {
    if tried.0.iter().any(|(status, ..)| *status == Status::Stick) {
        return;
    }
    let all = state.points.iter_mut().zip(&tried.0);
    for (history, &(_, pressure, shear)) in all.filter(|(_, t)| t.0 == Status::Slip) {
        history.pressure = pressure;
        history.shear = shear;
    }
}
