//! Floating bodies are moved until they touch, and stabilised until contact is established.

use super::closure::{close, pushes};
use super::floating_bodies::{Floating, Origin, no_load};
use super::rigid_part::rigid_part;
use super::solver::Solver;
use super::work::Work;
use crate::body::{Anchors, Hold, spread};
use crate::contact::interface::{Interface, gaps_at};
use crate::contact::look;
use crate::math::{dot, norm};
use crate::model::contact::Contact;
use crate::model::definition::Model;
use crate::model::frame::Frame;
use crate::model::rigid::free_bodies;
use crate::model::rigid::free_bodies::FreeBody;
use crate::model::scene::Scene;
use crate::number::figure;
use crate::solve::condensed::{candidates, condensing};
use crate::solve::released;
use crate::system::{Stage, State};
use crate::time::Trial;
use crate::tolerance::NEGLIGIBLE;

/// Finds the bodies that supports leave free and interfaces may hold in the step at hand.
pub fn find_floating_bodies(solver: &mut Solver, model: &Model, frame: &Frame, contact: &Contact) {
    if matches!(solver.floating.known, Some((step, _)) if step == frame.step) {
        return;
    }
    let step = &model.steps[frame.step];
    let middle = 0.5 * (step.start + step.end);
    let scene = Scene {
        model,
        contact,
        frame,
    };
    let mut bodies = Vec::new();
    if model.solution.follow && !contact.interfaces.is_empty() {
        bodies = free_bodies::free_bodies(&scene, middle);
    }
    let active = |i: &&Interface| i.schedule.active(middle);
    let interfaces: Vec<&Interface> = contact.interfaces.iter().filter(active).collect();
    let dofs = model.dofs;
    let mut resisted = false;
    bodies.retain(|free| {
        let mut met = false;
        for interface in &interfaces {
            for (point, normal) in look::normals(interface) {
                if free.has(model, point) {
                    met = true;
                    resisted |= free.motions.iter().any(|(_, motion)| {
                        dot(dofs.vector(motion, point), normal).abs() > NEGLIGIBLE
                    });
                }
            }
        }
        met
    });
    if !resisted {
        bodies.clear();
    }
    let place = |free: &FreeBody| {
        let each = free.bodies.iter();
        let each = each.map(|&b| model.bodies[b].points.clone());
        each.flat_map(|points| spread(&model.mesh, points, dofs.dim + 1))
            .collect()
    };
    solver.floating = Floating {
        places: bodies.iter().map(place).collect(),
        known: Some((frame.step, bodies)),
        left: solver.floating.left,
        ..Floating::default()
    };
    released::find_pushes(
        &mut solver.floating,
        Scene {
            model,
            contact,
            frame,
        },
    );
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
    bodies.iter().any(untouched) && !released::lose_all_loads(floating, model, frame, trial)
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
    let external = frame.loads(model, trial.to);
    let pushes = pushes(model, &external).into_iter();
    // What draws the parts of a bolt together is no load on the whole of it.
    let tension = contact.coupled(frame).tension(trial.to);
    let mut force = pushes.map(|p| norm(p.force)).fold(tension, f64::max);
    let before = released::pressed(&solver.floating, model, &frame.contact).into_iter();
    let largest = before.chain(solver.floating.pushed.iter().copied());
    let largest = largest.fold(0.0, f64::max);
    if force <= no_load(model) * largest {
        // What is left of forces that are gone is small beside them.
        force = largest;
    }
    let mut anchors = Anchors::new(model.dofs);
    let mut names = Vec::new();
    let floating = &solver.floating;
    for (free, points) in floating.bodies().iter().zip(&floating.places) {
        let (mut spring, mut size) = (0.0_f64, f64::INFINITY);
        for interface in &contact.interfaces {
            if interface.nodes.iter().any(|&n| free.has(model, n)) {
                let (k, h) = interface.typical();
                spring = spring.max(k);
                size = size.min(h);
            }
        }
        let hold = Hold {
            spring,
            force,
            // A body may move a quarter of a cell in a round.
            max_step: 0.25 * size,
            size,
            firmness: floating.firmness,
        };
        anchors.hold(points.clone(), &frame.state.u, hold);
        let motions: Vec<&str> = free.motions.iter().map(|(name, _)| name.as_str()).collect();
        names.push(format!("{} ({})", free.name(model), motions.join(", ")));
    }
    solver.log.notes.push(format!(
        "stabilised until contact was established: {}",
        names.join("; ")
    ));
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
