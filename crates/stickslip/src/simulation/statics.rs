//! Quasi-static increments.

use super::accepted::{Accepted, Flow};
use super::inertia;
use super::run::{Observer, Simulation};
use crate::newton::{Progress, SparseBulk, System};
use crate::system::{State, StepFailure};
use crate::time::Trial;

impl Simulation {
    /// Tries a quasi-static increment.
    pub(super) fn attempt_static(
        &mut self,
        trial: Trial,
        observers: &mut [&mut dyn Observer],
    ) -> Result<Accepted, StepFailure> {
        if self.condensed.is_some() {
            return self.attempt_condensed(trial);
        }
        let dt = trial.to - trial.from;
        let external = self.external(trial.to);
        let constraints = self.constraints(trial.to);
        let fixed = constraints.fixed.clone();
        let mut at = State {
            t: trial.to,
            u: self.state.u.clone(),
            ..State::default()
        };
        if let Some((before, u)) = &self.previous {
            // the last increment goes on
            let ratio = dt / before;
            for (a, (now, then)) in at.u.iter_mut().zip(self.state.u.iter().zip(u)) {
                *a = now + ratio * (now - then);
            }
        }
        (self.model.couplings).fit(&self.diagonal, &fixed, &self.model.links);
        let mut seen: Vec<Progress> = Vec::new();
        let converged = {
            let Simulation {
                model,
                newton,
                factors,
                matrix,
                diagonal,
                state,
                loose,
                ..
            } = self;
            let mut bulk = SparseBulk::new(
                (matrix, diagonal),
                external.clone(),
                fixed.clone(),
                None,
                factors.of(0),
            );
            let mut system = System {
                dofs: model.dofs,
                bulk: &mut bulk,
                rate: None,
                constraints,
                links: &model.links,
                contact: loose.with(inertia::contact(
                    &mut model.interfaces,
                    &mut model.couplings,
                )),
            };
            newton.solve(&mut system, state, &mut at, &mut |p| seen.push(*p))
        };
        self.tell(&seen, observers);
        let converged = converged?;
        self.check_change(&at.u)?;
        let work = self.work(&fixed, (&at.u, &converged.forces), &external);
        Ok(Accepted {
            forces: converged.forces.clone(),
            contact: converged.contact.clone(),
            external,
            flow: Flow {
                work,
                ..Flow::default()
            },
            state: at,
            ..Accepted::from_newton(&converged)
        })
    }

    /// Work of loads and reactions over an increment by the trapezoidal rule: exact for forces that vary linearly. It begins with what held the last
    /// accepted state in balance, not with what an amplitude says of its time: a load that is there at once, or changes from one step to the next, is
    /// taken from one equilibrium to the other like any other, and a support that lets go has done its part until then.
    pub(super) fn work(
        &self,
        fixed: &[bool],
        (u, forces): (&[f64], &[f64]),
        external: &[f64],
    ) -> f64 {
        let mut work = 0.0;
        for (i, after) in external.iter().enumerate() {
            let before = self.load[i] + self.forces[i];
            let reaction = if fixed[i] { forces[i] } else { 0.0 };
            work += 0.5 * (before + after + reaction) * (u[i] - self.state.u[i]);
        }
        work
    }
}
