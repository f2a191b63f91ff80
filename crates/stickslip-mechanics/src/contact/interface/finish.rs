//! Residual and tangent of a point from its stencil and what the laws answered.

use super::evaluation::{Batch, Evaluation};
use super::scene::Scene;
use super::surrogate::{gain, surrogate};
use crate::contact::enforcement::{condensed_slope, inverse_of_rows, residual};
use crate::math::{Mat3, dot};

/// Residual and tangent from stencil and response, but for how gap and slips curve: the weights of their second derivatives, if a tangent is wanted and
/// something is carried.
pub(super) fn finish(scene: &Scene, e: &mut Evaluation, batch: &mut Batch) -> Option<[f64; 3]> {
    let interface = scene.interface;
    if interface.holds_exactly() {
        // What it carries follows from how all else accelerates.
        e.response.traction = [0.0; 3];
        e.response.d_gap = [[0.0; 3]; 3];
        add_force(e, [0.0; 3], batch);
        add_rows(e, &[[0.0; 3]; 3], [0.0; 3], batch);
        return None;
    }
    let unknown = interface.unknown() && !scene.wants.initial;
    let r = &e.response;
    let traction = if unknown {
        e.kept.multiplier
    } else {
        r.traction
    };
    if traction == [0.0; 3] && r.traction == [0.0; 3] && r.d_gap == [[0.0; 3]; 3] {
        return None;
    }
    add_force(e, traction, batch);
    let inverse =
        (unknown && scene.wants.tangent).then(|| inverse_of_rows(&e.response.d_multiplier));
    if unknown {
        e.saddle = Some(residual(
            e.kept.multiplier,
            e.response.traction,
            inverse.as_ref(),
        ));
    }
    if !scene.wants.tangent {
        return None;
    }
    // With multipliers as unknowns, what remains after their elimination is K_ll⁻¹ times as stiff.
    let r = &e.response;
    let (d, d_skew) = match &inverse {
        Some(k) => (condensed_slope(k, &r.d_gap), k.map(|k| dot(k, r.d_skew))),
        None => (r.d_gap, r.d_skew),
    };
    add_rows(e, &d, d_skew, batch);
    let n = batch.stencil.n;
    if scene.wants.surrogate {
        let start = batch.surrogate.len();
        e.slots.surrogate = Some(start);
        batch.surrogate.resize(start + n * n, 0.0);
        let rows = batch.stencil.rows.each_ref().map(|row| &row[..n]);
        let gain = gain(&batch.stencil, &batch.rated);
        surrogate(&d, gain, e.area, rows, &mut batch.surrogate[start..]);
    }
    (traction != [0.0; 3]).then(|| traction.map(|t| -e.area * t))
}

/// The force of a traction, and what rounding of coordinates of the size of the stencil's leaves of it.
fn add_force(e: &mut Evaluation, traction: [f64; 3], batch: &mut Batch) {
    let (stencil, area) = (&batch.stencil, e.area);
    let rows = stencil.rows.each_ref().map(|row| &row[..stencil.n]);
    e.slots.force = Some(batch.force.len());
    batch.force.extend((0..stencil.n).map(|k| {
        -area * (traction[0] * rows[0][k] + traction[1] * rows[1][k] + traction[2] * rows[2][k])
    }));
    let slopes = e.response.d_gap.iter().flatten();
    let slope = slopes.fold(0.0_f64, |m, d| m.max(d.abs()));
    // A gap may be off by four roundings of the largest coordinate.
    e.rounding = 4.0 * f64::EPSILON * stencil.coordinate_scale * slope * area;
}

/// Gradients, and the change of the tractions along them: `-d · B (- the skew)`, shape `(3, n)`.
fn add_rows(e: &mut Evaluation, d: &Mat3, d_skew: [f64; 3], batch: &mut Batch) {
    let stencil = &batch.stencil;
    let n = stencil.n;
    let rows = stencil.rows.each_ref().map(|row| &row[..n]);
    e.slots.rows = Some(batch.rows.len());
    for row in rows {
        batch.rows.extend_from_slice(row);
    }
    let slips = match (&batch.rated, &stencil.slip_rows) {
        (rated, _) if !rated[0].is_empty() => Some(rated),
        (_, slips) if !slips[0].is_empty() => Some(slips),
        _ => None,
    };
    let seen: [&[f64]; 3] = match slips {
        Some([a, b]) => [rows[0], &a[..n], &b[..n]],
        None => rows,
    };
    for (d, d_skew) in d.iter().zip(d_skew) {
        let start = batch.change.len();
        batch
            .change
            .extend((0..n).map(|k| -(d[0] * seen[0][k] + d[1] * seen[1][k] + d[2] * seen[2][k])));
        if d_skew != 0.0 {
            for (c, skew) in batch.change[start..].iter_mut().zip(&stencil.skew_row) {
                *c -= d_skew * skew;
            }
        }
    }
}
