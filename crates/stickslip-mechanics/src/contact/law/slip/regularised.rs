use serde::{Deserialize, Serialize};

use super::rule::{SlipRule, SlipState, Tangential};
use crate::contact::law::normal::positive;
use crate::friction::ellipse::SlipDirection;
use crate::registry::Samples;

/// The smooth friction of [Pop 1995](stickslip_base::references::pop_1995), eq. (14)-(20): `t = -limit φ_ε(w)` with the sliding velocity
/// `w = slip / dt`.
///
/// On an ellipse `|w|` is the length by which the direction of slip is divided there: `√((h₁ w₁)² + (h₂ w₂)²)` by the associated rule, `√((w₁/h₁)² + (w₂/h₂)²)` against the
/// traction, with half axes `h` over the longer one.
///
/// It never quite sticks: under a steady shear `q` below the limit `T` the interface
/// [creeps](crate::contact::law::slip::creep) at `ε (1 - √(1 - q/T))`, which it reports in the summary. In a quasi-static
/// analysis "velocity" is slip per unit of the problem's time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Regularised {
    /// Velocity ε `[m/s]` above which the full limit acts.
    pub epsilon: f64,
}

/// `ψ_ε(ξ)` of eq. (19), for `ξ ≥ 0`: the potential of [`phi`].
pub fn psi(epsilon: f64, xi: f64) -> f64 {
    if xi <= epsilon {
        let r = xi / epsilon;
        epsilon * r * r * (1.0 - r / 3.0)
    } else {
        xi - epsilon / 3.0
    }
}

/// `|φ_ε(ξ)|` of eq. (20) and its derivative, for `ξ ≥ 0`.
pub fn phi(epsilon: f64, xi: f64) -> (f64, f64) {
    if xi <= epsilon {
        let r = xi / epsilon;
        ((2.0 - r) * r, 2.0 * (1.0 - r) / epsilon)
    } else {
        (1.0, 0.0)
    }
}

/// The velocity `[m/s]` at which an interface creeps under a steady shear that is `ratio` of the limit, 0 to 1:
/// `ε (1 - √(1 - ratio))`, the inverse of [`phi`] below ε, from eq. (20) of [Pop 1995](stickslip_base::references::pop_1995).
///
/// Ratios outside, as rounding may give them, are taken as 0 or 1. Beyond the limit nothing is steady.
pub fn creep(epsilon: f64, ratio: f64) -> f64 {
    let ratio = ratio.clamp(0.0, 1.0);
    // 1 - √(1 - q) without the difference, which would lose the digits of a small ratio
    epsilon * ratio / (1.0 + (1.0 - ratio).sqrt())
}

impl SlipRule for Regularised {
    fn traction(&self, limit: f64, motion: &Tangential) -> SlipState {
        let w = [motion.slip[0] / motion.dt, motion.slip[1] / motion.dt];
        let against = motion.cone(limit).against(w);
        let (speed, along) = (against.size, against.along);
        let epsilon = self.epsilon;
        let (value, slope) = phi(epsilon, speed);
        // φ(w) = f w with f = φ(|w|)/|w|, which is (2 - |w|/ε)/ε at and near rest
        let f = if speed <= epsilon {
            (2.0 - speed / epsilon) / epsilon
        } else {
            value / speed
        };
        let phi_vector = [f * along[0], f * along[1]];
        let rest = -limit * f / motion.dt;
        let mut state = SlipState {
            traction: [-limit * phi_vector[0], -limit * phi_vector[1]],
            d_limit: [-phi_vector[0], -phi_vector[1]],
            d_slip: against.d_along.map(|row| row.map(|d| rest * d)),
            sliding: speed > epsilon,
            sliding_path: motion.slip,
            ..SlipState::default()
        };
        if speed > 0.0 {
            // df/d|w| = (φ' - f)/|w|
            let df = (slope - f) / speed;
            let d_speed = against.size_with_skew;
            for (i, along) in along.iter().enumerate() {
                for (j, toward) in against.toward.iter().enumerate() {
                    state.d_slip[i][j] -= limit * along * df * toward / motion.dt;
                }
                let turned = limit * f * against.along_with_skew[i];
                state.d_skew[i] = -limit * along * df * d_speed - turned;
            }
        }
        state
    }

    /// The rule in series with a spring `k`, by the method of Euler: `t = t* - k dt w(t)` with the trial `t* = base - k slip` and the velocity `w` at which
    /// the interface [creeps](creep) under the shear `t`, which has the direction of `t*`. With `y = √(1 - |t|/T)` and `b = k dt ε` that is
    ///
    /// ```text
    /// T (1 - y²) + b (1 - y) = |t*|      as long as |t*| <= T + b, where |t| = T
    /// ```
    ///
    /// A mass on it that central differences move is stable up to `k dt² = 4 m`, as on the spring alone: one increment is
    /// `t₁ = θ (t₀ + k dt v)`, `v₁ = v - dt t₁/m` with some `0 < θ <= 1`, whose eigenvalues have the product θ and the sum
    /// `1 + θ - θ k dt²/m`, so that both lie in the unit circle where `k dt²/m < 2 + 2/θ`.
    ///
    /// Against the traction it is the same on an ellipse, with sizes for lengths. By the associated rule the velocity of creep is along the normal of the ellipse, see
    /// `Ellipse::nearest`.
    fn sprung(&self, limit: f64, motion: &Tangential) -> SlipState {
        let k = motion.stiffness;
        let trial = [0, 1].map(|i| motion.base[i] - k * motion.slip[i]);
        let give = k * motion.dt * self.epsilon;
        let cone = motion.cone(limit);
        let slid = |traction: [f64; 2]| {
            [0, 1].map(|i| motion.slip[i] + (traction[i] - motion.base[i]) / k)
        };
        if let Some(ellipse) = motion
            .ellipse
            .filter(|e| e.flow == SlipDirection::Associated)
        {
            let near = cone.relieved(&ellipse, trial, -k, give);
            return SlipState {
                traction: near.shear,
                d_slip: near.d_motion,
                d_limit: near.d_limit,
                d_skew: near.d_skew,
                sliding: near.slides,
                sliding_path: slid(near.shear),
            };
        }
        let radial = cone.radial(trial);
        let size = radial.size;
        let left = limit + give - size;
        // Traction over trial, and how the size of the traction changes with that of the trial and with the limit.
        let (ratio, slope, d_limit) = match left >= 0.0 {
            true => {
                let y = 2.0 * left / (give + (give * give + 4.0 * limit * left).sqrt());
                let carried = limit * (1.0 + y);
                let both = 2.0 * limit * y + give;
                let mobilised = size * (1.0 + y) / (carried + give);
                (
                    carried / (carried + give),
                    2.0 * limit * y / both,
                    mobilised * give / both,
                )
            }
            false => (limit / size, 0.0, 1.0),
        };
        let (along, toward) = match size > 0.0 {
            true => (trial.map(|t| t / size), radial.toward),
            false => ([0.0; 2], [0.0; 2]),
        };
        let traction = trial.map(|t| ratio * t);
        let turn = slope - ratio;
        let mut d_slip = [[0.0; 2]; 2];
        for (i, row) in d_slip.iter_mut().enumerate() {
            for (j, d) in row.iter_mut().enumerate() {
                let unit = if i == j { ratio } else { 0.0 };
                *d = -k * (unit + turn * along[i] * toward[j]);
            }
        }
        let d_size = if size > 0.0 {
            radial.size_with_skew
        } else {
            0.0
        };
        SlipState {
            traction,
            d_slip,
            d_limit: along.map(|m| m * d_limit),
            d_skew: along.map(|m| turn * m * d_size),
            sliding: left < 0.0,
            sliding_path: slid(traction),
        }
    }

    fn stuck(&self, limit: f64, motion: &Tangential) -> SlipState {
        // the tangent at rest, φ ≈ 2 w/ε
        let slope = 2.0 / (self.epsilon * motion.dt);
        let against = motion.cone(limit).against(motion.slip);
        let phi = against.along.map(|s| slope * s);
        SlipState {
            traction: phi.map(|phi| -limit * phi),
            d_limit: phi.map(|phi| -phi),
            d_slip: against.d_along.map(|row| row.map(|d| -limit * slope * d)),
            sliding_path: motion.slip,
            ..SlipState::default()
        }
    }

    fn sticks(&self) -> bool {
        false
    }

    fn faults(&self) -> Vec<(&'static str, String)> {
        positive("epsilon", self.epsilon).into_iter().collect()
    }
}

impl Samples for Regularised {
    fn samples() -> Vec<Self> {
        vec![Regularised { epsilon: 1.0 }]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reproduces_the_table() {
        // THEORY A3, ε = 1
        let table = [
            (0.1, 0.19, 0.009_666_7),
            (0.25, 0.4375, 0.057_291_7),
            (0.5, 0.75, 0.208_333_3),
            (0.75, 0.9375, 0.421_875),
            (1.0, 1.0, 0.666_666_7),
            (2.0, 1.0, 1.666_666_7),
        ];
        for (xi, f, p) in table {
            assert!((phi(1.0, xi).0 - f).abs() < 1e-12, "{xi}");
            assert!((psi(1.0, xi) - p).abs() < 5e-8, "{xi}");
            let h = 1e-6;
            let slope = (psi(1.0, xi + h) - psi(1.0, xi - h)) / (2.0 * h);
            assert!((slope - f).abs() < 1e-6);
            assert!(xi - psi(1.0, xi) <= 1.0 / 3.0 + 1e-15);
        }
    }

    /// What is left in the spring creeps away at the velocity that goes with it, in any increment, and nothing is stiffer than the spring.
    #[test]
    fn a_spring_in_series_gives_way_at_the_velocity_of_its_traction() {
        let limit = 3.0;
        for epsilon in [1e-9, 1e-2, 4.0, 1e6] {
            let rule = Regularised { epsilon };
            for dt in [1e-8, 1e-3, 1.0, 1e4] {
                for way in [1e-12, -0.3, 2.0, 50.0] {
                    let motion = Tangential {
                        slip: [0.6 * way, -0.8 * way],
                        dt,
                        stiffness: 7.0,
                        base: [0.3, 0.1],
                        ..Tangential::default()
                    };
                    let state = rule.sprung(limit, &motion);
                    let [a, b] = state.traction;
                    let size = a.hypot(b);
                    let what = format!("{epsilon:e} {dt:e} {way:e}");
                    assert!(size <= limit * (1.0 + 1e-14), "{what}");
                    let path = state.sliding_path;
                    let crept = path[0].hypot(path[1]) / dt;
                    let rounding = 1e-13 * (1.0 + way.abs()) / dt;
                    if state.sliding {
                        assert!(crept >= epsilon - rounding, "{what}: {crept:e}");
                    } else {
                        let due = creep(epsilon, size / limit);
                        // Near the limit the velocity depends on the root of what is left of it.
                        let near = 1e-7 * epsilon;
                        let apart = (crept - due).abs();
                        assert!(apart <= rounding + near, "{what}: {crept:e}, {due:e}");
                    }
                    let along = (a * path[0] + b * path[1]) / (size * path[0].hypot(path[1]));
                    assert!(crept <= rounding || along < -1.0 + 1e-6, "{what}: {along}");
                    let d = state.d_slip;
                    let stiffest = [d[0][0], d[1][1]].map(|d| -d);
                    assert!(
                        stiffest.iter().all(|k| *k >= 0.0 && *k <= 7.0 + 1e-12),
                        "{what}"
                    );
                }
            }
        }
    }

    #[test]
    fn creep_is_where_the_shear_is_carried() {
        for epsilon in [1e-6, 0.05, 3.0] {
            for ratio in [0.0, 1e-12, 0.1, 0.5, 0.75, 0.999, 1.0] {
                let v = creep(epsilon, ratio);
                assert!((phi(epsilon, v).0 - ratio).abs() <= 4e-16, "{ratio}");
            }
            assert_eq!(creep(epsilon, 1.0), epsilon);
            assert_eq!(creep(epsilon, 1.0 + 1e-15), epsilon);
            // half of the ratio to first order, with all digits
            assert!((creep(epsilon, 1e-14) / (0.5e-14 * epsilon) - 1.0).abs() < 1e-13);
        }
        // VERIFICATION S7: a block on an incline of 20° with μ = 0.5, ε = 0.05
        let ratio = 20.0_f64.to_radians().tan() / 0.5;
        assert!((creep(0.05, ratio) - 0.023_920_336_88).abs() < 5e-12);
    }
}
