//! Rigid motion: the motions of bodies without strain, what holds them, and what pushes them.
//!
//! `modes.rs` has the basis. `held.rs` asks what supports, springs, couplings and contact resist, `free_bodies.rs` what they leave free, `drivers.rs` which loads and supports
//! drive that, `anchors.rs` where supports hold a body, and `nearest.rs` which motion without strain comes nearest to what points did. All of them find unconstrained motions by
//! [`null_space`].

pub(crate) mod anchors;
pub(crate) mod astray;
pub(crate) mod balance;
pub(crate) mod closing;
pub(crate) mod drivers;
pub(crate) mod floating;
pub(crate) mod free_bodies;
pub(crate) mod held;
pub(crate) mod modes;
pub(crate) mod nearest;

use crate::math::symmetric_eigen;

/// Directions along which a symmetric matrix `gram` resists no more than a `part` of what it does at most, and that bound.
pub(crate) fn null_space(gram: &[Vec<f64>], part: f64) -> (Vec<Vec<f64>>, f64) {
    let (values, vectors) = symmetric_eigen(gram);
    let largest = values.last().copied().unwrap_or(0.0);
    let bound = part * largest.max(f64::MIN_POSITIVE);
    (columns(&values, &vectors, bound), bound)
}

/// Directions along which it resists no more than a bound.
pub(crate) fn null_space_below(gram: &[Vec<f64>], bound: f64) -> Vec<Vec<f64>> {
    let (values, vectors) = symmetric_eigen(gram);
    columns(&values, &vectors, bound)
}

fn columns(values: &[f64], vectors: &[Vec<f64>], bound: f64) -> Vec<Vec<f64>> {
    let free = (0..values.len()).filter(|&k| values[k] <= bound);
    let column = |k: usize| vectors.iter().map(|row| row[k]).collect();
    free.map(column).collect()
}
