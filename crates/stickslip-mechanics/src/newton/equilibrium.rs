//! Newton's iteration for one set of multipliers.

use super::attempt::Attempt;
use super::balance::Balance;
use super::progress::{Converged, Progress};
use super::step_length::{self, StepControl};
use super::strategy::Strategy;
use crate::number::digits;
use crate::system::{Assembler, Cause, StepFailure};

/// Iterations after which a residual that has not fallen counts as stalled.
const STALL: usize = 8;

/// Part of what Newton still needs to which a linear system is solved once the status of points has settled: an inexact Newton method
/// ([Dembo, Eisenstat and Steihaug](stickslip_base::references::dembo_1982)). The value is tuned.
const FORCING: f64 = 0.1;

/// The finest relative residual of a linear system: double precision gives no more.
const FINEST_RESIDUAL: f64 = 1e-13;

/// Iterations after which the tangent is whole in any case.
const PATIENT: usize = 4;

/// Residuals that a failure quotes.
const QUOTED: usize = 5;

/// The right-hand side and the solution of the linear system, by dof.
struct Linear {
    b: Vec<f64>,
    du: Vec<f64>,
    curvature: Curvature,
}

/// Whether how gaps and slips curve is in the matrix. It weighs what pressure does beside moduli, mostly next to nothing, and makes linear systems
/// dearer: with it a Krylov step takes two products with the compliance, without it one.
#[derive(PartialEq)]
enum Curvature {
    /// Where it costs next to nothing, until Newton's method misses it.
    Unasked,
    Wanted,
    /// Not any more: linear systems could not be solved with it.
    Refused,
}

/// Iterates to equilibrium from where the attempt is; `round` is the multiplier update that it follows.
pub(super) fn equilibrium(attempt: &mut Attempt, round: usize) -> Result<Converged, StepFailure> {
    let settings = attempt.settings;
    let mut out = assembler(attempt);
    let n = attempt.system.dofs.count();
    let (b, du) = (vec![0.0; n], vec![0.0; n]);
    let mut linear = Linear {
        b,
        du,
        curvature: Curvature::Unasked,
    };
    let mut balance = attempt.evaluate(&mut out, true)?;
    let mut control = StepControl::default();
    let mut residuals = Vec::new();
    // With what multipliers miss: a failure may be theirs alone.
    let mut reported = Vec::new();
    for iteration in 0..=settings.max_iterations {
        if (attempt.interrupted)() {
            return Err(StepFailure::new(Cause::Interrupted, "interrupted"));
        }
        residuals.push(balance.relative());
        let before = balance.with(out.multiplier_residual);
        let residual = balance.compared(before);
        reported.push(residual);
        let target = balance.target(settings.tolerance);
        if balance.is_met(out.multiplier_residual, target) {
            return Ok(converged(attempt, balance, out, iteration, round));
        }
        if iteration == settings.max_iterations || chatters(attempt, &residuals) {
            break;
        }
        let slow = iteration > 0
            && attempt.system.tally().changed == 0
            // Where an iteration in which no point changes status leaves more of the residual, the tangent lacks something.
            && residual > 0.1 * reported[iteration - 1];
        if linear.curvature == Curvature::Unasked && (slow || iteration >= PATIENT) {
            linear.curvature = Curvature::Wanted;
        }
        let krylov = solve(attempt, &mut out, &balance, &mut linear, iteration == 0)?;
        let demand = control.demand(&residuals, before, balance.scale);
        let taken = step_length::take(attempt, &mut out, &linear.du, &demand)?;
        balance = taken.balance;
        (attempt.log)(&Progress {
            strategy: attempt.strategy,
            iteration,
            round,
            residual,
            step: taken.length,
            krylov,
            tally: attempt.system.tally(),
        });
    }
    Err(not_converged(attempt, &reported))
}

/// Asks the interfaces for what the bulk needs of them.
fn assembler(attempt: &Attempt) -> Assembler {
    let system = &attempt.system;
    let mut out = Assembler::new(system.dofs.count());
    out.wants_surrogate = system.bulk.wants_surrogates();
    out.wants_pairs = system.bulk.wants_pairs();
    out.holds_turns = system.patience() > 0;
    out
}

fn converged(
    attempt: &Attempt,
    balance: Balance,
    out: Assembler,
    iterations: usize,
    rounds: usize,
) -> Converged {
    Converged {
        iterations,
        rounds,
        // what is below rounding is none
        residual: if balance.norm <= balance.floor {
            0.0
        } else {
            balance.relative()
        },
        tally: attempt.system.tally(),
        forces: balance.forces,
        contact: out.residual,
        solver: None,
    }
}

/// Whether points keep changing status and nothing is gained: they are better held than given more time. Where the last iteration left all of them as they
/// were, the next may be the last.
fn chatters(attempt: &mut Attempt, residuals: &[f64]) -> bool {
    attempt.strategy == Strategy::Plain
        && stalled(residuals)
        && attempt.system.tally().changed > 0
        && attempt.system.chatters()
}

/// Whether the last iterations have not brought the residual down by an order of magnitude.
pub(super) fn stalled(residuals: &[f64]) -> bool {
    let Some(split) = residuals.len().checked_sub(STALL) else {
        return false;
    };
    let (before, after) = residuals.split_at(split);
    let least = |r: &[f64]| r.iter().copied().fold(f64::INFINITY, f64::min);
    // The part of the residual before them that must be left behind.
    before.len() >= STALL && least(after) > 0.1 * least(before)
}

/// Solves for Newton's step; returns the Krylov iterations.
fn solve(
    attempt: &mut Attempt,
    out: &mut Assembler,
    balance: &Balance,
    Linear { b, du, curvature }: &mut Linear,
    first: bool,
) -> Result<usize, StepFailure> {
    let settings = attempt.settings;
    let system = &mut *attempt.system;
    b.fill(0.0);
    let mut size = 0.0;
    for &i in system.bulk.dofs() {
        if !system.bulk.fixed()[i] {
            b[i] = -(balance.forces[i] + out.condensed[i]);
            size += b[i] * b[i];
        }
    }
    // While points still change status the linear problem is not the last one: digits would be thrown away.
    let coarse = settings.linear_tolerance;
    let wanted = if first || system.tally().changed > 0 {
        coarse
    } else {
        let target = balance.target(settings.tolerance);
        FORCING * target / f64::sqrt(size).max(f64::MIN_POSITIVE)
    };
    system.damp_step(b, out);
    // Bodies that are being followed roll on their anchors, whose steps are tuned to how their own points curve.
    let straight = system.patience() == 0 && system.bulk.prefers_straight(out);
    match curvature {
        Curvature::Unasked if straight => out.straighten(),
        Curvature::Unasked | Curvature::Wanted => system.curve(out),
        Curvature::Refused => {}
    }
    let wanted = wanted.clamp(FINEST_RESIDUAL, coarse.max(FINEST_RESIDUAL));
    let counts = &mut *attempt.statistics;
    let solved = (system.bulk).solve(out, b, wanted, du, &settings, &mut *counts);
    let krylov = match solved {
        // Preconditioners do not include the curvature. Where it is so large that they fail, slower iterations are better than none.
        Err(failure) if failure.cause == Cause::LinearSolver && out.drop_curvature() => {
            *curvature = Curvature::Refused;
            (system.bulk).solve(out, b, wanted, du, &settings, counts)?
        }
        solved => solved?,
    };
    system.links.impose(du);
    attempt.statistics.iterations += 1;
    Ok(krylov)
}

fn not_converged(attempt: &Attempt, residuals: &[f64]) -> StepFailure {
    let last: Vec<String> = residuals
        .iter()
        .skip(residuals.len().saturating_sub(QUOTED))
        .map(|r| digits(r, 2))
        .collect();
    let sentence = format!(
        "no equilibrium in {} iterations; relative out-of-balance force: … {}",
        residuals.len() - 1,
        last.join(", ")
    );
    attempt
        .failure(Cause::NotConverged, sentence)
        .help("smaller increments; if the same points keep changing status, a larger `epsilon` or a smaller enforcement `factor`; if a body can slide off as a whole, no equilibrium exists")
}
