//! Floating bodies are moved until they touch, and stabilised until contact is established.

use super::floating_bodies::Floating;
use super::solver::Solver;
use super::work::Work;
use crate::contact::interface::gaps_at;
use crate::contact::look;
use crate::model::contact::Contact;
use crate::model::definition::Model;
use crate::model::frame::Frame;
use crate::model::rigid::astray::Origin;
use crate::model::rigid::closing::close;
use crate::model::rigid::floating::FloatingBodies;
use crate::model::rigid::free_bodies::FreeBody;
use crate::model::rigid::nearest::rigid_part;
use crate::model::scene::Scene;
use crate::number::figure;
use crate::solve::condensed::{candidates, condensing};
use crate::system::{Stage, State};
use crate::time::Trial;

/// Finds the bodies that supports leave free and interfaces may hold in the step at hand.
pub fn find_floating_bodies(solver: &mut Solver, model: &Model, frame: &Frame, contact: &Contact) {
    if solver.floating.step == Some(frame.step) {
        return;
    }
    let scene = Scene {
        model,
        contact,
        frame,
    };
    solver.floating = Floating {
        step: Some(frame.step),
        bodies: FloatingBodies::find(&scene),
        left: solver.floating.left,
        ..Floating::default()
    };
}

/// Whether floating bodies touch nothing yet and are to be moved until they do. Where all loads have gone nothing would move them.
pub fn has_gaps_to_close(
    solver: &mut Solver,
    model: &Model,
    frame: &Frame,
    contact: &Contact,
    trial: Trial,
) -> bool {
    find_floating_bodies(solver, model, frame, contact);
    let floating = &solver.floating;
    let bodies = floating.bodies();
    if bodies.is_empty() || floating.anchors.is_some() || floating.no_progress || floating.moved > 0
    {
        return false;
    }
    let contacts = solver.contacts(frame);
    let untouched = |free: &FreeBody| {
        // A tie is no contact that holds: it joins unconstrained bodies to each other.
        let mut all = contact.views_of(contacts).filter(|i| !i.laws.tied);
        all.all(|i| !look::touched(i) || !i.nodes.iter().any(|&n| free.has(model, n)))
    };
    let scene = Scene {
        model,
        contact,
        frame,
    };
    bodies.iter().any(untouched) && !floating.bodies.lose_all_loads(&scene, trial.to)
}

/// Moves floating bodies that touch nothing yet until they do, and anchors them.
pub fn close_gaps(
    solver: &mut Solver,
    model: &Model,
    frame: &mut Frame,
    contact: &mut Contact,
    trial: Trial,
) {
    if close_all(solver, model, frame, contact, trial) {
        anchor(solver, model, frame, contact, trial);
    }
}

/// Anchors the bodies that nothing else holds.
pub fn follow(
    solver: &mut Solver,
    model: &Model,
    frame: &mut Frame,
    contact: &mut Contact,
    trial: Trial,
) {
    close_all(solver, model, frame, contact, trial);
    solver.floating.stay = true;
    if !solver.floating.no_progress {
        anchor(solver, model, frame, contact, trial);
    }
}

/// Moves floating bodies until they touch; whether any has moved.
fn close_all(
    solver: &mut Solver,
    model: &Model,
    frame: &mut Frame,
    contact: &mut Contact,
    trial: Trial,
) -> bool {
    set_out(solver, frame, contact, trial, false);
    solver.seen.tell(&Work::Following);
    let external = frame.loads(model, trial.to);
    let bodies = solver.floating.bodies();
    let closure = close(
        model,
        frame,
        contact,
        &solver.conditions,
        bodies,
        &external,
        trial,
    );
    let mut names = Vec::new();
    for (free, &moved) in bodies.iter().zip(&closure.moved) {
        if moved > 0.0 {
            names.push(format!(
                "{} by {moved}",
                free.name(model),
                moved = figure(moved)
            ));
        }
    }
    if let Some(origin) = &mut solver.floating.origin {
        // As far as there is room.
        origin.gaps += closure.moved.iter().copied().fold(0.0, f64::max);
    }
    if !closure.unbalanced.is_empty() {
        solver.floating.no_progress = true;
        return false;
    }
    if names.is_empty() {
        return false;
    }
    solver.log.notes.push(format!(
        "initial rigid-body motion to close the gap: {}",
        names.join(", ")
    ));
    set_displacements(solver, model, frame, contact, closure.u);
    true
}

/// Takes other displacements, which differ by motions without strain, as the last state.
fn set_displacements(
    solver: &mut Solver,
    model: &Model,
    frame: &mut Frame,
    contact: &mut Contact,
    u: Vec<f64>,
) {
    frame.state.u = u;
    model.links.impose(&mut frame.state.u);
    frame.course.forget();
    solver.condenser.reset_predictor();
    candidates::choose_candidates(solver, model, frame, contact);
    solver.condenser.drop_at_rest();
    condensing::condense(solver, model, frame, contact);
}

/// Lays anchors.
pub fn anchor(
    solver: &mut Solver,
    model: &Model,
    frame: &Frame,
    contact: &mut Contact,
    trial: Trial,
) {
    set_out(solver, frame, contact, trial, false);
    let scene = Scene {
        model,
        contact,
        frame,
    };
    let floating = &solver.floating;
    let (anchors, held) = floating.bodies.anchors(&scene, trial.to, floating.firmness);
    solver
        .log
        .notes
        .push(format!("stabilised until contact was established: {held}"));
    solver.floating.anchors = Some(anchors);
    solver.floating.fresh = true;
    candidates::choose_candidates(solver, model, frame, contact);
    condensing::condense(solver, model, frame, contact);
}

/// Takes note of where the increment at hand began, and of the gaps there, if bodies float in it. While increments are `pending` interfaces know
/// more of the last state than displacements do.
pub fn set_out(
    solver: &mut Solver,
    frame: &Frame,
    contact: &mut Contact,
    trial: Trial,
    pending: bool,
) {
    if solver.floating.bodies().is_empty() || solver.floating.origin.is_some() {
        return;
    }
    // Of condensed bodies the points that may touch, and those that are anchored, are known at once.
    let here = match solver.condenser.at_rest() {
        Some(condensed) => condensed.state.clone(),
        None => frame.state.clone(),
    };
    let at = State {
        t: trial.to,
        ..here.clone()
    };
    let stage = Stage {
        from: &here,
        at: &at,
        dt: trial.to - trial.from,
        rate: None,
        frames: None,
    };
    let (mut gaps, mut size) = (0.0, 0.0_f64);
    let mut forces = contact.forces(solver.contacts(frame), &solver.conditions);
    let interfaces = forces.interfaces.iter_mut();
    for interface in interfaces.filter(|i| i.schedule.active(trial.to)) {
        let own = match pending {
            true => look::initial_gaps(interface.view()),
            false => gaps_at(interface, &stage),
        };
        let own = own.into_iter().filter(|gap| gap.is_finite());
        gaps += own.map(f64::abs).fold(0.0, f64::max);
        gaps += interface.obstacle_way(trial.from, trial.to);
        size = size.max(interface.typical().1);
    }
    solver.floating.origin = Some(Origin {
        u: here.u,
        gaps,
        size,
    });
}

/// Lets the increment start where anchored bodies have come as rigid ones.
pub fn restart_from_rigid_motion(
    solver: &mut Solver,
    model: &Model,
    frame: &mut Frame,
    contact: &mut Contact,
    trial: Trial,
) {
    let floating = &mut solver.floating;
    floating.moved += 1;
    let Some(anchors) = floating.anchors.take() else {
        return;
    };
    let mut u = frame.state.u.clone();
    let mut names = Vec::new();
    for (k, free) in floating.bodies().iter().enumerate() {
        let way = rigid_part(free, &anchors.moved(k), model.dofs, &mut u);
        names.push(format!("{} by {way}", free.name(model), way = figure(way)));
    }
    solver.log.notes.push(format!(
        "rigid-body motion to where contact is established: {}",
        names.join(", ")
    ));
    set_displacements(solver, model, frame, contact, u);
    anchor(solver, model, frame, contact, trial);
}

/// Anchors floating bodies whose loads go where they are.
pub fn keep_bodies(
    solver: &mut Solver,
    model: &Model,
    frame: &Frame,
    contact: &mut Contact,
    trial: Trial,
) {
    solver.floating.stay = true;
    anchor(solver, model, frame, contact, trial);
}
