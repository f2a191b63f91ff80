//! Axes of a material in space.

use super::check::MaterialError;
use crate::math::{Vec3, add_scaled, cross, dot, norm, normalize};

/// The axes 1, 2 and 3 as rows of a rotation, from directions of the first two: the second is made orthogonal to the first.
///
/// # Errors
/// The two do not span a plane; the finding is about `axes`.
pub fn frame([a, b]: [Vec3; 2]) -> Result<[Vec3; 3], MaterialError> {
    let error = || {
        MaterialError::new(
            "axes",
            format!("axes {a:?} and {b:?} do not span a plane"),
        )
        .help("give two vectors that are neither zero nor parallel, for instance [[1, 0, 0], [0, 1, 0]]")
    };
    let first = normalize(a).ok_or_else(error)?;
    let across = add_scaled(b, -dot(first, b), first);
    let second = normalize(across)
        .filter(|_| norm(across) > 1e-6 * norm(b))
        .ok_or_else(error)?;
    Ok([first, second, cross(first, second)])
}
