//! The linear system of one iteration in the forces along gaps and slips, where these do not curve.
//!
//! With `K = Bᵀ C` for the tangent of the interfaces forces at the dofs are `Bᵀ q`, and `(I + K W) y = -K W b` is
//!
//! ```text
//! (I + C W Bᵀ) q = -C W b
//! ```
//!
//! whose matrix is that of the preconditioner: a Krylov step takes one product with the compliance, where one in the forces at the dofs takes another to come
//! from there to the gaps.

use super::gap_matrix::Placed;
use super::preconditioner::Preconditioner;
use super::rows::GapRows;
use super::tangent::{Precision, Tangent};
use crate::linear::{GmresReport, GmresSettings, gmres_inexact};

/// Finds the forces at the active dofs from the displacements `u` that they have without; `None` where gaps curve, bodies float, or the factor is of other
/// points. `kept` has the products with the compliance if they were made before.
pub(super) fn solve(
    tangent: &Tangent,
    preconditioner: &Preconditioner,
    gaps: GapRows,
    kept: Option<&Placed>,
    u: &[f64],
    precision: Precision,
    settings: GmresSettings,
) -> Option<(Vec<f64>, GmresReport)> {
    let GapRows { rows, count } = gaps;
    if !straight(tangent) || !preconditioner.is_of(rows, count) {
        return None;
    }
    // -Bᵀ q
    let against = |q: &[f64]| {
        let mut y = vec![0.0; tangent.active.len()];
        rows.iter().for_each(|rows| rows.subtract_forces(q, &mut y));
        y
    };
    let mut known = vec![0.0; count];
    rows.iter()
        .for_each(|rows| rows.apply_changes(u, &mut known));
    let mut q = vec![0.0; count];
    let report = gmres_inexact(
        &mut |v, out, error| {
            let precision = precision.within(error);
            if let Some(kept) = kept {
                return kept.apply(v, out, precision);
            }
            let u = tangent.apply_compliance(&against(v), precision);
            rows.iter().for_each(|rows| rows.apply_changes(&u, out));
            out.iter_mut().zip(v).for_each(|(out, v)| *out = v - *out);
        },
        &mut |v| preconditioner.solve(v),
        &known,
        &mut q,
        settings,
    );
    Some((against(&q), report))
}

/// Whether there is nothing in the tangent but gaps and slips that do not curve.
pub(super) fn straight(tangent: &Tangent) -> bool {
    tangent.springs.is_empty() && tangent.blocks.iter().all(|b| b.block.hessian.is_empty())
}
