//! A mode along which a motion begins, and how much of it there is in the motion later.
//!
//! The motion about the state of steady sliding is compared with `Re(c φ)` and velocities with `Re(c λ φ)`: the complex amplitude `c` that fits both best, in the
//! norm of the mass, grows as `e^(λ t)` as long as the motion is small, whatever else is in it.

use std::f64::consts::{PI, TAU};

use serde::Serialize;

use crate::math::vector::dot;
use crate::system::{State, Tally};

/// A mode along which a step begins.
#[derive(Debug, Clone, Default, PartialEq, crate::keep::Keep)]
pub struct Kick {
    /// Index of the step.
    pub step: usize,
    /// Growth rate and angular frequency `[1/s]`.
    pub value: [f64; 2],
    /// Displacements about which it vibrates `[m]`.
    pub about: Vec<f64>,
    /// The mode, real and imaginary part, the largest displacement of a point one.
    pub shape: [Vec<f64>; 2],
    /// Mass times the mode; empty before the masses are known.
    pub images: [Vec<f64>; 2],
    /// Amplitude at the start `[m]`.
    pub amplitude: f64,
    /// How much of it there was in the last state.
    pub last: Share,
    /// What is known of its growth.
    pub course: Course,
}

/// How a mode grows while the motion is small: until points stick or open that did not at the start.
#[derive(Debug, Clone, Copy, Default, PartialEq, crate::keep::Keep)]
pub struct Course {
    /// Time of the start `[s]`.
    start: f64,
    /// Points that stick and that are open in the first increment, and whether that has changed.
    status: [usize; 2],
    over: bool,
    /// Time that has passed, and by what angle the phase has turned.
    passed: f64,
    turned: f64,
    /// Sums over increments: one, time, its square, the logarithm of the amplitude, and that by the time.
    sums: [f64; 5],
}

/// Growth and frequency of a motion that began along a mode, and those of the eigenvalue.
#[derive(Debug, Clone, Default, PartialEq, Serialize, crate::keep::Keep)]
#[serde(rename_all = "kebab-case")]
pub struct Growth {
    /// Name of the step.
    pub step: String,
    /// Number of the step, from 1.
    pub number: usize,
    /// Start of the step.
    pub start: f64,
    /// Amplitude at the start, and at the end of the step.
    pub amplitudes: [f64; 2],
    /// Growth rate of the eigenvalue `[1/time]`.
    pub growth: f64,
    /// The one that was measured, of the logarithm of the amplitude by least squares, while as many points stuck and were open as at the start.
    pub measured_growth: f64,
    /// Frequency of the eigenvalue.
    pub frequency: f64,
    /// The one that was measured.
    pub measured_frequency: f64,
    /// Cycles over which that was done.
    pub cycles: f64,
}

/// How much of a mode is in a motion.
#[derive(Debug, Clone, Copy, Default, PartialEq, crate::keep::Keep)]
pub struct Share {
    /// Largest displacement of a point that the mode has at this amplitude `[m]`.
    pub amplitude: f64,
    /// Phase `[rad]`.
    pub phase: f64,
    /// Part of the kinetic energy that is not of the mode.
    pub rest: f64,
}

impl Course {
    /// One that begins at a time.
    pub(crate) fn at(start: f64) -> Self {
        Course {
            start,
            ..Course::default()
        }
    }
}

impl Kick {
    /// `λ φ`, real and imaginary part, of a pair of numbers that stand for `φ`.
    fn turned(&self, [re, im]: [f64; 2]) -> [f64; 2] {
        let [growth, omega] = self.value;
        [growth * re - omega * im, growth * im + omega * re]
    }

    /// Displaces a state along the mode, and gives it the velocity of the mode.
    pub(crate) fn apply(&self, state: &mut State) {
        state.v.resize(state.u.len(), 0.0);
        let moved = state.u.iter_mut().zip(&mut state.v);
        for (i, (u, v)) in moved.enumerate() {
            let mode = [0, 1].map(|k| self.shape[k][i]);
            *u += self.amplitude * mode[0];
            *v += self.amplitude * self.turned(mode)[0];
        }
    }

    /// The best fit of a motion with this kinetic energy.
    pub fn share(&self, state: &State, kinetic: f64) -> Share {
        if state.v.is_empty() || self.images[0].is_empty() {
            return Share::default();
        }
        let x: Vec<f64> = state
            .u
            .iter()
            .zip(&self.about)
            .map(|(u, a)| u - a)
            .collect();
        let [growth, omega] = self.value;
        let square = growth * growth + omega * omega;
        let on = |y: &[f64]| [0, 1].map(|k| dot(y, &self.images[k]));
        let [x, v] = [on(&x), on(&state.v)];
        let [re, im] = &self.shape;
        let mass = [
            dot(re, &self.images[0]),
            dot(re, &self.images[1]),
            dot(im, &self.images[1]),
        ];
        // Of numbers p, q: the motion p φ_r + q φ_i.
        let product = |[a, b]: [f64; 2], [c, d]: [f64; 2]| {
            a * c * mass[0] + (a * d + b * c) * mass[1] + b * d * mass[2]
        };
        let along = |[a, b]: [f64; 2], on: [f64; 2]| a * on[0] + b * on[1];
        // Displacements and velocities with c = 1 and c = i: Re(φ), Re(i φ), Re(λ φ), Re(i λ φ).
        let shown = [[1.0, 0.0], [0.0, -1.0]];
        let speeds = [[growth, -omega], [-omega, -growth]];
        let gram = |i: usize, j: usize| {
            square * product(shown[i], shown[j]) + product(speeds[i], speeds[j])
        };
        let right = [0, 1].map(|i| square * along(shown[i], x) + along(speeds[i], v));
        let [a, b, d] = [gram(0, 0), gram(0, 1), gram(1, 1)];
        let determinant = a * d - b * b;
        if determinant <= 0.0 || !determinant.is_finite() {
            return Share::default();
        }
        let c = [
            (d * right[0] - b * right[1]) / determinant,
            (a * right[1] - b * right[0]) / determinant,
        ];
        let fit = [0, 1].map(|k| c[0] * speeds[0][k] + c[1] * speeds[1][k]);
        let whole = 2.0 * kinetic;
        let open = whole - 2.0 * along(fit, v) + product(fit, fit);
        Share {
            amplitude: c[0].hypot(c[1]),
            phase: c[1].atan2(c[0]),
            rest: if whole > 0.0 {
                (open / whole).max(0.0)
            } else {
                0.0
            },
        }
    }
}

impl Kick {
    /// Looks at an accepted increment.
    pub(crate) fn follow(&mut self, state: &State, kinetic: f64, tally: Tally) {
        let before = self.last.phase;
        self.last = self.share(state, kinetic);
        let course = &mut self.course;
        let status = [tally.stick, tally.open];
        if course.sums[0] == 0.0 {
            course.status = status;
        }
        course.over |= status != course.status;
        if course.over || self.last.amplitude <= 0.0 {
            return;
        }
        let (t, log) = (state.t - course.start, self.last.amplitude.ln());
        let turned = self.last.phase - before;
        // Of increments shorter than half a cycle.
        course.turned += turned - TAU * ((turned + PI) / TAU).floor();
        course.passed = t;
        let parts = [1.0, t, t * t, log, t * log];
        course.sums.iter_mut().zip(parts).for_each(|(s, p)| *s += p);
    }

    /// What has come of it.
    pub(crate) fn growth(&self, step: &str) -> Growth {
        let Course {
            start,
            passed,
            turned,
            sums: [n, t, tt, log, t_log],
            ..
        } = self.course;
        let spread = n * tt - t * t;
        let over = |a: f64, b: f64| if b > 0.0 { a / b } else { 0.0 };
        Growth {
            step: step.into(),
            number: self.step + 1,
            start,
            amplitudes: [self.amplitude, self.last.amplitude],
            growth: self.value[0],
            measured_growth: over(n * t_log - t * log, spread),
            frequency: self.value[1] / TAU,
            measured_frequency: over(turned, TAU * passed),
            cycles: turned / TAU,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mode_is_found_in_its_own_motion() {
        let value = [0.3, 5.0];
        let shape = [vec![1.0, 0.2, -0.3], vec![0.0, 0.5, 0.1]];
        let masses = [2.0, 1.0, 0.5];
        let images =
            [0, 1].map(|k: usize| shape[k].iter().zip(masses).map(|(x, m)| x * m).collect());
        let kick = Kick {
            value,
            about: vec![7.0, 8.0, 9.0],
            shape,
            images,
            amplitude: 1e-3,
            ..Kick::default()
        };
        let mut state = State {
            u: kick.about.clone(),
            ..State::default()
        };
        kick.apply(&mut state);
        let kinetic: f64 = state
            .v
            .iter()
            .zip(masses)
            .map(|(v, m)| 0.5 * m * v * v)
            .sum();
        let share = kick.share(&state, kinetic);
        assert!((share.amplitude - 1e-3).abs() < 1e-15 && share.phase.abs() < 1e-10);
        assert!(share.rest < 1e-10, "{:e}", share.rest);
        // A quarter of a cycle later, and something else beside it.
        let other = Kick {
            shape: [
                kick.shape[1].iter().map(|x| -x).collect(),
                kick.shape[0].clone(),
            ],
            ..kick.clone()
        };
        let mut state = State {
            u: kick.about.clone(),
            ..State::default()
        };
        other.apply(&mut state);
        let share = kick.share(&state, kinetic);
        assert!(
            (share.phase - std::f64::consts::FRAC_PI_2).abs() < 1e-9,
            "{share:?}"
        );
    }
}
