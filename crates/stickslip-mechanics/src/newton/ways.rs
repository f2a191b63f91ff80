//! The ways other than plain iteration, tried one after the other.

use super::attempt::Attempt;
use super::equilibrium::equilibrium;
use super::in_forces::in_forces;
use super::progress::Converged;
use super::rounds::rounds;
use super::strategy::Strategy;
use super::system::System;
use crate::friction::FrictionProblem;
use crate::system::{StepFailure, Way};

/// All strategies but the plain one, in the order in which they are tried.
pub(super) fn strategies(system: &mut System) -> Vec<Strategy> {
    let mut all = vec![Strategy::StatusMemory, Strategy::LineSearch];
    for way in system.ways() {
        let strategy = Strategy::Continuation(way.name);
        if !all.contains(&strategy) {
            all.push(strategy);
        }
    }
    all.push(Strategy::FrictionProblem);
    all
}

/// Tries the way of the attempt; `None` if it does not apply.
pub(super) fn follow(
    attempt: &mut Attempt,
    unsolved: &mut Option<FrictionProblem>,
) -> Option<Result<Converged, StepFailure>> {
    match attempt.strategy {
        Strategy::Plain => None,
        Strategy::StatusMemory => frozen(attempt),
        Strategy::LineSearch => {
            attempt.restart();
            Some(rounds(attempt))
        }
        Strategy::Continuation(name) => continued(attempt, name),
        Strategy::FrictionProblem => in_forces(attempt, unsolved),
    }
}

/// Goes on from where the points chattered, with them frozen; if that is no good place, starts again with those points sticking.
fn frozen(attempt: &mut Attempt) -> Option<Result<Converged, StepFailure>> {
    if attempt.system.freeze(true) == 0 {
        attempt.system.freeze(false);
        return None;
    }
    let mut outcome = rounds(attempt);
    if outcome.is_err() {
        attempt.restart();
        outcome = rounds(attempt);
    }
    attempt.system.freeze(false);
    Some(outcome)
}

/// Tries all ways of a name until one leads to the forces wanted.
fn continued(attempt: &mut Attempt, name: &str) -> Option<Result<Converged, StepFailure>> {
    let mut last = None;
    for way in attempt.system.ways().into_iter().filter(|w| w.name == name) {
        attempt.restart();
        attempt.statistics.continuations += 1;
        let outcome = continuation(attempt, &way);
        attempt.system.ease(None);
        let done = outcome.is_ok();
        last = Some(outcome);
        if done {
            break;
        }
    }
    last
}

/// Equilibria under forces that are ever less easy, each from the one before.
fn continuation(attempt: &mut Attempt, way: &Way) -> Result<Converged, StepFailure> {
    let mut iterations = 0;
    for &value in &way.values {
        attempt.system.ease(Some((way.name, value)));
        iterations += equilibrium(attempt, 0)?.iterations;
    }
    attempt.system.ease(None);
    let mut converged = rounds(attempt)?;
    converged.iterations += iterations;
    Ok(converged)
}
