//! Quasi-static increments on the contact candidates.

use std::time::Instant;

use crate::contact::look;
use crate::linear::{LinearError, Matrix};
use crate::math::vector::dot;
use crate::model::conditions;
use crate::model::contact::Contact;
use crate::model::definition::Model;
use crate::model::frame::{ContactMemory, Frame};
use crate::model::ledger::Flow;
use crate::newton::condensed::{Amplitudes, CondensedBulk};
use crate::newton::describe;
use crate::solve::accepted::Accepted;
use crate::solve::checks::{Recovered, check_candidates, check_change, check_way};
use crate::solve::condenser::{Candidates, Condensed};
use crate::solve::iteration::Iteration;
use crate::solve::solver::Solver;
use crate::solve::work::Work;
use crate::system::{Cause, Constraints, State, StepFailure};
use crate::time::Trial;

/// Tries a quasi-static increment on the candidates of bodies that were condensed.
pub fn attempt_condensed(
    solver: &mut Solver,
    model: &Model,
    frame: &Frame,
    contact: &mut Contact,
    external: Vec<f64>,
    constraints: Constraints,
    trial: Trial,
) -> Result<Accepted, StepFailure> {
    let Solver {
        newton,
        seen,
        stiffness,
        diagonal,
        condenser,
        floating,
        conditions,
        ..
    } = solver;
    let condensed =
        (condenser.at_rest.as_mut()).expect("bodies were condensed when the step was begun");
    let started = Instant::now();
    let amplitudes = amplitudes(condensed, &**stiffness, &external, &constraints);
    let amplitudes = amplitudes.map_err(describe)?;
    let Condensed {
        condensation,
        reduced,
        patterns,
        state: from,
        carried,
        course,
        ahead,
        found,
        ..
    } = condensed;
    let contacts: &ContactMemory = ahead.as_ref().unwrap_or(&frame.contacts);
    let load = patterns.load(&amplitudes, condensation.size());
    newton.statistics.seconds.solve += started.elapsed().as_secs_f64();
    let scale = external.iter().map(|e| e * e).sum::<f64>().sqrt();
    let mut at = State {
        t: trial.to,
        u: from.u.clone(),
        ..State::default()
    };
    let mut guess = carried.clone();
    let now = both(condensation.gather(&from.u), &guess);
    if let Some(ahead) = course.ahead(&now, trial.to - trial.from) {
        let (moved, more) = ahead.split_at(guess.len());
        for (&dof, moved) in condensation.dofs.iter().zip(moved) {
            at.u[dof] += moved;
        }
        guess.iter_mut().zip(more).for_each(|(g, more)| *g += more);
    }
    let base = vec![0.0; condensation.size()];
    let mut bulk = CondensedBulk::new(condensation, reduced, diagonal, load, base, guess, scale);
    let fixed = constraints.fixed.clone();
    let mut forces = contact.forces(contacts, conditions);
    let converged = Iteration {
        newton,
        seen,
        model,
        forces: floating.with(forces.all()),
        bulk: &mut bulk,
        rate: None,
        frames: None,
        stoppable: true,
    }
    .solve(constraints, from, &mut at);
    *found = Some((amplitudes, bulk.carried()));
    let converged = converged?;
    let dofs = condensation.dofs.iter();
    check_change(model, dofs.map(|&d| (at.u[d], from.u[d])))?;
    check_candidates(contact, conditions)?;
    check_way(model, contact.views_of(contacts), [from, &at], &fixed)?;
    Ok(Accepted {
        contact: converged.contact.clone(),
        external,
        state: at,
        ..Accepted::from_newton(&converged)
    })
}

/// Makes an accepted attempt the state from which the next starts; what its interior follows from. `None` where it is known. Forces by dof are made
/// again when they are needed: many increments may wait.
pub fn move_ahead(
    solver: &mut Solver,
    accepted: &mut Accepted,
    trial: Trial,
) -> Option<Candidates> {
    let condensed = solver.condenser.at_rest.as_mut()?;
    let (amplitudes, now) = condensed.found.take()?;
    let Condensed {
        condensation,
        state,
        carried,
        course,
        ..
    } = condensed;
    let before = both(condensation.gather(&state.u), carried);
    course.go_on(trial.to - trial.from, before);
    *carried = now;
    state.clone_from(&accepted.state);
    accepted.external = Vec::new();
    let contact = std::mem::take(&mut accepted.contact);
    let contact = contact.into_iter().enumerate();
    Some(Candidates {
        amplitudes,
        contact: contact.filter(|(_, f)| f.to_bits() != 0).collect(),
        displacements: condensation.gather(&state.u),
    })
}

/// Finds the interiors of increments, all in one sweep.
pub fn recover<'a>(
    solver: &mut Solver,
    pending: impl Iterator<Item = (&'a Candidates, &'a mut Accepted)>,
) {
    let started = Instant::now();
    let Some(condensed) = &solver.condenser.at_rest else {
        return;
    };
    let (mut swept, mut at, mut all) = (Vec::new(), Vec::new(), Vec::new());
    let mut internal = Vec::new();
    for (found, accepted) in pending {
        let Condensed {
            patterns,
            condensation,
            ..
        } = condensed;
        swept.push(patterns.interior(&found.amplitudes, condensation));
        at.push(found.displacements.clone());
        all.push(&mut accepted.state.u);
        internal.push(&mut accepted.internal);
    }
    solver.seen.tell(&Work::Recovering(all.len()));
    let recovered = condensed.condensation.recover(swept, &at, &mut all);
    // Whoever completes the increments is told.
    solver.condenser.broken = recovered.map_err(describe).err();
    let states: Vec<&[f64]> = all.iter().map(|u| u.as_slice()).collect();
    for (internal, found) in internal.into_iter().zip(solver.stiffness.mul_all(&states)) {
        *internal = Some(found);
    }
    solver.newton.statistics.seconds.recover += started.elapsed().as_secs_f64();
}

/// Completes a recovered increment by its forces, and checks that they balance.
pub fn complete(
    solver: &mut Solver,
    model: &Model,
    frame: &Frame,
    contact: &Contact,
    after: &ContactMemory,
    found: &Candidates,
    accepted: &mut Accepted,
) -> Result<(), StepFailure> {
    if let Some(broken) = solver.condenser.broken() {
        return Err(broken.clone());
    }
    let started = Instant::now();
    let t = accepted.state.t;
    accepted.external = frame.external(model, t);
    accepted.contact = vec![0.0; accepted.external.len()];
    for &(dof, force) in &found.contact {
        accepted.contact[dof] = force;
    }
    let u = &accepted.state.u;
    let known = accepted.internal.take();
    let internal = known.unwrap_or_else(|| solver.stiffness.times(u));
    let fixed = frame.constraints(model, t).fixed;
    let both = accepted.contact.iter().zip(&accepted.external);
    let forces = internal.iter().zip(both);
    let forces: Vec<f64> = forces
        .map(|(i, (contact, load))| i + contact - load)
        .collect();
    let squares = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>();
    let recovered = Recovered {
        forces: &forces,
        u,
        diagonal: &solver.diagonal,
        fixed: &fixed,
        contact: squares(&accepted.contact),
        others: squares(&accepted.external),
    };
    let largest = &mut solver.condenser.largest_forces;
    recovered.check(model.solution.settings.tolerance, largest)?;
    for (conditions, view) in solver.conditions.iter().zip(contact.views_of(after)) {
        let overlooked = look::overlooked(view, conditions, u, t);
        if overlooked > 0 {
            return Err(StepFailure::new(
                Cause::Reach,
                format!(
                    "interface {}: {overlooked} points penetrate that were not expected to be touched",
                    view.name
                ),
            )
            .help("set `solver.method = \"sparse\"`, or take smaller increments"));
        }
    }
    accepted.strain = 0.5 * dot(u, &internal);
    accepted.flow = Flow {
        work: conditions::work(frame, &fixed, u, &forces, &accepted.external),
        transmitted: conditions::transmitted(frame, model, u, &forces, &accepted.external),
        ..Flow::default()
    };
    accepted.forces = forces;
    solver.newton.statistics.seconds.recover += started.elapsed().as_secs_f64();
    Ok(())
}

/// Displacements of the candidates and the forces behind them, one after the other: they go on together, as one follows from the other.
fn both(mut displacements: Vec<f64>, forces: &[f64]) -> Vec<f64> {
    displacements.extend_from_slice(forces);
    displacements
}

/// How much of each load pattern there is in an increment.
fn amplitudes(
    condensed: &mut Condensed,
    stiffness: &dyn Matrix,
    external: &[f64],
    constraints: &Constraints,
) -> Result<Amplitudes, LinearError> {
    let held = &condensed.condensation.held;
    let free: Vec<f64> = external
        .iter()
        .zip(held)
        .map(|(e, &held)| if held { 0.0 } else { *e })
        .collect();
    let mut prescribed = vec![0.0; external.len()];
    constraints.impose(&mut prescribed);
    (condensed.patterns).resolve(&condensed.condensation, stiffness, &free, &prescribed)
}
