//! Points that may come into contact: what bodies are condensed to.

use crate::contact::interface::{CandidateRange, include_all, restrict_to_candidates};
use crate::model::contact::Contact;
use crate::model::definition::Model;
use crate::model::frame::Frame;
use crate::solve::solver::Solver;

/// Points of interfaces below which all of them are candidates.
const FEW_POINTS: usize = 60;

/// How often candidates are added before all points are.
const MOST_WIDENED: usize = 4;

/// Times within a step at which supports are looked at.
const SUPPORT_TIMES: usize = 16;

/// Points that may come into contact in this step, as far as can be told; never fewer than before. Those that may not are
/// not looked at.
pub fn choose_candidates(solver: &mut Solver, model: &Model, frame: &Frame, contact: &Contact) {
    if !solver.method.condenses() {
        solver.log.method = solver.method.key();
    }
    let points = model.dofs.points;
    let known = solver.condenser.kept.take();
    let mut kept = known.unwrap_or_else(|| vec![false; points]);
    let mut all = vec![false; points];
    for &node in contact.interfaces.iter().flat_map(|i| &i.nodes) {
        all[node] = true;
    }
    let count = all.iter().filter(|a| **a).count();
    let widened = solver.condenser.widened;
    if count < FEW_POINTS || widened >= MOST_WIDENED || !solver.method.condenses() {
        for (interface, conditions) in contact.interfaces.iter().zip(&mut solver.conditions) {
            conditions.candidates = include_all(interface, &mut kept);
        }
    } else {
        let step = &model.steps[frame.step];
        let travel = travel(model, frame) * f64::powi(2.0, widened as i32);
        let range = CandidateRange {
            distance: travel + extra(widened, model),
            along: travel,
            span: [step.start, step.end],
        };
        let turns = |node: &usize| model.corotations.of_point(*node).is_some();
        let u = &frame.state.u;
        for (interface, conditions) in contact.views(frame).zip(&mut solver.conditions) {
            conditions.candidates = match interface.nodes.iter().any(turns) {
                // In turn all of its points come round.
                true => include_all(interface.definition, &mut kept),
                false => restrict_to_candidates(interface, u, range, &mut kept),
            };
        }
    }
    for point in solver.floating.points() {
        kept[point] = true;
    }
    for point in contact.couplings.points() {
        kept[point] = true;
    }
    for point in model.links.followed() {
        kept[point] = true;
    }
    for link in model.links.all() {
        kept[link.points.clone()].fill(false);
        kept[link.hidden..link.hidden + 2].fill(true);
    }
    solver.condenser.kept = Some(kept);
}

/// Lets all points take part.
pub fn keep_all_points(solver: &mut Solver, model: &Model, contact: &Contact) {
    let mut kept = vec![false; model.dofs.points];
    for (interface, conditions) in contact.interfaces.iter().zip(&mut solver.conditions) {
        conditions.candidates = include_all(interface, &mut kept);
    }
    solver.condenser.kept = None;
    solver.log.method = "explicit";
    if model.solution.engine.as_dyn().condenses() {
        let idle = "explicit steps factor nothing: the engine has nothing to do in them";
        solver.log.notes.push(idle.into());
    }
}

/// Distance beyond that of prescribed motion in which contact is looked for: more each time that it was too little.
fn extra(widened: usize, model: &Model) -> f64 {
    match widened {
        0 => 0.0,
        n => 0.01 * f64::powi(4.0, n as i32 - 1) * model.size,
    }
}

/// How far supports and initial velocities move anything in the step, at most.
fn travel(model: &Model, frame: &Frame) -> f64 {
    let step = &model.steps[frame.step];
    let mut times: Vec<f64> = (0..=SUPPORT_TIMES)
        .map(|k| step.start + (step.end - step.start) * k as f64 / SUPPORT_TIMES as f64)
        .collect();
    times.extend(&step.milestones);
    let u = &frame.state.u;
    let mut largest = vec![0.0_f64; u.len()];
    for t in times {
        let constraints = frame.constraints(model, t);
        for (i, largest) in largest.iter_mut().enumerate() {
            if constraints.fixed[i] {
                *largest = largest.max((constraints.values[i] - u[i]).abs());
            }
        }
    }
    for rigid in model.links.all() {
        // the points of rigid bodies have no values of their own
        let own = model.dofs.of(rigid.points.start, 0)..model.dofs.of(rigid.points.end, 0);
        largest[own].fill(0.0);
    }
    let dim = model.dofs.dim;
    let most = |values: &[f64]| {
        let sizes = values
            .chunks(dim)
            .map(|p| p.iter().map(|v| v * v).sum::<f64>().sqrt());
        sizes.fold(0.0, f64::max)
    };
    let (moved, speed) = (most(&largest), most(&frame.state.v));
    2.0 * moved + 2.0 * speed * (step.end - step.start)
}
