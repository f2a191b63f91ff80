//! Equilibria one after the other: until the multipliers have settled and no point is held against its laws.

use super::attempt::Attempt;
use super::equilibrium::equilibrium;
use super::progress::Converged;
use crate::system::{Augmentation, Cause, Stage, StepFailure};

/// How often the choices of points that keep changing status are exchanged.
const MOST_EXCHANGES: usize = 20;

/// Most multiplier updates in one increment.
const MOST_ROUNDS: usize = 25;

/// Equilibrium, then multiplier updates until they settle.
pub(super) fn rounds(attempt: &mut Attempt) -> Result<Converged, StepFailure> {
    let mut total = 0;
    let mut round = 0;
    let mut exchanges = 0;
    let most = MOST_ROUNDS + attempt.system.patience();
    loop {
        let mut converged = equilibrium(attempt, round)?;
        total += converged.iterations;
        if attempt.system.recheck() > 0 {
            exchanges += 1;
            if exchanges > MOST_EXCHANGES {
                return Err(attempt.failure(Cause::NotConverged, "points keep changing status"));
            }
            continue;
        }
        let Some(worst) = augment(attempt) else {
            converged.iterations = total;
            converged.rounds = round;
            return Ok(converged);
        };
        round += 1;
        attempt.statistics.augmentations += 1;
        if round > most {
            let sentence = format!(
                "the multipliers did not settle in {most} updates; the gap error is still {worst:.1e} times its limit"
            );
            return Err(attempt
                .failure(Cause::NotConverged, sentence)
                .help("allow a larger `error` or a larger `factor` in the augmented Lagrangian, or smaller increments"));
        }
    }
}

/// Updates multipliers; the worst error relative to its limit, `None` where they hold.
fn augment(attempt: &mut Attempt) -> Option<f64> {
    let stage = Stage {
        from: attempt.from,
        at: attempt.at,
        dt: attempt.at.t - attempt.from.t,
        rate: attempt.system.rate,
    };
    let mut worst: f64 = 0.0;
    for force in &mut attempt.system.contact {
        if let Augmentation::Again(error) = force.augment(&stage) {
            worst = worst.max(error);
        }
    }
    (worst != 0.0).then_some(worst)
}
