//! Quasi-static increments.

use super::integrator::Integrator;
use super::supports::turn_with_supports;
use crate::body::couplings::fit;
use crate::model::conditions;
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
            stoppable: true,
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
                work: conditions::work(frame, &fixed, &at.u, &converged.forces, &external),
                transmitted: conditions::transmitted(
                    frame,
                    model,
                    &at.u,
                    &converged.forces,
                    &external,
                ),
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
