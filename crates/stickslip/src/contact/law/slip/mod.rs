//! Slip rules: from limit and motion to shear traction.

mod regularised;
mod return_mapping;

pub use regularised::{Regularised, creep, phi, psi};
pub use return_mapping::ReturnMapping;

/// The tangential motion of a contact point over an increment, in the two directions of its frame.
///
/// The frame of the paper's kinematics is not orthogonal: `skew` is the cosine of the angle between its directions and
/// lengths are measured by `|v|² = v₁² + v₂² + 2 skew v₁ v₂`. It is zero for all other kinematics.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Tangential {
    /// Displacement of the secondary relative to the primary surface since the last accepted state `[m]`.
    pub slip: [f64; 2],
    /// Time since then `[s]`.
    pub dt: f64,
    /// Stiffness of sticking `[Pa/m]`.
    pub stiffness: f64,
    /// Traction carried over: the committed one, or the multiplier `[Pa]`.
    pub base: [f64; 2],
    /// Cosine of the angle between the two directions.
    pub skew: f64,
    /// Velocity `[m/s]` over which a regularised rule is smoothed at least; zero but in a continuation.
    pub smoothing: f64,
    /// Fraction by which a trial traction may exceed the limit and still count as stick; zero but in the first iteration of an
    /// increment, where a point that slid before would otherwise slide or stick by rounding alone.
    pub slack: f64,
}

impl Tangential {
    /// `v₁² + v₂² + 2 skew v₁ v₂`, and its root.
    pub fn length(&self, v: [f64; 2]) -> f64 {
        (v[0] * v[0] + v[1] * v[1] + 2.0 * self.skew * v[0] * v[1])
            .max(0.0)
            .sqrt()
    }

    /// The derivative of `length(v)` with respect to `v`, for a length that is not zero.
    pub fn length_slope(&self, v: [f64; 2], length: f64) -> [f64; 2] {
        [
            (v[0] + self.skew * v[1]) / length,
            (v[1] + self.skew * v[0]) / length,
        ]
    }
}

/// Shear traction on the secondary and its derivatives.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SlipState {
    /// Traction on the secondary `[Pa]`.
    pub traction: [f64; 2],
    /// Derivative with respect to the slip `[Pa/m]`, row: traction.
    pub d_slip: [[f64; 2]; 2],
    /// Derivative with respect to the limit `[-]`.
    pub d_limit: [f64; 2],
    /// Derivative with respect to the skew `[Pa]`.
    pub d_skew: [f64; 2],
    /// Derivative with respect to the smoothing `[Pa s/m]`.
    pub d_smoothing: [f64; 2],
    /// The limit is reached.
    pub sliding: bool,
    /// The irreversible part of the slip `[m]`.
    pub sliding_path: [f64; 2],
}

/// Turns a limit and a motion into a traction.
pub trait SlipRule: Send + Sync {
    /// Traction for a limit `[Pa]` and a motion.
    fn traction(&self, limit: f64, motion: &Tangential) -> SlipState;

    /// The traction of a point that sticks whatever the limit is, with which stick and slip of a point that cannot decide are told apart.
    fn stuck(&self, limit: f64, motion: &Tangential) -> SlipState;

    /// Whether the rule sticks through a stiffness (and so can be made exact by multipliers).
    fn sticks(&self) -> bool;

    /// What is wrong with the parameters, as `(key, message)`; empty if nothing.
    fn faults(&self) -> Vec<(&'static str, String)>;
}

crate::family! {
    /// How stick and slip change hands.
    SlipModel: "slip", dyn SlipRule {
        /// Stick until the limit.
        ReturnMapping(ReturnMapping) = "return-mapping",
        /// The paper's smooth friction.
        Regularised(Regularised) = "regularised",
    }
}

impl Default for SlipModel {
    fn default() -> Self {
        SlipModel::ReturnMapping(ReturnMapping {})
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::registry::Family;

    fn motion(scale: f64, skew: f64, smoothing: f64) -> Tangential {
        Tangential {
            slip: [0.7 * scale, -0.4 * scale],
            dt: 0.5,
            stiffness: 2.0,
            base: [0.11, -0.2],
            skew,
            smoothing,
            slack: 0.0,
        }
    }

    #[test]
    fn derivatives_agree_with_differences() {
        for model in SlipModel::samples() {
            let rule = model.as_dyn();
            for (scale, skew, smoothing) in [
                (0.1, 0.0, 0.0),
                (0.3, 0.4, 0.0),
                (2.0, 0.0, 0.0),
                (3.0, -0.3, 0.0),
                (0.7, 0.2, 1.7),
                (2.0, 0.2, 1.7),
            ] {
                let at = motion(scale, skew, smoothing);
                let limit = 0.9;
                let s = rule.traction(limit, &at);
                let h = 1e-6;
                let close = |a: f64, b: f64| (a - b).abs() < 1e-8 * (1.0 + b.abs());
                for j in 0..2 {
                    let shifted = |h: f64| {
                        let mut m = at;
                        m.slip[j] += h;
                        rule.traction(limit, &m).traction
                    };
                    let (a, b) = (shifted(-h), shifted(h));
                    for i in 0..2 {
                        assert!(
                            close(s.d_slip[i][j], (b[i] - a[i]) / (2.0 * h)),
                            "{model:?} {scale} {skew}"
                        );
                    }
                }
                let (a, b) = (rule.traction(limit - h, &at), rule.traction(limit + h, &at));
                let turned = |h: f64| {
                    rule.traction(
                        limit,
                        &Tangential {
                            skew: skew + h,
                            ..at
                        },
                    )
                };
                let (c, d) = (turned(-h), turned(h));
                let smoothed = |h: f64| {
                    let smoothing = smoothing + h;
                    rule.traction(limit, &Tangential { smoothing, ..at })
                };
                let (e, f) = (smoothed(-h), smoothed(h));
                for i in 0..2 {
                    assert!(close(
                        s.d_limit[i],
                        (b.traction[i] - a.traction[i]) / (2.0 * h)
                    ));
                    assert!(close(
                        s.d_skew[i],
                        (d.traction[i] - c.traction[i]) / (2.0 * h)
                    ));
                    assert!(close(
                        s.d_smoothing[i],
                        (f.traction[i] - e.traction[i]) / (2.0 * h)
                    ));
                }
                assert!(at.length(s.traction) <= limit * (1.0 + 1e-14));
            }
        }
    }
}
