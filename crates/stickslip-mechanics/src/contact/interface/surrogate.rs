//! What stands for the tangent of a point in a preconditioner: symmetric and positive semi-definite.

use crate::contact::kinematics::Stencil;
use crate::math::Mat3;

/// The positive semi-definite part of a symmetric 2×2 matrix given as `[a11, a22, a12]`.
fn positive_part([a, b, c]: [f64; 3]) -> [f64; 3] {
    let mean = 0.5 * (a + b);
    let radius = (0.5 * (a - b)).hypot(c);
    let (high, low) = (mean + radius, mean - radius);
    if low >= 0.0 {
        return [a, b, c];
    }
    if high <= 0.0 {
        return [0.0; 3];
    }
    // high · v vᵀ with v vᵀ = (A - low I) / (high - low)
    let s = high / (high - low);
    [s * (a - low), s * (b - low), s * c]
}

/// A symmetric positive semi-definite matrix close to `-Bᵀ d B` times the area. Friction that looks at velocities is stiffer by the `gain`.
pub(super) fn surrogate(d: &Mat3, gain: f64, area: f64, rows: [&[f64]; 3], out: &mut [f64]) {
    let [t11, t22, t12] =
        positive_part([-d[1][1], -d[2][2], -0.5 * (d[1][2] + d[2][1])]).map(|t| gain * t);
    let normal = (-d[0][0]).max(0.0);
    let n = rows[0].len();
    for (k, out) in out.chunks_exact_mut(n).enumerate() {
        let left = [
            area * normal * rows[0][k],
            area * (t11 * rows[1][k] + t12 * rows[2][k]),
            area * (t12 * rows[1][k] + t22 * rows[2][k]),
        ];
        for (l, out) in out.iter_mut().enumerate() {
            *out = left[0] * rows[0][l] + left[1] * rows[1][l] + left[2] * rows[2][l];
        }
    }
}

/// The largest ratio of what friction sees of a displacement to the slip it is.
pub(super) fn gain(stencil: &Stencil, rated: &[Vec<f64>; 2]) -> f64 {
    let pairs = (0..2).flat_map(|i| stencil.rows[i + 1].iter().zip(&rated[i]));
    let ratio = pairs
        .filter(|(row, _)| **row != 0.0)
        .map(|(row, seen)| seen / row);
    let largest = ratio.fold(0.0_f64, f64::max);
    if largest > 0.0 { largest } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_positive_part_is_a_projection() {
        assert_eq!(positive_part([2.0, 1.0, 0.5]), [2.0, 1.0, 0.5]);
        assert_eq!(positive_part([-2.0, -1.0, 0.5]), [0.0; 3]);
        let [a, b, c] = positive_part([1.0, -1.0, 0.0]);
        assert!((a - 1.0).abs() < 1e-15 && b.abs() < 1e-15 && c == 0.0);
    }
}
