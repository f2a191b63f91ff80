use serde::{Deserialize, Serialize};

use super::law::{FrictionLaw, FrictionPoint, Limit};
use crate::contact::law::normal::{not_negative, positive};
use crate::registry::Samples;

/// Stribeck friction: limit `μ p + viscous v` with `μ = μ_k + (μ_s - μ_k) exp(-(v/v_s)^δ)` at the sliding speed v, as
/// surveyed by [Armstrong-Hélouvry et al. 1994](stickslip_base::references::armstrong_1994).
///
/// The exponents in use are δ = 1, an exponential, and δ = 2, a Gaussian, which starts without slope. Below 1 the slope at
/// rest would be infinite. In a quasi-static analysis "speed" is slip per unit of the problem's time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Stribeck {
    /// Coefficient of friction at rest μ_s `[-]`.
    pub r#static: f64,
    /// Coefficient of friction μ_k `[-]` that is left at high speed, without the viscous part.
    pub kinetic: f64,
    /// Stribeck velocity v_s `[m/s]`.
    pub velocity: f64,
    /// Exponent δ `[-]`, at least 1. Default: 1.
    #[serde(default = "one")]
    pub exponent: f64,
    /// Shear traction per speed `[Pa s/m]`, whatever the pressure. Default: 0.
    #[serde(default)]
    pub viscous: f64,
}

fn one() -> f64 {
    1.0
}

impl FrictionLaw for Stribeck {
    fn limit(&self, at: &FrictionPoint) -> Limit {
        let ratio = at.speed / self.velocity;
        let excess = (self.r#static - self.kinetic) * (-ratio.powf(self.exponent)).exp();
        // Far out the power overflows where the exponential has long vanished. At rest the power is one for δ = 1, else zero.
        let d_excess = if excess == 0.0 {
            0.0
        } else {
            -excess * self.exponent / self.velocity * ratio.powf(self.exponent - 1.0)
        };
        let mu = self.kinetic + excess;
        Limit {
            value: mu * at.pressure + self.viscous * at.speed,
            d_pressure: mu,
            d_speed: d_excess * at.pressure + self.viscous,
            ..Limit::default()
        }
    }

    fn frictional(&self) -> bool {
        self.r#static > 0.0 || self.kinetic > 0.0 || self.viscous > 0.0
    }

    fn faults(&self) -> Vec<(&'static str, String)> {
        let exponent = (!(self.exponent >= 1.0 && self.exponent.is_finite())).then(|| {
            let message = format!("must be at least 1, not {}", self.exponent);
            ("exponent", message)
        });
        [
            not_negative("static", self.r#static),
            not_negative("kinetic", self.kinetic),
            positive("velocity", self.velocity),
            exponent,
            not_negative("viscous", self.viscous),
        ]
        .into_iter()
        .flatten()
        .collect()
    }
}

impl Samples for Stribeck {
    fn samples() -> Vec<Self> {
        vec![
            Stribeck {
                r#static: 0.5,
                kinetic: 0.3,
                velocity: 0.1,
                exponent: 1.0,
                viscous: 0.0,
            },
            Stribeck {
                r#static: 0.2,
                kinetic: 0.05,
                velocity: 0.3,
                exponent: 2.0,
                viscous: 4e5,
            },
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::super::ExponentialDecay;
    use super::*;

    fn at(speed: f64) -> FrictionPoint {
        FrictionPoint {
            pressure: 3e6,
            speed,
            ..FrictionPoint::default()
        }
    }

    #[test]
    fn exponent_one_without_drag_is_exponential_decay() {
        let law = Stribeck::samples()[0];
        let same = ExponentialDecay {
            r#static: law.r#static,
            kinetic: law.kinetic,
            decay: 1.0 / law.velocity,
            cap: None,
        };
        for speed in [0.0, 1e-9, 0.03, 0.1, 0.7] {
            let (a, b) = (law.limit(&at(speed)), same.limit(&at(speed)));
            assert!((a.value / b.value - 1.0).abs() < 1e-14, "{speed}");
            assert!((a.d_speed / b.d_speed - 1.0).abs() < 1e-13, "{speed}");
        }
    }

    #[test]
    fn the_gaussian_starts_with_the_viscous_slope() {
        let law = Stribeck::samples()[1];
        assert_eq!(law.limit(&at(0.0)).value, 0.2 * 3e6);
        assert_eq!(law.limit(&at(0.0)).d_speed, law.viscous);
        // at the Stribeck velocity 1/e of the excess is left
        let expected = (0.05 + 0.15 / std::f64::consts::E) * 3e6 + law.viscous * 0.3;
        assert!((law.limit(&at(0.3)).value / expected - 1.0).abs() < 1e-14);
    }

    #[test]
    fn faults_name_the_parameter() {
        let law = Stribeck {
            r#static: -1.0,
            kinetic: -1.0,
            velocity: 0.0,
            exponent: 0.5,
            viscous: f64::NAN,
        };
        let keys: Vec<_> = law.faults().into_iter().map(|(key, _)| key).collect();
        assert_eq!(
            keys,
            ["static", "kinetic", "velocity", "exponent", "viscous"]
        );
    }
}
