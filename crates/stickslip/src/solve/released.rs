//! Floating bodies whose loads have gone: nothing presses them any more, and they stay where they were.

use super::accepted::Accepted;
use super::solver::Solver;
use crate::model::definition::Model;
use crate::model::frame::Frame;
use crate::model::scene::Scene;
use crate::number::digits;
use crate::time::Trial;
use crate::tolerance::NEGLIGIBLE;

/// Whether the loads of floating bodies go in this increment, and nothing is there yet to keep them where they are. Without loads every place without
/// contact is one of equilibrium: Newton's method would end in one by chance.
pub fn is_to_keep_bodies(solver: &Solver, scene: Scene, trial: Trial) -> bool {
    let floating = &solver.floating;
    floating.anchors.is_none()
        && !floating.no_progress
        && !floating.bodies().is_empty()
        && floating.bodies.lose_load(&scene, trial.to)
}

/// Notes which floating bodies nothing presses any more after an increment that was found.
pub fn note_released(solver: &mut Solver, model: &Model, frame: &Frame, accepted: &Accepted) {
    let floating = &mut solver.floating;
    let before = floating.bodies.largest_forces(model, &frame.contact);
    let after = floating.bodies.largest_forces(model, &accepted.contact);
    let known = before.iter().chain(&floating.bodies.pushed);
    // Anchors give up when they carry less.
    let none = NEGLIGIBLE * known.copied().fold(0.0, f64::max);
    let mut released = Vec::new();
    for (k, free) in floating.bodies().iter().enumerate() {
        let pressed = floating.bodies.pushed[k] > none || before[k] > none;
        let told = floating.told.contains(&free.bodies[0]);
        if pressed && !told && after[k] <= none {
            released.push((free.bodies[0], free.name(model)));
        }
    }
    for (body, name) in released {
        floating.told.push(body);
        solver.log.notes.push(format!(
            "{}: body {name} lost all contact at {}; it stays where it was",
            model.steps[frame.step].name,
            digits(accepted.state.t, 6)
        ));
    }
}
