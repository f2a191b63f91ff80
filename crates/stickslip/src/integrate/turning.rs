//! Increments of bodies that turn freely by any angle.
//!
//! Such a body is seen from a frame that stands still ([`super::sight`]) where its own will be: in motion at the stage of the scheme, as it goes on by its spin, at rest at the
//! end, as the pass before has left it. The matrix, factored once for the whole analysis, is a good derivative there, but none of what bodies resist with: forces are found
//! again where the increment has ended, and it is solved again from there until they balance.

use super::quasi_static::{QuasiStatic, pairs};
use super::sight::{Ended, InertialFrame, in_space};
use crate::body::couplings::fit;
use crate::math::vector::difference;
use crate::model::conditions;
use crate::model::contact::Contact;
use crate::model::definition::Model;
use crate::model::frame::Frame;
use crate::model::ledger::Flow;
use crate::solve::accepted::Accepted;
use crate::solve::checks::check_change;
use crate::solve::iteration::{Load, Task};
use crate::solve::solver::Solver;
use crate::system::{Deformed, State, StepFailure};
use crate::time::Trial;

impl QuasiStatic {
    /// Tries an increment in which bodies turn freely. Each pass sees them from where the one before has left them: nothing but their strain is missed then.
    pub(super) fn turning(
        &self,
        model: &Model,
        frame: &Frame,
        contact: &mut Contact,
        solver: &mut Solver,
        trial: Trial,
    ) -> Result<Accepted, StepFailure> {
        let mut u = frame.state.u.clone();
        for passes in 1.. {
            // Springs that follow unconstrained bodies are along the axes of space.
            let turns = match solver.floating.anchored() {
                true => model.corotations.turns(&vec![0.0; u.len()]),
                false => model.corotations.turns(&u),
            };
            let sight = InertialFrame::from(model, frame, &turns);
            let seen = sight.place(&model.mesh.points, &u);
            let found = pass(&sight, model, contact, solver, trial, passes, seen);
            let (met, accepted) = found?;
            let accepted = in_space(model, &sight.outlook(), accepted);
            if met {
                check_change(model, pairs(&accepted.state.u, &frame.state.u))?;
                return Ok(accepted);
            }
            u = accepted.state.u;
        }
        unreachable!("passes end")
    }
}

/// Solves a quasi-static increment with the forces that bodies have at the displacements `u`, as far as the stiffness does not give them; whether these hold
/// where it ends, too.
fn pass(
    sight: &InertialFrame,
    model: &Model,
    contact: &mut Contact,
    solver: &mut Solver,
    trial: Trial,
    passes: usize,
    u: Vec<f64>,
) -> Result<(bool, Accepted), StepFailure> {
    let inside = sight.inside(model);
    let constraints = sight.constraints(model, trial.to);
    let fixed = constraints.fixed.clone();
    fit::fit(
        &mut contact.couplings,
        &solver.diagonal,
        &fixed,
        &model.links,
    );
    let mut external = Vec::new();
    sight.load(model, &u, trial.to, &mut external);
    let missed = difference(&solver.bodies.forces(&u), &solver.stiffness.times(&u));
    let mut at = State {
        t: trial.to,
        u,
        ..State::default()
    };
    let task = Task {
        load: Load::External(difference(&external, &missed)),
        constraints,
        rate: None,
        frames: Some(&sight.all),
        from: &inside.state,
        contacts: &inside.contacts,
        stoppable: true,
    };
    let converged = solver.solve_sparse(model, contact, task, &mut at)?;
    external.clear();
    sight.load(model, &at.u, trial.to, &mut external);
    let internal = solver.bodies.forces(&at.u);
    let size = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
    let left = difference(&internal, &external);
    let end = Ended {
        forces: &left,
        size: size(&external).max(size(&internal)),
    };
    let met = sight.met(model, &converged, end, &fixed, &solver.diagonal, passes)?;
    let found = met.as_ref().unwrap_or(&converged);
    let forces = found.forces.clone();
    let accepted = Accepted {
        flow: Flow {
            work: conditions::work(&inside, &fixed, &at.u, &forces, &external),
            ..Flow::default()
        },
        strain: solver.bodies.energy(Deformed {
            u: &at.u,
            forces: &internal,
        }),
        forces,
        contact: found.contact.clone(),
        external,
        state: at,
        ..Accepted::from_newton(found)
    };
    Ok((met.is_some(), accepted))
}
