//! How far a Newton step is taken.

use super::attempt::Attempt;
use super::balance::Balance;
use crate::system::{Assembler, Cause, StepFailure};

/// Iterations in which points find their status: a step may make matters much worse, and it is too early to say that nothing is gained.
const EARLY: usize = 4;

/// Factor by which a step may multiply the residual once points chatter: every step has to gain a little. With 0.9 and 0.999 all short cases (see
/// [`tolerance`](crate::tolerance)) end as they do and keep their expected values, within 0.3 % of the same number of iterations.
const LEAST_GAIN: f64 = 0.99;

const BACK: usize = 3;

/// Most halvings even so.
const MOST_HALVINGS: usize = 40;

/// What the next step has to achieve, judged by the steps before.
#[derive(Default)]
pub(super) struct StepControl {
    /// Residual at which steps began to have to gain; zero while they need not.
    gaining_since: f64,
}

/// What a step has to achieve.
pub(super) struct Demand {
    /// The larger residual of displacements and multipliers before the step.
    before: f64,
    /// By which factor it may grow at most.
    growth: f64,
    /// The scale of forces before the step.
    in_play: f64,
}

/// A step that was taken.
pub(super) struct Taken {
    /// The balance after it, with tangents.
    pub balance: Balance,
    /// Its length.
    pub length: f64,
}

impl StepControl {
    /// What a step has to achieve after iterates with these residuals relative to the scale of forces; `before` is the last of them, as a force, and `in_play` what it is
    /// relative to.
    pub fn demand(&mut self, residuals: &[f64], before: f64, in_play: f64) -> Demand {
        let iteration = residuals.len() - 1;
        let relative = residuals[iteration];
        // An iteration counts as stuck if it has left behind less than half of the residual of [`BACK`] iterations before.
        if iteration >= EARLY && relative > 0.5 * residuals[iteration - BACK] {
            self.gaining_since = self.gaining_since.max(relative);
        } else if relative < 0.01 * self.gaining_since {
            // Steps need not gain any more below this part of the residual at which they began to have to.
            self.gaining_since = 0.0;
        }
        let growth = match (self.gaining_since > 0.0, iteration < EARLY) {
            (true, _) => LEAST_GAIN,
            // A full step may multiply the residual by this in the first iterations, and by less later. Status may have to change against
            // it; only what looks like divergence is shortened.
            (false, true) => 1e3,
            (false, false) => 10.0,
        };
        Demand {
            before,
            growth,
            in_play,
        }
    }
}

impl Demand {
    fn is_met(&self, measure: f64) -> bool {
        measure <= self.growth * self.before
    }

    /// Whether it may be a jump that a full step leads to. Where points leave the surface or come back to it forces jump, by no more than the scale; shorter steps would
    /// come nearer and nearer to the edge and gain less and less. Not where points chatter: there a step has to gain.
    fn lets_jump(&self, measure: f64) -> bool {
        self.growth > LEAST_GAIN && measure <= self.in_play
    }

    /// Halvings after which the best step is taken, where the last length led to this measure.
    fn halvings(&self, measure: f64, line_search: usize) -> usize {
        // Growth of the out-of-balance force after which a step is halved without counting: a compliant law that has hardly been touched is
        // so soft that the step overshoots by orders of magnitude.
        let lost = measure.is_nan() || measure > 1e4 * self.before;
        if line_search > 0 && lost {
            MOST_HALVINGS
        } else {
            line_search
        }
    }
}

/// Takes as much of the solution `du` as meets the demand. Most full steps do: their tangent is made at once.
pub(super) fn take(
    attempt: &mut Attempt,
    out: &mut Assembler,
    du: &[f64],
    demand: &Demand,
) -> Result<Taken, StepFailure> {
    let line_search = attempt.settings.line_search;
    let start = attempt.at.u.clone();
    let mut length = 1.0;
    let mut halvings = 0;
    // the least measure and the length that led to it
    let mut best: Option<(f64, f64)> = None;
    let balance = loop {
        attempt.system.advance(attempt.at, &start, du, length);
        out.tentative = halvings == 0;
        let balance = attempt.evaluate(out, halvings == 0)?;
        let measure = balance.with(out.multiplier_residual);
        if measure.is_finite() && best.is_none_or(|(least, _)| measure < least) {
            best = Some((measure, length));
        }
        let jumps = halvings == 0 && demand.lets_jump(measure) && attempt.system.passes_edges();
        let met = demand.is_met(measure) || jumps;
        if met || halvings >= demand.halvings(measure, line_search) {
            break balance;
        }
        halvings += 1;
        length *= 0.5;
    };
    out.tentative = false;
    let Some((_, chosen)) = best else {
        return Err(attempt.failure(Cause::NotFinite, "the forces are not finite"));
    };
    if halvings >= line_search {
        length = chosen;
    }
    if halvings == 0 {
        attempt.system.settle();
        attempt.system.bulk.covers(out)?;
        return Ok(Taken { balance, length });
    }
    attempt.system.advance(attempt.at, &start, du, length);
    let balance = attempt.evaluate(out, true)?;
    Ok(Taken { balance, length })
}
