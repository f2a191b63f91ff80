use std::sync::Arc;

use super::attempt::Attempt;
use super::equilibrium::equilibrium;
use super::in_forces::{Account, in_forces};
use super::progress::{Converged, Progress};
use super::rounds::rounds;
use super::settings::Settings;
use super::statistics::Statistics;
use super::strategy::{Fallback, Strategy};
use super::system::System;
use crate::friction::FrictionProblem;
use crate::system::{Cause, State, StepFailure};

/// Failures after which the other way is not tried.
const HOPELESS: [Cause; 5] = [
    Cause::NotFinite,
    Cause::Reach,
    Cause::Memory,
    Cause::Engine,
    Cause::Interrupted,
];

/// Newton's method with a line search and multiplier updates.
#[derive(Default)]
pub struct Newton {
    /// Settings.
    pub settings: Settings,
    /// Counts over all solutions.
    pub statistics: Statistics,
    /// What was tried in the last solution when plain iteration had failed.
    pub fallbacks: Vec<Fallback>,
    /// The friction problem of the last increment for which neither way led anywhere.
    pub unsolved: Option<FrictionProblem>,
    /// Iterations of the solutions since the last equilibrium, which led to none.
    in_vain: usize,
    /// Asked in every iteration whether the solution shall be given up.
    pub interrupt: Option<Arc<dyn Fn() -> bool + Send + Sync>>,
}

impl Newton {
    /// A solver with these settings.
    pub fn new(settings: Settings) -> Self {
        Newton {
            settings,
            ..Newton::default()
        }
    }

    /// Whether the solution shall be given up.
    pub fn interrupted(&self) -> bool {
        self.interrupt.as_ref().is_some_and(|asked| asked())
    }

    /// Finds equilibrium at `at.t` from the guess `at.u`; every interface starts from its committed history.
    pub fn solve(
        &mut self,
        system: &mut System,
        from: &State,
        at: &mut State,
        log: &mut dyn FnMut(&Progress),
    ) -> Result<Converged, StepFailure> {
        let begun = self.statistics.iterations;
        let outcome = self.find(system, from, at, log);
        match &outcome {
            Ok(_) => self.in_vain = 0,
            // What is given up from outside is begun again as if nothing had been.
            Err(failure) if failure.cause == Cause::Interrupted => {}
            Err(_) => self.in_vain += self.statistics.iterations - begun,
        }
        outcome
    }

    fn find(
        &mut self,
        system: &mut System,
        from: &State,
        at: &mut State,
        log: &mut dyn FnMut(&Progress),
    ) -> Result<Converged, StepFailure> {
        system.constraints.impose(&mut at.u);
        system.links.impose(&mut at.u);
        let guess = at.u.clone();
        let begun = self.statistics.iterations;
        self.fallbacks.clear();
        self.unsolved = None;
        let interrupt = (self.interrupt.as_deref()).filter(|_| system.stoppable);
        let mut attempt = Attempt {
            system,
            from,
            at,
            guess: &guess,
            strategy: Strategy::Plain,
            settings: self.settings,
            in_vain: self.in_vain,
            statistics: &mut self.statistics,
            interrupted: &|| interrupt.is_some_and(|asked| asked()),
            log,
        };
        attempt.restart();
        let failure = match rounds(&mut attempt, equilibrium) {
            Err(failure) if !HOPELESS.contains(&failure.cause) => failure,
            outcome => return outcome,
        };
        let before = attempt.statistics.iterations;
        attempt.strategy = Strategy::FrictionProblem;
        let mut account = Account::default();
        let outcome = in_forces(&mut attempt, &failure.cause, &mut account);
        let solver = account.solver();
        self.unsolved = account.last.take();
        let outcome = match outcome {
            None => return Err(failure),
            Some(Err(failure)) if failure.cause == Cause::Interrupted => return Err(failure),
            Some(outcome) => outcome,
        };
        attempt.statistics.fallbacks += 1;
        self.fallbacks.push(Fallback {
            kind: Strategy::FrictionProblem,
            iterations: attempt.statistics.iterations - before,
            converged: outcome.is_ok(),
            solver: solver.clone(),
        });
        let converged = match outcome {
            Ok(converged) => converged,
            Err(otherwise) => {
                let system = &attempt.system;
                let place = |(force, point): (usize, usize)| system.contact[force].place(point);
                let otherwise = account.otherwise(&otherwise, place);
                return Err(StepFailure {
                    otherwise: Some(Box::new(otherwise)),
                    ..failure
                });
            }
        };
        self.unsolved = None;
        Ok(Converged {
            iterations: attempt.statistics.iterations - begun,
            solver: Some(solver),
            ..converged
        })
    }
}
