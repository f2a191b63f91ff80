//! The natural map, whose zeros are the solutions, and its derivative.

use super::problem::{FrictionProblem, PointLaw};
use super::small::norm;

/// What a point does in the eyes of the natural map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Projected {
    /// Forces that the laws allow next to `r - ρ u`.
    pub forces: [f64; 3],
    /// Their derivative `A` by `r - ρ u`, row by row in the first `d²` entries; zero for a point that is open.
    pub derivative: [f64; 9],
}

/// The nearest that the laws allow to a trial force `z = r - ρ u`: no tension, and shear within the limit that belongs to the pressure *of the trial*
/// ([Alart and Curnier](stickslip_base::references::alart_curnier_1991), in the form of Jean and Moreau).
pub(crate) fn project(d: usize, law: &PointLaw, z: &[f64]) -> Projected {
    let (mut forces, mut derivative) = ([0.0; 3], [0.0; 9]);
    let pressed = z[0].max(0.0);
    let (limit, slope) = law.limit(pressed);
    forces[0] = pressed;
    if z[0] > 0.0 {
        derivative[0] = 1.0;
    }
    let cone = law.cone(pressed);
    let trial = [z[1], z.get(2).copied().unwrap_or(0.0)];
    let shear = cone.size(trial);
    if shear <= limit {
        for a in 1..d {
            forces[a] = z[a];
            derivative[a * (d + 1)] = if limit > 0.0 { 1.0 } else { 0.0 };
        }
        return Projected { forces, derivative };
    }
    let slips = cone.returned(trial, 1.0);
    for a in 1..d {
        forces[a] = slips.shear[a - 1];
        for b in 1..d {
            derivative[a * d + b] = slips.d_motion[a - 1][b - 1];
        }
        if z[0] > 0.0 {
            derivative[a * d] = slope * slips.d_limit[a - 1];
        }
    }
    Projected { forces, derivative }
}

/// The natural map `(r - P(r - ρ u)) / ρ` with `u = W r + q`, a motion; `stiffness` has the `ρ` of each point.
pub fn natural_map(problem: &FrictionProblem, stiffness: &[f64], forces: &[f64]) -> Vec<f64> {
    residual(problem, stiffness, forces, &problem.motion(forces))
}

/// The natural map for a motion that is known.
pub(super) fn residual(
    problem: &FrictionProblem,
    stiffness: &[f64],
    forces: &[f64],
    motion: &[f64],
) -> Vec<f64> {
    let d = problem.dimension;
    let mut out = Vec::with_capacity(forces.len());
    for (k, law) in problem.laws.iter().enumerate() {
        let rho = stiffness[k];
        let (r, u) = (&forces[k * d..(k + 1) * d], &motion[k * d..(k + 1) * d]);
        let projected = project(d, law, &trial(r, u, rho));
        out.extend((0..d).map(|a| (r[a] - projected.forces[a]) / rho));
    }
    out
}

/// The trial force of a point.
pub(super) fn trial(r: &[f64], u: &[f64], rho: f64) -> [f64; 3] {
    let mut z = [0.0; 3];
    for ((z, r), u) in z.iter_mut().zip(r).zip(u) {
        *z = r - rho * u;
    }
    z
}

/// How far forces are from a solution: the norm of the [natural map](natural_map) relative to that of the free motion.
pub fn friction_error(problem: &FrictionProblem, forces: &[f64]) -> f64 {
    let map = natural_map(problem, &problem.stiffness(), forces);
    norm(&map) / norm(&problem.free).max(f64::MIN_POSITIVE)
}
