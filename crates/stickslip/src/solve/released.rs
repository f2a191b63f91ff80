//! Floating bodies whose loads have gone: nothing presses them any more, and they stay where they were.

use super::accepted::Accepted;
use super::floating_bodies::{Floating, no_load};
use super::solver::Solver;
use crate::math::norm;
use crate::model::definition::Model;
use crate::model::frame::Frame;
use crate::model::rigid::free_bodies::FreeBody;
use crate::model::scene::Scene;
use crate::number::digits;
use crate::time::Trial;
use crate::tolerance::NEGLIGIBLE;

/// The load on a floating body along its free motions: the largest, each of which has a largest displacement of one.
fn along(free: &FreeBody, external: &[f64]) -> f64 {
    let of = |motion: &[f64]| -> f64 { motion.iter().zip(external).map(|(m, f)| m * f).sum() };
    let motions = free.motions.iter();
    motions.fold(0.0, |most, (_, m)| f64::max(most, of(m).abs()))
}

/// The largest loads along free motions, body by body, at the ends of the steps so far and now.
pub(super) fn find_pushes(floating: &mut Floating, scene: Scene) {
    let Scene { model, frame, .. } = scene;
    let steps = &model.steps[..=frame.step];
    let ends = steps.iter().flat_map(|s| [s.start, s.end]);
    let mut pushed = vec![0.0; floating.bodies().len()];
    if !pushed.is_empty() {
        for t in ends.chain([frame.state.t]) {
            let external = frame.loads(model, t);
            for (most, free) in pushed.iter_mut().zip(floating.bodies()) {
                *most = f64::max(*most, along(free, &external));
            }
        }
    }
    floating.pushed = pushed;
}

/// The largest force at a point of each floating body.
pub(super) fn pressed(floating: &Floating, model: &Model, forces: &[f64]) -> Vec<f64> {
    let largest = |free: &FreeBody| {
        let points = free.points(model);
        points.fold(0.0, |m, p| f64::max(m, norm(model.dofs.vector(forces, p))))
    };
    floating.bodies().iter().map(largest).collect()
}

/// Whether the load of a floating body that had one is gone at the end of an increment.
fn lose_load(floating: &Floating, model: &Model, frame: &Frame, trial: Trial) -> bool {
    let none = no_load(model);
    let mut loads = loads(floating, model, frame, trial);
    loads.any(|(most, now)| most > 0.0 && now <= none * most)
}

/// Whether loads of floating bodies were there and all are gone at the end of an increment.
pub(super) fn lose_all_loads(
    floating: &Floating,
    model: &Model,
    frame: &Frame,
    trial: Trial,
) -> bool {
    let largest = floating.pushed.iter().copied().fold(0.0, f64::max);
    let none = no_load(model) * largest;
    largest > 0.0 && loads(floating, model, frame, trial).all(|(_, now)| now <= none)
}

/// The largest load of each floating body so far, and that at the end of an increment.
fn loads(
    floating: &Floating,
    model: &Model,
    frame: &Frame,
    trial: Trial,
) -> impl Iterator<Item = (f64, f64)> {
    let external = match floating.pushed.iter().any(|most| *most > 0.0) {
        true => frame.loads(model, trial.to),
        false => Vec::new(),
    };
    let both = floating.bodies().iter().zip(&floating.pushed);
    both.map(move |(free, &most)| (most, along(free, &external)))
}

/// Whether the loads of floating bodies go in this increment, and nothing is there yet to keep them where they are. Without loads every place without
/// contact is one of equilibrium: Newton's method would end in one by chance.
pub fn is_to_keep_bodies(solver: &Solver, model: &Model, frame: &Frame, trial: Trial) -> bool {
    let floating = &solver.floating;
    floating.anchors.is_none()
        && !floating.no_progress
        && !floating.bodies().is_empty()
        && lose_load(floating, model, frame, trial)
}

/// Notes which floating bodies nothing presses any more after an increment that was found.
pub fn note_released(solver: &mut Solver, model: &Model, frame: &Frame, accepted: &Accepted) {
    let floating = &mut solver.floating;
    let before = pressed(floating, model, &frame.contact);
    let after = pressed(floating, model, &accepted.contact);
    let known = before.iter().chain(&floating.pushed);
    // Anchors give up when they carry less.
    let none = NEGLIGIBLE * known.copied().fold(0.0, f64::max);
    let mut released = Vec::new();
    for (k, free) in floating.bodies().iter().enumerate() {
        let pressed = floating.pushed[k] > none || before[k] > none;
        let told = floating.told.contains(&free.bodies[0]);
        if pressed && !told && after[k] <= none {
            released.push((free.bodies[0], free.name(model)));
        }
    }
    for (body, name) in released {
        floating.told.push(body);
        solver.log.notes.push(format!(
            "{}: nothing presses body {name} any more at {}; it stays where it was",
            model.steps[frame.step].name,
            digits(accepted.state.t, 6)
        ));
    }
}
