//! The increment as a friction problem: where no iteration in the displacements leads to equilibrium, one in the forces may.
//!
//! The bulk is linear, so that what points do to each other is an operator `W = B K⁻¹ Bᵀ`, and what they would do without forces a free motion `q`
//! ([`crate::friction`]). A point that yields brings its compliance along, on the diagonal. Bodies that only contact constrains are held softly where they are,
//! and let go again: each solution is where the next one holds them (a proximal term, as that of anchors). The laws are those of the points at the
//! last solution, linearised; Newton's method has the last word, with the laws themselves.
//!
//! Its unknowns are all points that are or may come to be pressed. Where a solution for each of them costs more than another attempt would, and more than those
//! that have already been made without progress, they are those that do not settle, and the others surround them as they are.

mod account;
mod columns;
mod gradients;
mod linear;
mod pass;
mod place;
mod relaxation;
mod search;

use super::attempt::Attempt;
use super::equilibrium::{equilibrium, stalled};
use super::progress::Converged;
use super::rounds::rounds;
use crate::system::{Cause, StepFailure};
use crate::tolerance::NEGLIGIBLE;
pub(super) use account::Account;
use columns::Columns;
use pass::{Pass, Points};
use place::Found;
use relaxation::Relaxation;

/// Equilibria by friction problems, one after the other as [`rounds`] asks for them, where Newton's method has failed for some cause; `None` where it is not
/// for them.
pub(super) fn in_forces(
    attempt: &mut Attempt,
    cause: &Cause,
    account: &mut Account,
) -> Option<Result<Converged, StepFailure>> {
    let points = Points {
        restless: attempt.system.chattering(),
        loose: *cause == Cause::Singular || attempt.system.patience() > 0,
    };
    attempt.restart();
    let mut columns = Columns::default();
    match settle(attempt, &points, &mut columns, account) {
        Ok(true) => {}
        Ok(false) => return None,
        Err(failure) => return Some(Err(failure)),
    }
    Some(rounds(attempt, |attempt, round| {
        if round > 0 {
            settle(attempt, &points, &mut columns, account)?;
        }
        equilibrium(attempt, round)
    }))
}

/// Solves friction problems until the forces settle; whether there are any.
fn settle(
    attempt: &mut Attempt,
    points: &Points,
    columns: &mut Columns,
    account: &mut Account,
) -> Result<bool, StepFailure> {
    let (mut before, mut last): (Vec<Found>, Vec<Found>) = Default::default();
    let mut done = false;
    let mut residuals = Vec::new();
    let mut relaxation = Relaxation::default();
    while residuals.len() < attempt.settings.max_iterations && !stalled(&residuals) {
        let Some(pass) = Pass::new(attempt)? else {
            return Ok(false);
        };
        residuals.push(pass.residual);
        done = pass.residual <= 1.0;
        if done {
            break;
        }
        let Some(next) = pass.solve(points, &last, columns, &mut relaxation, account)? else {
            return Ok(false);
        };
        // Without a problem before nothing is settled, even where nothing touches: laws that are hardly touched say less than they will where bodies have come.
        done = residuals.len() > 1 && settled(&last, &next);
        before = last;
        last = next;
        if done {
            break;
        }
    }
    account.row(done, &before, &last);
    Ok(true)
}

/// Whether forces are those of the problem before.
fn settled(last: &[Found], next: &[Found]) -> bool {
    let same = last.len() == next.len() && last.iter().zip(next).all(|(a, b)| a.0 == b.0);
    let size = next
        .iter()
        .flat_map(|(_, f)| f)
        .fold(0.0_f64, |m, f| m.max(f.abs()));
    let changes = last
        .iter()
        .zip(next)
        .flat_map(|(a, b)| (0..3).map(|q| (a.1[q] - b.1[q]).abs()));
    same && changes.fold(0.0, f64::max) <= NEGLIGIBLE * size
}
