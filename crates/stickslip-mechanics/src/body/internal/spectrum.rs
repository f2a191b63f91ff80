//! The largest eigenvalue, which bounds the time step of explicit dynamics.

use super::InternalForce;
use crate::math::symmetric_eigen;
use crate::math::vector::dot;

/// Most products with the stiffness.
const MOST_LANCZOS_STEPS: usize = 60;

/// Least number of them, so that a few cells much stiffer than the others have shown themselves.
const LEAST_PRODUCTS: usize = 20;

/// Largest eigenvalue ω² `[1/s²]` of `M⁻¹ K`, on the safe side, with the mass `[kg]` of every dof. Dofs without mass and
/// those marked in `fixed` are left out; zero if none remains.
///
/// The largest Ritz value of the Lanczos method ([`lanczos_1950`](stickslip_base::references::lanczos_1950)) plus the norm of its
/// residual: an eigenvalue lies within that of it, and in practice it is the largest, as the Ritz value grows toward it
/// from below. Vectors are not orthogonalised again: they lose their orthogonality only once a Ritz pair has converged
/// to some `√ε` ([`paige_1980`](stickslip_base::references::paige_1980)), where this has long stopped.
///
/// # Panics
/// If `mass` or `fixed` has another length than the number of dofs.
pub fn largest_eigenvalue(internal: &mut InternalForce, mass: &[f64], fixed: &[bool]) -> f64 {
    let count = internal.dofs.count();
    assert_eq!(mass.len(), count, "length of mass");
    assert_eq!(fixed.len(), count, "length of fixed");
    // M^(-1/2), zero where nothing may move.
    let root: Vec<f64> = mass
        .iter()
        .zip(fixed)
        .map(|(&m, &fixed)| {
            if m > 0.0 && !fixed {
                m.sqrt().recip()
            } else {
                0.0
            }
        })
        .collect();
    let mut v = start(&root);
    let norm = dot(&v, &v).sqrt();
    if norm == 0.0 {
        return 0.0;
    }
    v.iter_mut().for_each(|v| *v /= norm);
    let mut before = vec![0.0; count];
    let (mut moved, mut force) = (before.clone(), before.clone());
    let (mut diagonal, mut beside) = (Vec::new(), Vec::<f64>::new());
    loop {
        for ((m, v), r) in moved.iter_mut().zip(&v).zip(&root) {
            *m = r * v;
        }
        internal.apply(&moved, &mut force);
        let last = beside.last().copied().unwrap_or(0.0);
        for ((f, r), b) in force.iter_mut().zip(&root).zip(&before) {
            *f = *f * r - last * b;
        }
        let alpha = dot(&force, &v);
        for (f, v) in force.iter_mut().zip(&v) {
            *f -= alpha * v;
        }
        let beta = dot(&force, &force).sqrt();
        diagonal.push(alpha);
        let (value, weight) = largest(&diagonal, &beside);
        let residual = beta * weight.abs();
        let steps = diagonal.len();
        // The residual of a Ritz pair is good enough at a hundredth of its value: it lengthens the bound, and a time step goes with the
        // root of that.
        let settled = steps >= LEAST_PRODUCTS && residual <= 0.01 * value;
        // The vectors span all that the start has a part in.
        let exhausted = beta <= 1e-12 * value;
        if settled || exhausted || steps == MOST_LANCZOS_STEPS || beta.is_nan() {
            return value + residual;
        }
        beside.push(beta);
        std::mem::swap(&mut before, &mut v);
        for (v, f) in v.iter_mut().zip(&force) {
            *v = f / beta;
        }
    }
}

/// Irregular numbers, so that the start has a part of every eigenvector; zero where `root` is.
fn start(root: &[f64]) -> Vec<f64> {
    let mut state = 1_u64;
    root.iter()
        .map(|&r| {
            // A linear congruence modulo 2⁶⁴, of which the high bits are good.
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            let number = (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0;
            if r > 0.0 { number } else { 0.0 }
        })
        .collect()
}

/// The largest eigenvalue of a tridiagonal matrix, and the last component of its vector.
fn largest(diagonal: &[f64], beside: &[f64]) -> (f64, f64) {
    let n = diagonal.len();
    let mut rows = vec![vec![0.0; n]; n];
    for i in 0..n {
        rows[i][i] = diagonal[i];
        if i + 1 < n {
            rows[i][i + 1] = beside[i];
            rows[i + 1][i] = beside[i];
        }
    }
    let (values, vectors) = symmetric_eigen(&rows);
    (values[n - 1], vectors[n - 1][n - 1])
}
