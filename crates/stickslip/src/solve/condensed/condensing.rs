//! Static condensation of the bodies of a model, where it is the cheapest way to solve.

use std::sync::Arc;
use std::time::Instant;

use crate::linear::{LinearError, Matrix};
use crate::machine;
use crate::math::Vec3;
use crate::model::contact::Contact;
use crate::model::course::Course;
use crate::model::definition::{Model, Solution};
use crate::model::frame::Frame;
use crate::model::scene::Scene;
use crate::newton::condensed::{
    ArtificialSprings, Condensation, Cost, Effort, LoadPatterns, Plan, ReducedSystem,
};
use crate::newton::{Factors, describe};
use crate::number::digits;
use crate::solve::choice;
use crate::solve::choice::cost_fits;
use crate::solve::condensed::candidates;
use crate::solve::condenser::{Condensed, Condenser, Which};
use crate::solve::inertia::in_motion;
use crate::solve::solver::Solver;
use crate::solve::work::Work;

/// Makes the bodies ready for a quasi-static step.
pub fn condense(solver: &mut Solver, model: &Model, frame: &Frame, contact: &Contact) {
    // What turns freely would change the load patterns of all interiors in every pass; what turns cell by cell is not linear.
    let turns = model.turns_freely() || model.is_corotational();
    if !solver.method.condenses() || turns {
        return;
    }
    let step = &model.steps[frame.step];
    let held = frame
        .constraints(model, 0.5 * (step.start + step.end))
        .fixed;
    let kept = solver.condenser.kept.clone().unwrap_or_default();
    if let Some(condensed) = &mut solver.condenser.at_rest
        && condensed.condensation.held == held
        && condensed.kept == kept
    {
        condensed.course.forget();
        return;
    }
    let made = condense_bodies(solver, model, frame, contact, &held, Which::Stiffness);
    let Some(condensation) = made else {
        solver.condenser.at_rest = None;
        return;
    };
    // Forces that go with the displacements the step starts from.
    let mut at = vec![0.0; held.len()];
    let u = condensation.gather(&frame.state.u);
    condensation.scatter(&u, &mut at);
    let mut carried = vec![0.0; u.len()];
    if u.iter().any(|u| *u != 0.0) {
        let swept = condensation.sweep(&solver.stiffness.times(&at));
        carried = match swept {
            Ok(swept) => swept.0,
            Err(e) => return breaks(solver, e),
        };
        let mut springs = vec![0.0; u.len()];
        condensation.release(&u, &mut springs);
        carried.iter_mut().zip(&springs).for_each(|(c, s)| *c -= s);
    }
    solver.condenser.at_rest = Some(Condensed {
        condensation,
        kept,
        reduced: ReducedSystem::default(),
        patterns: LoadPatterns::default(),
        state: frame.state.clone(),
        carried,
        course: Course::default(),
        ahead: None,
        found: None,
    });
}

/// Factors the bodies with one of their matrices, as far as the library does not have them; `None` where the analysis goes on with the sparse matrix.
pub(in crate::solve) fn condense_bodies(
    solver: &mut Solver,
    model: &Model,
    frame: &Frame,
    contact: &Contact,
    held: &[bool],
    which: Which,
) -> Option<Condensation> {
    let typical = solver.diagonal.iter().fold(0.0_f64, |m, d| m.max(*d));
    let typical = if typical > 0.0 { typical } else { 1.0 };
    let points = &model.mesh.points;
    let places = |p: usize| -> Option<Vec3> { points.get(p).copied() };
    let springs = ArtificialSprings {
        places: &places,
        typical,
    };
    let library = Arc::clone(&solver.condenser.library);
    let kept = solver.condenser.kept.clone().unwrap_or_default();
    let parts = parts(model);
    let engine = match library.engine(&model.solution.engine) {
        Ok(engine) => engine,
        Err(e) => return not_factored(solver, model, frame, contact, e),
    };
    let matrix = matrix_of_bodies(solver, which);
    let plan = Plan::new(matrix, &parts, held, &kept, springs, &library, &engine);
    let plan = match plan {
        Ok(plan) => plan,
        Err(e) => return not_factored(solver, model, frame, contact, e),
    };
    if solver.condenser.decided.as_deref() != Some(held) {
        let scene = Scene {
            model,
            contact,
            frame,
        };
        if !decide(solver, scene, &plan, held, which) {
            candidates::choose_candidates(solver, model, frame, contact);
            return None;
        }
    }
    let cost = plan.cost();
    if !cost_fits(cost.bytes) {
        return too_large(solver, model, frame, contact, &cost);
    }
    let started = Instant::now();
    solver.seen.tell(&Work::Condensing);
    let matrix = matrix_of_bodies(solver, which);
    // Once asked to stop, it does not wait for others.
    let waits = || {
        solver.seen.tell(&Work::Waiting);
        !solver.newton.interrupted()
    };
    match Condensation::new(plan, matrix, held, springs, &library, &waits) {
        Ok((condensation, effort)) => {
            let passed = started.elapsed().as_secs_f64();
            note_effort(solver, &cost, effort, passed);
            solver.log.engine = Some(engine);
            solver.log.method = "condensed";
            Some(condensation)
        }
        Err(e) => not_factored(solver, model, frame, contact, e),
    }
}

fn matrix_of_bodies(solver: &Solver, which: Which) -> &dyn Matrix {
    match which {
        Which::Stiffness => &*solver.stiffness,
        Which::Increment => in_motion(&solver.inertia).matrix().0,
        Which::Of(key) => {
            let kept = in_motion(&solver.inertia).matrix_of(key);
            kept.expect("bodies in motion go with their matrix")
        }
    }
}

/// Chooses the cheapest way to solve, and says why; whether it is to condense.
fn decide(solver: &mut Solver, scene: Scene, plan: &Plan, held: &[bool], which: Which) -> bool {
    let cost = plan.cost();
    if scene.model.solution.engine.as_dyn().condenses() {
        solver.log.reason = format!(
            "as the engine does; {} of {} dofs are contact candidates",
            cost.candidates,
            held.iter().filter(|h| !**h).count()
        );
        solver
            .log
            .notes
            .push(format!("condensed: {}", solver.log.reason));
        solver.condenser.decided = Some(held.to_vec());
        return true;
    }
    let matrix = matrix_of_bodies(solver, which).kept();
    let matrix = matrix.expect("only engines that are chosen do without entries");
    let choice = choice::choose(&scene, &cost, matrix, held);
    let forced = solver.method == Solution::Condensed;
    let fits = cost_fits(cost.bytes);
    let method = if forced && fits {
        Solution::Condensed
    } else {
        choice.method
    };
    if forced && !fits {
        solver.log.notes.push(format!(
            "`solver.method = \"condensed\"` needs about {:.1} GB, more than is free",
            cost.bytes as f64 / 1e9
        ));
    }
    let name = match method {
        Solution::Condensed => "condensed",
        Solution::Multigrid => "multigrid",
        _ => "sparse matrix",
    };
    solver.log.notes.push(format!("{name}: {}", choice.reason));
    solver.log.reason = choice.reason;
    if method == Solution::Condensed {
        solver.condenser.decided = Some(held.to_vec());
        return true;
    }
    solver.method = method;
    if method == Solution::Multigrid {
        solver.factors = Factors::multigrid(scene.model.places());
    }
    false
}

/// Counts what condensing took, `passed` seconds in all.
fn note_effort(solver: &mut Solver, cost: &Cost, effort: Effort, passed: f64) {
    let statistics = &mut solver.newton.statistics;
    // Some engines know only afterwards.
    let known = cost.nonzeros.max(effort.factor.nonzeros);
    statistics.factors.nonzeros = known as usize;
    statistics.factors.bytes = cost.bytes;
    if effort.made > 0 {
        // Some engines know only afterwards.
        statistics.factors.flops += cost.left.max(effort.factor.flops);
    }
    statistics.analyses += effort.analysed;
    statistics.factorisations += effort.made;
    statistics.substructures.made += effort.made;
    statistics.substructures.shared += effort.shared;
    statistics.substructures.read += effort.read;
    statistics.seconds.find += effort.seconds_find + effort.seconds_wait;
    statistics.seconds.order += effort.seconds_order;
    // Bodies are factored side by side: their times are shares of the time that has passed.
    let passed = (passed - effort.seconds_wait).max(0.0);
    let spent = effort.seconds.factor + effort.seconds.condense;
    let share = if spent > 0.0 { passed / spent } else { 0.0 };
    let factor = share * effort.seconds.factor;
    let condense = share * effort.seconds.condense;
    statistics.seconds.factor += factor;
    statistics.seconds.condense += condense;
    if statistics.linear_solve == 0.0 && effort.made > 0 {
        // To factor the root costs a third of its inverse.
        statistics.linear_solve = effort.seconds_order + factor + condense / 3.0;
    }
    solver.log.notes.extend(effort.notes);
}

/// Whether bodies are condensed, at rest or in motion.
pub fn condenses(solver: &Solver) -> bool {
    solver.condenser.at_rest.is_some() || !solver.condenser.moving.is_empty()
}

/// Gives condensed bodies up: the analysis goes on with the sparse matrix.
pub fn give_condensing_up(
    solver: &mut Solver,
    model: &Model,
    frame: &Frame,
    contact: &Contact,
    why: &str,
) {
    solver.condenser.moving.clear();
    solver.condenser.decided = None;
    solver.log.reason = format!("condensed bodies did not serve: {why}");
    not_condensed(
        solver,
        model,
        frame,
        contact,
        &format!(
            "{why}; the analysis goes on from {} with the sparse matrix",
            digits(frame.state.t, 6)
        ),
    );
}

/// Bodies cannot be factored: if the engine is to blame nothing is solved any more, otherwise the analysis goes on with the sparse matrix.
fn not_factored(
    solver: &mut Solver,
    model: &Model,
    frame: &Frame,
    contact: &Contact,
    error: LinearError,
) -> Option<Condensation> {
    match error {
        LinearError::Engine { .. } => {
            breaks(solver, error);
            None
        }
        other => not_condensed(solver, model, frame, contact, &other.to_string()),
    }
}

/// What is dense does not fit. Who asked for an engine did not ask for the sparse matrix, which would take more.
fn too_large(
    solver: &mut Solver,
    model: &Model,
    frame: &Frame,
    contact: &Contact,
    cost: &Cost,
) -> Option<Condensation> {
    if !model.solution.engine.as_dyn().condenses() {
        let why = "it would take more memory than is free";
        return not_condensed(solver, model, frame, contact, why);
    }
    breaks(
        solver,
        LinearError::Engine {
            message: format!(
                "the matrices of {} contact candidates take {} in this process, more than is free",
                cost.candidates,
                machine::bytes(cost.bytes)
            ),
            help: "smaller contact surfaces, or a machine with more memory for the first process"
                .into(),
        },
    );
    None
}

/// The engine cannot go on.
fn breaks(solver: &mut Solver, error: LinearError) {
    solver.condenser.at_rest = None;
    solver.condenser.broken = Some(describe(error));
}

/// The analysis goes on with the sparse matrix.
fn not_condensed(
    solver: &mut Solver,
    model: &Model,
    frame: &Frame,
    contact: &Contact,
    why: &str,
) -> Option<Condensation> {
    solver.condenser.at_rest = None;
    let by = match model.solution.engine.as_dyn().condenses() {
        true => " (the sparse matrix is factored by the built-in engine, in this process)",
        false => "",
    };
    solver.log.notes.push(format!("not condensed: {why}{by}"));
    solver.method = Solution::Sparse;
    candidates::choose_candidates(solver, model, frame, contact);
    None
}

/// Contact has come to points that do not take part: lets more of them.
pub fn widen(solver: &mut Solver, model: &Model, frame: &Frame, contact: &Contact) {
    solver.condenser.widened += 1;
    let count = |c: &Condenser| c.kept.iter().flatten().filter(|k| **k).count();
    let before = count(&solver.condenser);
    candidates::choose_candidates(solver, model, frame, contact);
    let after = count(&solver.condenser);
    solver.log.notes.push(format!(
        "contact comes near to points that were not expected to be touched: {after} candidates instead of {before}, factored anew"
    ));
    solver.condenser.at_rest = None;
    solver.condenser.moving.clear();
    if model.steps[frame.step].dynamic.is_none() {
        condense(solver, model, frame, contact);
    }
}

/// Points of the parts of the model that are not coupled but by contact.
fn parts(model: &Model) -> Vec<std::ops::Range<usize>> {
    let bodies = model.elastic().map(|b| b.points.clone());
    let links = model.links.all().iter();
    bodies
        .chain(links.map(|l| l.hidden..l.hidden + 2))
        .collect()
}
