//! Multipliers that are unknowns, eliminated at their point.
//!
//! Their rows are `Σ - T(gap, Σ) = 0`; in contact and stick these are the `G - Σ/ω = 0` of [Pop 1995](stickslip_base::references::pop_1995), up to a factor. With
//! `K_ll = I - ∂T/∂Σ` what remains is a force with the slope `K_ll⁻¹ ∂T/∂gap`.

use crate::math::{Mat3, dot, identity, inverse};

/// The inverse of `K_ll`. It is 1/ω times the weight in contact, and the unit matrix where open: never singular for a finite ω.
pub fn inverse_of_rows(d_multiplier: &Mat3) -> Mat3 {
    let k_ll: Mat3 = std::array::from_fn(|i| {
        std::array::from_fn(|j| (if i == j { 1.0 } else { 0.0 }) - d_multiplier[i][j])
    });
    inverse(&k_ll).map_or(identity(), |(m, _)| m)
}

/// Residual of the rows, and by how much it moves the multipliers where the displacements stay: `K_ll⁻¹` times that, zero without the inverse.
pub fn residual(
    multiplier: [f64; 3],
    traction: [f64; 3],
    inverse: Option<&Mat3>,
) -> ([f64; 3], [f64; 3]) {
    let rest: [f64; 3] = std::array::from_fn(|q| multiplier[q] - traction[q]);
    (rest, inverse.map_or([0.0; 3], |k| k.map(|k| dot(k, rest))))
}

/// `K_ll⁻¹ ∂T/∂gap`: the slope of the multipliers after their elimination.
pub fn condensed_slope(inverse: &Mat3, d_gap: &Mat3) -> Mat3 {
    inverse.map(|row| {
        std::array::from_fn(|j| row[0] * d_gap[0][j] + row[1] * d_gap[1][j] + row[2] * d_gap[2][j])
    })
}
