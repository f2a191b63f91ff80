//! The foot of a point on an obstacle, and what every shape must tell of it.

use super::chart::Chart;
use crate::math::{Mat3, Vec3};

/// The foot of a point on a shape, in the frame of the shape.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Foot {
    /// Signed distance, positive outside the obstacle `[m]`.
    pub gap: f64,
    /// Unit normal, out of the obstacle.
    pub normal: Vec3,
    /// The foot itself.
    pub point: Vec3,
    /// `∂foot/∂point`, symmetric.
    pub slope: Mat3,
    /// `∂normal/∂point`, symmetric `[1/m]`.
    pub curvature: Mat3,
}

/// A rigid shape.
pub trait Shape: Send + Sync {
    /// The foot of `x`, or `None` where it is not unique (a centre).
    fn foot(&self, x: Vec3) -> Option<Foot>;

    /// `∂(slope · v)/∂x` at `x` for a constant vector `v` [1/m]: zero for flat shapes.
    fn slope_derivative(&self, x: Vec3, v: Vec3) -> Mat3;

    /// The radius of its curvature `[m]`, the same everywhere: positive where the shape is convex, negative in a bore or socket, zero for flat
    /// shapes.
    fn radius(&self) -> f64 {
        0.0
    }

    /// Numbered places on it, about `spacing` apart `[m]`, in a space of dimension `dim`.
    fn chart(&self, dim: usize, spacing: f64) -> Chart;

    /// What is wrong with the parameters in a space of dimension `dim`, as `(key, message)`.
    fn faults(&self, dim: usize) -> Vec<(&'static str, String)>;
}

/// A point given by two numbers in a plane problem, three in space.
pub(crate) fn to_vec3(v: &[f64]) -> Vec3 {
    std::array::from_fn(|i| v.get(i).copied().unwrap_or(0.0))
}

/// Finding for a vector of the wrong length or with bad numbers.
pub(crate) fn vector_fault(
    key: &'static str,
    v: &[f64],
    dim: usize,
) -> Option<(&'static str, String)> {
    if v.len() != dim {
        return Some((
            key,
            format!(
                "has {} components, but the problem has {dim} dimensions",
                v.len()
            ),
        ));
    }
    v.iter()
        .any(|x| !x.is_finite())
        .then(|| (key, "has a number that is not finite".into()))
}

/// Foot on a sphere or cylinder: `q` projects on the cross-section.
pub(super) fn radial_foot(
    x: Vec3,
    centre: Vec3,
    radius: f64,
    inside: bool,
    q: &Mat3,
) -> Option<Foot> {
    use crate::math::{add_scaled, mat_vec, norm, scale, sub};
    let r = mat_vec(q, sub(x, centre));
    let rho = norm(r);
    // A NaN has no foot either.
    if rho.is_nan() || rho <= 1e-12 * radius {
        return None;
    }
    let e = scale(1.0 / rho, r);
    let sign = if inside { -1.0 } else { 1.0 };
    let tangent: Mat3 = std::array::from_fn(|i| std::array::from_fn(|j| q[i][j] - e[i] * e[j]));
    let slope = std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            let unit = if i == j { 1.0 } else { 0.0 };
            (unit - q[i][j]) + radius / rho * tangent[i][j]
        })
    });
    Some(Foot {
        gap: sign * (rho - radius),
        normal: scale(sign, e),
        point: add_scaled(x, radius - rho, e),
        slope,
        curvature: tangent.map(|row| row.map(|t| sign * t / rho)),
    })
}

/// `∂(slope v)/∂x` of [`radial_foot`].
pub(super) fn radial_slope_derivative(
    x: Vec3,
    centre: Vec3,
    radius: f64,
    q: &Mat3,
    v: Vec3,
) -> Mat3 {
    use crate::math::{dot, mat_vec, norm, scale, sub};
    let r = mat_vec(q, sub(x, centre));
    let rho = norm(r);
    let e = scale(1.0 / rho, r);
    let tangent: Mat3 = std::array::from_fn(|i| std::array::from_fn(|j| q[i][j] - e[i] * e[j]));
    let pv = mat_vec(&tangent, v);
    let ev = dot(e, v);
    std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            -radius / (rho * rho) * (pv[i] * e[j] + e[i] * pv[j] + ev * tangent[i][j])
        })
    })
}
