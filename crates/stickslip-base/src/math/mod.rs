//! Small vectors and matrices. Plain arrays: a point is `[f64; 3]` in 2D as well, with `z = 0`.

mod eigen;
mod mat3;
mod nonnegative;
mod vec3;
pub mod vector;

pub use eigen::symmetric_eigen;
pub use mat3::{
    Mat3, determinant, identity, inverse, mat_vec, outer, polar_rotation, rotation, transpose_vec,
};
pub use nonnegative::rest_of_nonnegative;
pub use vec3::{Vec3, add, add_scaled, angle, cross, distance, dot, norm, normalize, scale, sub};

/// A value and its derivative with respect to the one argument of the function it came from.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Slope {
    /// The value.
    pub value: f64,
    /// Its derivative.
    pub slope: f64,
}

/// The larger of two numbers, and no number where one of them is none: [`f64::max`] forgets it, and what is wrong would look right.
#[inline]
pub fn larger(a: f64, b: f64) -> f64 {
    match a.is_nan() || b.is_nan() {
        true => f64::NAN,
        false => a.max(b),
    }
}

#[cfg(test)]
mod tests {
    use super::larger;

    #[test]
    fn what_is_no_number_is_not_forgotten() {
        assert_eq!(larger(1.0, 2.0), 2.0);
        assert!(larger(f64::NAN, 2.0).is_nan() && larger(1.0, f64::NAN).is_nan());
    }
}
