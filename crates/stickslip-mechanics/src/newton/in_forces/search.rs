//! The solution of the friction problem of one pass.

use super::account::{Account, FRICTION_ERROR};
use super::columns::Columns;
use super::linear::Linear;
use super::place::{At, Place};
use crate::friction::{map, solve};
use crate::number::digits;
use crate::system::{Cause, StepFailure};

/// Forces that solve the friction problem of these points, and the displacements under them; `free` are forces by dof, and `alone` the displacements
/// under these alone.
///
/// With columns of passes before, a solution is that of a problem which is nearly the one that is meant. The motion under it shows by how much, and the next
/// one is sought around it: the chord method ([Kelley](stickslip_base::references::kelley_1995), 5.4.1).
pub(super) fn search(
    linear: &mut Linear,
    chosen: &[&Place],
    free: Vec<f64>,
    alone: Vec<f64>,
    columns: &mut Columns,
    account: &mut Account,
) -> Result<(Vec<f64>, Vec<f64>), StepFailure> {
    let points: Vec<At> = chosen.iter().map(|p| p.at).collect();
    columns.begin(linear, chosen)?;
    let mut forces = columns.forces(chosen, linear.dimension());
    let mut du = match forces.iter().any(|r| *r != 0.0) {
        true => linear.under(&free, chosen, &forces)?,
        false => alone,
    };
    let (mut first, mut before) = (None, f64::INFINITY);
    loop {
        let problem = columns.problem(chosen, &forces, &du);
        let error = map::friction_error(&problem, &forces);
        // A thousandth of the first error is good enough for a pass: the next pass begins where this one ends.
        let enough = 1e-3 * *first.get_or_insert(error);
        let done = before.is_finite() && error <= enough.max(FRICTION_ERROR);
        // A solution with kept columns may leave half of the error; otherwise they are made anew.
        let falls = error <= 0.5 * before;
        let solution = (!done && falls).then(|| solve(&problem, Some(&forces), FRICTION_ERROR));
        if let Some(solution) = &solution {
            account.note(problem, &points, solution);
        }
        match solution {
            Some(solution) if solution.solved => {
                forces = solution.forces;
                du = linear.under(&free, chosen, &forces)?;
                before = error;
            }
            None if done => break,
            _ if !columns.are_new(chosen) => {
                columns.renew(linear, chosen)?;
                before = f64::INFINITY;
            }
            // What is left is what its columns are solved to.
            None => break,
            Some(solution) => {
                let sentence = format!(
                    "no solver ends the friction problem of {} points; its error is still {}",
                    chosen.len(),
                    digits(solution.error, 2)
                );
                return Err(linear.attempt.failure(Cause::NotConverged, sentence));
            }
        }
    }
    columns.found(chosen, &forces);
    Ok((forces, du))
}
