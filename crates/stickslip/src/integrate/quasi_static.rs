//! Quasi-static increments.

use super::integrator::Integrator;
use super::supports::turn_with_supports;
use crate::body::couplings::fit;
use crate::model::contact::Contact;
use crate::model::definition::Model;
use crate::model::frame::Frame;
use crate::model::ledger::Flow;
use crate::solve::accepted::Accepted;
use crate::solve::carried;
use crate::solve::checks::{check_change, check_way};
use crate::solve::condensed::at_rest;
use crate::solve::iteration::{Load, Task};
use crate::solve::solver::Solver;
use crate::system::{State, StepFailure};
use crate::time::Trial;

/// Makes increments in which nothing has inertia.
pub(crate) struct QuasiStatic;

impl Integrator for QuasiStatic {
    fn attempt(
        &mut self,
        model: &Model,
        frame: &Frame,
        contact: &mut Contact,
        solver: &mut Solver,
        trial: Trial,
    ) -> Result<Accepted, StepFailure> {
        if let Some(broken) = solver.condenser.broken() {
            return Err(broken.clone());
        }
        if model.turns_freely() {
            return self.turning(model, frame, contact, solver, trial);
        }
        let external = frame.external(model, trial.to);
        let constraints = frame.constraints(model, trial.to);
        fit::fit(
            &mut contact.couplings,
            &solver.diagonal,
            &constraints.fixed,
            &model.links,
        );
        carried::carry_anchors(solver, model, frame, &constraints, trial);
        if solver.condenser.at_rest().is_some() {
            return at_rest::attempt_condensed(
                solver,
                model,
                frame,
                contact,
                external,
                constraints,
                trial,
            );
        }
        let mut at = extrapolated(frame, trial);
        turn_with_supports(model, &frame.state.u, &constraints, &mut at.u);
        let fixed = constraints.fixed.clone();
        let task = Task {
            load: Load::External(external.clone()),
            constraints,
            rate: None,
            frames: None,
            from: &frame.state,
            contacts: &frame.contacts,
        };
        let converged = solver.solve_sparse(model, contact, task, &mut at)?;
        check_change(model, pairs(&at.u, &frame.state.u))?;
        check_way(model, contact.views(frame), [&frame.state, &at], &fixed)?;
        let external = match model.is_corotational() {
            // Pressures have followed.
            true => frame.external_at(model, trial.to, &at.u),
            false => external,
        };
        Ok(Accepted {
            flow: Flow {
                work: work(frame, &fixed, &at.u, &converged.forces, &external),
                transmitted: transmitted(frame, model, &at.u, &converged.forces, &external),
                ..Flow::default()
            },
            strain: solver.strain_energy(&at.u),
            forces: converged.forces.clone(),
            contact: converged.contact.clone(),
            external,
            state: at,
            ..Accepted::from_newton(&converged)
        })
    }
}

/// Two vectors, dof by dof.
pub(crate) fn pairs<'a>(a: &'a [f64], b: &'a [f64]) -> impl Iterator<Item = (f64, f64)> + 'a {
    a.iter().copied().zip(b.iter().copied())
}

/// Where a quasi-static increment is expected to end: the last one goes on. Straight on: where points cross facets a parabola led multigrid to pairs that
/// it had not been set up for.
fn extrapolated(frame: &Frame, trial: Trial) -> State {
    let mut at = State {
        t: trial.to,
        u: frame.state.u.clone(),
        ..State::default()
    };
    if let Some(ahead) = frame.course.straight(&at.u, trial.to - trial.from) {
        at.u.iter_mut().zip(ahead).for_each(|(u, d)| *u += d);
    }
    at
}

/// Half of what loads and reactions have done on the frames of bodies that turn, whichever way: what some hand on others take. By the trapezoidal rule.
pub(crate) fn transmitted(
    frame: &Frame,
    model: &Model,
    u: &[f64],
    forces: &[f64],
    external: &[f64],
) -> f64 {
    let dofs = model.dofs;
    let frames = model.frames.all().iter();
    let carried = frames.filter_map(|f| f.hidden());
    let own = carried.flat_map(|h| dofs.of(h, 0)..dofs.of(h + 2, 0));
    let work = own.map(|i| {
        let sum = frame.load[i] + frame.forces[i] + external[i] + forces[i];
        0.5 * sum * (u[i] - frame.state.u[i])
    });
    0.5 * work.map(f64::abs).sum::<f64>()
}

/// Work of loads and reactions over an increment by the trapezoidal rule: exact for forces that vary linearly. It begins with what held the last
/// accepted state in balance, not with what an amplitude says of its time: a load that is there at once, or changes from one step to the next, is
/// taken from one equilibrium to the other like any other, and a support that lets go has done its part until then.
pub(crate) fn work(
    frame: &Frame,
    fixed: &[bool],
    u: &[f64],
    forces: &[f64],
    external: &[f64],
) -> f64 {
    let mut work = 0.0;
    for (i, after) in external.iter().enumerate() {
        let before = frame.load[i] + frame.forces[i];
        let reaction = if fixed[i] { forces[i] } else { 0.0 };
        work += 0.5 * (before + after + reaction) * (u[i] - frame.state.u[i]);
    }
    work
}
