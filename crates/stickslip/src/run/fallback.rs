//! From condensed bodies to the sparse matrix, where what was found with them does not hold.

use super::position::Increments;
use super::queue::{Pending, TakenBack};
use super::simulation::Simulation;
use crate::error::Error;
use crate::results::observer::Observer;
use crate::system::{Cause, StepFailure};

impl Simulation {
    /// Takes note of an increment whose interior does not hold: interfaces know what they knew before. The error ends the turn.
    pub(super) fn roll_back(&mut self, one: &Pending, failure: StepFailure) -> Error {
        self.pending.clear();
        self.taken_back = Some(TakenBack {
            trial: one.trial,
            increment: one.increment,
            failure: failure.clone(),
        });
        failure.at(one.trial.to).into()
    }

    /// Goes on from the increment before one that was taken back, with the sparse matrix.
    pub(super) fn go_back(
        &mut self,
        taken: TakenBack,
        observers: &mut [&mut dyn Observer],
    ) -> Result<(), Error> {
        let TakenBack {
            trial,
            increment,
            failure,
        } = taken;
        if self.try_block_again()? {
            self.solver.floating.forget();
            return self.solve_sparsely(&failure, observers);
        }
        let mut running = Increments::of(self.step());
        running.stepper.again(trial.from, trial.to - trial.from);
        running.accepted = increment - 1;
        self.steps.running = Some(running);
        self.solver.floating.forget();
        self.solve_sparsely(&failure, observers)
    }

    /// Whether a failure is one of arithmetic that may be none with the sparse matrix.
    pub(super) fn may_solve_sparsely(&self, failure: &StepFailure) -> bool {
        let arithmetic = matches!(
            failure.cause,
            Cause::Interior | Cause::Singular | Cause::LinearSolver
        );
        arithmetic && self.solver.condenses()
    }

    /// Goes on from the last accepted increment with the sparse matrix.
    pub(super) fn solve_sparsely(
        &mut self,
        failure: &StepFailure,
        observers: &mut [&mut dyn Observer],
    ) -> Result<(), Error> {
        self.reset_predictor();
        let Simulation {
            model,
            contact,
            frame,
            solver,
            ..
        } = self;
        solver.give_condensing_up(model, frame, contact, &failure.message);
        self.tell_notes(observers)
    }
}
