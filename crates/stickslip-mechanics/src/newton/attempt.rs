use super::balance::Balance;
use super::progress::Progress;
use super::settings::Settings;
use super::statistics::Statistics;
use super::strategy::Strategy;
use super::system::System;
use crate::system::{Assembler, Cause, State, StepFailure};

/// One way of looking for an equilibrium: what is solved, from where, how, and who is told.
pub(super) struct Attempt<'a, 's> {
    /// The equations.
    pub system: &'a mut System<'s>,
    /// Last accepted state.
    pub from: &'a State,
    /// The iterate.
    pub at: &'a mut State,
    /// The displacements that ways start from.
    pub guess: &'a [f64],
    /// How it is looked for.
    pub strategy: Strategy,
    /// Dimensionless settings.
    pub settings: Settings,
    /// Iterations that attempts at other increments from the same state took, which led nowhere.
    pub in_vain: usize,
    /// Counts.
    pub statistics: &'a mut Statistics,
    /// Whether the solution shall be given up.
    pub interrupted: &'a dyn Fn() -> bool,
    /// Told of every iteration.
    pub log: &'a mut dyn FnMut(&Progress),
}

impl Attempt<'_, '_> {
    /// Goes back to the guess.
    pub fn restart(&mut self) {
        self.system.restart(self.at, self.guess);
    }

    /// Evaluates all forces at the iterate, with their tangents if `tangent`.
    pub fn evaluate(&mut self, out: &mut Assembler, tangent: bool) -> Result<Balance, StepFailure> {
        Balance::evaluate(
            self.system,
            self.from,
            self.at,
            out,
            tangent,
            self.statistics,
        )
    }

    /// A failure that names the points that are difficult.
    pub fn failure(&self, cause: Cause, sentence: impl Into<String>) -> StepFailure {
        StepFailure {
            culprits: self.system.culprits(),
            ..StepFailure::new(cause, sentence)
        }
    }
}
