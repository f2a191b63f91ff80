//! From condensed bodies to the sparse matrix, where what was found with them does not hold.

use super::cycles::try_block_again;
use super::parts::Run;
use super::position::Increments;
use super::queue::TakenBack;
use crate::error::Error;
use crate::results::observer::Observer;
use crate::solve::condensed::condensing;
use crate::system::{Cause, StepFailure};

/// Goes on from the increment before one that was taken back, with the sparse matrix.
pub(super) fn go_back(
    run: &mut Run,
    taken: TakenBack,
    observers: &mut [&mut dyn Observer],
) -> Result<(), Error> {
    let TakenBack {
        trial,
        increment,
        failure,
    } = taken;
    if !try_block_again(run)? {
        let mut running = Increments::of(run.step());
        running.stepper.again(trial.from, trial.to - trial.from);
        running.accepted = increment - 1;
        run.steps.running = Some(running);
    }
    run.solver.floating.forget();
    solve_sparsely(run, &failure, observers)
}

/// Whether a failure is one of arithmetic that may be none with the sparse matrix.
pub(super) fn may_solve_sparsely(run: &Run, failure: &StepFailure) -> bool {
    let arithmetic = matches!(
        failure.cause,
        Cause::Interior | Cause::Singular | Cause::LinearSolver
    );
    arithmetic && condensing::condenses(&run.solver)
}

/// Goes on from the last accepted increment with the sparse matrix.
pub(super) fn solve_sparsely(
    run: &mut Run,
    failure: &StepFailure,
    observers: &mut [&mut dyn Observer],
) -> Result<(), Error> {
    run.reset_predictor();
    condensing::give_condensing_up(
        &mut run.solver,
        &run.model,
        &run.frame,
        &run.contact,
        &failure.message,
    );
    run.tell_notes(observers)
}
