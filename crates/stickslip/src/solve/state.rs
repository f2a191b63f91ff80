//! What a solver takes along from one attempt to the next: enough to make another one that goes on with the same bits.
//!
//! Factors, hierarchies and condensed bodies are large, and made again; but a factor is kept over iterations and increments, and GMRES with an older one comes
//! to other last digits. So what each was made of is here: the dofs that were fixed, the contact that was put in, the loads that were swept.

use super::condensed::condensing;
use super::condenser::{Condensed, Condenser, Moving, Which};
use super::floating_bodies::Floating;
use super::inertia::{Inertia, InertiaRecipe};
use super::solver::{Solver, entries};
use crate::linear::BlockCsr;
use crate::model::contact::Contact;
use crate::model::course::Course;
use crate::model::definition::{Model, Solution};
use crate::model::frame::Frame;
use crate::newton::condensed::{LoadPatterns, PatternsRecipe, ReducedRecipe, ReducedSystem};
use crate::newton::{Factors, FactorsRecipe, Statistics, describe};
use crate::system::{Cause, State, StepFailure};

/// What a solver takes along.
#[derive(Clone, crate::keep::Keep)]
pub(crate) struct SolverState {
    method: Solution,
    multigrid: bool,
    notes: Vec<String>,
    called: &'static str,
    reason: String,
    statistics: Statistics,
    factors: FactorsRecipe,
    inertia: Option<InertiaRecipe>,
    keys: u64,
    floating: Floating,
    kept: Option<Vec<bool>>,
    widened: usize,
    decided: Option<Vec<bool>>,
    largest_forces: f64,
    at_rest: Option<AtRest>,
    moving: Vec<InMotion>,
}

/// Where a quasi-static analysis of condensed bodies stands.
#[derive(Clone, crate::keep::Keep)]
struct AtRest {
    bodies: Bodies,
    patterns: PatternsRecipe,
    state: State,
    carried: Vec<f64>,
    course: Course,
}

/// Bodies that were condensed with the matrix of an increment in motion.
#[derive(Clone, crate::keep::Keep)]
struct InMotion {
    key: u64,
    bodies: Bodies,
}

/// What bodies were condensed for, and the factor of their contact.
#[derive(Clone, crate::keep::Keep)]
struct Bodies {
    held: Vec<bool>,
    kept: Vec<bool>,
    reduced: ReducedRecipe,
}

impl SolverState {
    /// Displacements at the end of the last increment of condensed bodies at rest, known at candidates and where prescribed.
    pub fn condensed_displacements(&self) -> Option<&[f64]> {
        self.at_rest.as_ref().map(|a| a.state.u.as_slice())
    }
}

/// What it takes along.
pub fn state(solver: &Solver) -> SolverState {
    let Condenser {
        library: _,
        kept,
        widened,
        decided,
        at_rest,
        moving,
        broken: _,
        largest_forces,
    } = &solver.condenser;
    SolverState {
        method: solver.method,
        multigrid: solver.factors.are_hierarchies(),
        notes: solver.log.notes.clone(),
        called: solver.log.method,
        reason: solver.log.reason.clone(),
        statistics: solver.newton.statistics,
        factors: solver
            .factors
            .recipe(&|key| matrix_of(solver, key).is_some()),
        inertia: solver.inertia.as_ref().map(Inertia::recipe),
        keys: solver.keys,
        floating: solver.floating.clone(),
        kept: kept.clone(),
        widened: *widened,
        decided: decided.clone(),
        largest_forces: *largest_forces,
        at_rest: at_rest.as_ref().map(|c| AtRest {
            bodies: Bodies {
                held: c.condensation.held.clone(),
                kept: c.kept.clone(),
                reduced: c.reduced.recipe(),
            },
            patterns: c.patterns.recipe(),
            state: c.state.clone(),
            carried: c.carried.clone(),
            course: c.course.clone(),
        }),
        // Those of a matrix that is gone are not asked for again.
        moving: moving
            .iter()
            .filter(|m| matrix_of(solver, m.key).is_some())
            .map(|m| InMotion {
                key: m.key,
                bodies: Bodies {
                    held: m.condensation.held.clone(),
                    kept: m.kept.clone(),
                    reduced: m.reduced.recipe(),
                },
            })
            .collect(),
    }
}

/// Goes on with that, and makes again what it was made of. Of a solver of the same model.
pub fn go_on_from(
    solver: &mut Solver,
    state: SolverState,
    model: &Model,
    frame: &Frame,
    contact: &Contact,
) -> Result<(), StepFailure> {
    let recipe = state.inertia;
    if recipe.is_some() || state.method != Solution::Condensed {
        solver.keep_stiffness(model);
    }
    let again = |r| Inertia::again(model, contact, entries(&solver.stiffness), r);
    solver.inertia = recipe.map(again);
    // As it was when bodies were condensed: there is nothing to be decided.
    solver.method = Solution::Condensed;
    solver.condenser.at_rest = match state.at_rest {
        Some(at_rest) => Some(condense_again(solver, at_rest, model, frame, contact)?),
        None => None,
    };
    solver.condenser.moving.clear();
    for InMotion { key, bodies } in state.moving {
        let one = move_again(solver, key, bodies, model, frame, contact)?;
        solver.condenser.moving.push(one);
    }
    let none = BlockCsr::empty(model.dofs.dim);
    let hierarchies = state.multigrid.then(|| model.places());
    let matrix = |key| matrix_of(solver, key);
    let like = solver.stiffness.kept().unwrap_or(&none);
    let factors = Factors::again(state.factors, &matrix, like, hierarchies)?;
    solver.factors = factors;
    solver.method = state.method;
    solver.log.notes = state.notes;
    solver.log.method = state.called;
    solver.log.reason = state.reason;
    solver.newton.statistics = state.statistics;
    solver.keys = state.keys;
    solver.floating = state.floating;
    solver.condenser.kept = state.kept;
    solver.condenser.widened = state.widened;
    solver.condenser.decided = state.decided;
    solver.condenser.largest_forces = state.largest_forces;
    Ok(())
}

/// The stiffness, or the matrix of an increment in motion as long as it is kept.
fn matrix_of(solver: &Solver, key: u64) -> Option<&BlockCsr> {
    match key {
        0 => solver.stiffness.kept().ok(),
        key => solver.inertia.as_ref()?.matrix_of(key),
    }
}

fn condense_again(
    solver: &mut Solver,
    at_rest: AtRest,
    model: &Model,
    frame: &Frame,
    contact: &Contact,
) -> Result<Condensed, StepFailure> {
    let Bodies {
        held,
        kept,
        reduced,
    } = at_rest.bodies;
    solver.condenser.decided = Some(held.clone());
    solver.condenser.kept = Some(kept.clone());
    let condensation =
        condensing::condense_bodies(solver, model, frame, contact, &held, Which::Stiffness)
            .ok_or_else(|| not_again(solver))?;
    let patterns = LoadPatterns::again(at_rest.patterns, &condensation, &*solver.stiffness)
        .map_err(describe)?;
    Ok(Condensed {
        reduced: ReducedSystem::again(reduced, &condensation)?,
        patterns,
        condensation,
        kept,
        state: at_rest.state,
        carried: at_rest.carried,
        course: at_rest.course,
        ahead: None,
        found: None,
    })
}

fn move_again(
    solver: &mut Solver,
    key: u64,
    bodies: Bodies,
    model: &Model,
    frame: &Frame,
    contact: &Contact,
) -> Result<Moving, StepFailure> {
    let Bodies {
        held,
        kept,
        reduced,
    } = bodies;
    solver.condenser.decided = Some(held.clone());
    solver.condenser.kept = Some(kept.clone());
    let condensation =
        condensing::condense_bodies(solver, model, frame, contact, &held, Which::Of(key))
            .ok_or_else(|| not_again(solver))?;
    Ok(Moving {
        key,
        kept,
        reduced: ReducedSystem::again(reduced, &condensation)?,
        condensation,
    })
}

/// Bodies that were condensed cannot be condensed again.
fn not_again(solver: &Solver) -> StepFailure {
    if let Some(broken) = solver.condenser.broken() {
        return broken.clone();
    }
    let why = solver.log.notes.last().cloned().unwrap_or_default();
    StepFailure::new(
        Cause::Memory,
        format!("the bodies that were condensed cannot be condensed again: {why}"),
    )
    .help("resume where as much memory is free as when the run began")
}
