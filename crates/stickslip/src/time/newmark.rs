//! The kernel of the implicit schemes: velocities and accelerations from displacements.

use super::scheme::Alphas;
use crate::system::State;

/// Newmark's relations over one increment. Dofs that are `plain` (prescribed, or without mass) have the mean velocity of the increment
/// instead: they have no inertia that could tell them where they are going, and Newmark's relations would make them swing.
#[derive(Debug, Clone, Copy)]
pub struct Increment<'a> {
    /// Parameters.
    pub alphas: Alphas,
    /// Length `[s]`.
    pub dt: f64,
    /// State at the start, with velocities and accelerations.
    pub from: &'a State,
    /// By dof.
    pub plain: &'a [bool],
}

impl Increment<'_> {
    /// Displacements if accelerations stay as they are.
    pub fn predict(&self) -> Vec<f64> {
        let State { u, v, a, .. } = self.from;
        let dt = self.dt;
        (0..u.len())
            .map(|i| {
                let turn = if self.plain[i] {
                    0.0
                } else {
                    0.5 * dt * dt * a[i]
                };
                u[i] + (dt * v[i] + turn)
            })
            .collect()
    }

    /// Velocities and accelerations that go with displacements `u` at the end.
    pub fn motion(&self, u: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let Alphas { beta, gamma, .. } = self.alphas;
        let dt = self.dt;
        let n = u.len();
        let (mut v1, mut a1) = (vec![0.0; n], vec![0.0; n]);
        for i in 0..n {
            let (u0, v0, a0) = (self.from.u[i], self.from.v[i], self.from.a[i]);
            let moved = u[i] - u0;
            if self.plain[i] {
                v1[i] = moved / dt;
                a1[i] = (v1[i] - v0) / dt;
            } else {
                a1[i] = (moved - dt * v0) / (beta * dt * dt) - (0.5 / beta - 1.0) * a0;
                v1[i] = v0 + dt * ((1.0 - gamma) * a0 + gamma * a1[i]);
            }
        }
        (v1, a1)
    }

    /// `dt v₁ = gain (u₁ - u₀) + shift`, dof by dof.
    pub fn rate(&self) -> (Vec<f64>, Vec<f64>) {
        let Alphas { beta, gamma, .. } = self.alphas;
        let dt = self.dt;
        let n = self.plain.len();
        let (mut gain, mut shift) = (vec![1.0; n], vec![0.0; n]);
        for i in (0..n).filter(|&i| !self.plain[i]) {
            gain[i] = gamma / beta;
            let (v0, a0) = (self.from.v[i], self.from.a[i]);
            shift[i] = dt * ((1.0 - gamma / beta) * v0 + dt * (1.0 - 0.5 * gamma / beta) * a0);
        }
        (gain, shift)
    }
}

/// A number that stands for the error of displacements over one increment: `|β - 1/6| dt² (a₁ - a₀)` is what the Taylor series and Newmark's
/// relations differ by if accelerations vary linearly ([`zienkiewicz_xie_1991`](crate::references::zienkiewicz_xie_1991)).
/// At β = 1/6 the factor of the trapezoidal rule is used.
pub fn error_factor(beta: f64) -> f64 {
    let factor = (beta - 1.0 / 6.0).abs();
    if factor < 1e-3 { 1.0 / 12.0 } else { factor }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::registry::Family;
    use crate::time::scheme::{Method, SchemeModel};

    #[test]
    fn rate_and_motion_agree() {
        let from = State {
            t: 0.0,
            u: vec![0.1, -0.2],
            v: vec![3.0, 4.0],
            a: vec![-5.0, 6.0],
        };
        for model in SchemeModel::samples() {
            let Method::Implicit(alphas) = model.as_dyn().method() else {
                continue;
            };
            let increment = Increment {
                alphas,
                dt: 0.01,
                from: &from,
                plain: &[false, true],
            };
            let u = [0.15, -0.17];
            let (v, _) = increment.motion(&u);
            let (gain, shift) = increment.rate();
            for i in 0..2 {
                let rate = gain[i] * (u[i] - from.u[i]) + shift[i];
                assert!((rate - 0.01 * v[i]).abs() < 1e-14, "{model:?}");
            }
        }
    }

    #[test]
    fn a_constant_acceleration_is_exact() {
        let from = State {
            t: 0.0,
            u: vec![1.0],
            v: vec![2.0],
            a: vec![-3.0],
        };
        let increment = Increment {
            alphas: Alphas {
                alpha_m: 0.0,
                alpha_f: 0.0,
                beta: 0.25,
                gamma: 0.5,
            },
            dt: 0.1,
            from: &from,
            plain: &[false],
        };
        let u = increment.predict();
        let (v, a) = increment.motion(&u);
        assert!((u[0] - (1.0 + 0.2 - 0.015)).abs() < 1e-15);
        assert!((v[0] - 1.7).abs() < 1e-12 && (a[0] + 3.0).abs() < 1e-11);
    }
}
