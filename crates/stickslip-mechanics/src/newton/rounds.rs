//! Equilibria one after the other, until the multipliers have settled.

use super::attempt::Attempt;
use super::progress::Converged;
use crate::number::digits;
use crate::system::{Augmentation, Cause, Stage, StepFailure};

/// Most multiplier updates in one increment.
const MOST_ROUNDS: usize = 25;

/// Equilibrium, then multiplier updates until they settle. `find` finds an equilibrium from where the attempt is, after so many updates.
pub(super) fn rounds(
    attempt: &mut Attempt,
    mut find: impl FnMut(&mut Attempt, usize) -> Result<Converged, StepFailure>,
) -> Result<Converged, StepFailure> {
    let mut total = 0;
    let mut round = 0;
    let most = MOST_ROUNDS + attempt.system.patience();
    loop {
        let mut converged = find(attempt, round)?;
        total += converged.iterations;
        if attempt.system.put_back() > 0 {
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
                "the multipliers did not settle in {most} updates; the gap error is still {worst} times its limit",
                worst = digits(worst, 2)
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
        frames: attempt.system.frames,
    };
    let mut worst: f64 = 0.0;
    for force in &mut attempt.system.contact {
        if let Augmentation::Again(error) = force.augment(&stage) {
            worst = worst.max(error);
        }
    }
    (worst != 0.0).then_some(worst)
}
