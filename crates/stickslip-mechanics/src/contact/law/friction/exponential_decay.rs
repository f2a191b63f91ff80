use serde::{Deserialize, Serialize};

use super::law::{FrictionLaw, FrictionPoint, Limit};
use crate::contact::law::normal::{not_negative, positive};
use crate::registry::Samples;

/// Friction that decays with the sliding speed v from static to kinetic: limit `μ p` with
/// `μ = μ_k + (μ_s - μ_k) exp(-decay v)`, at most `cap`. See [Wriggers 2006](stickslip_base::references::wriggers_2006).
///
/// With `kinetic` above `static` friction grows with speed. In a quasi-static analysis "speed" is slip per unit of the
/// problem's time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct ExponentialDecay {
    /// Coefficient of friction at rest μ_s `[-]`.
    pub r#static: f64,
    /// Coefficient of friction at high speed μ_k `[-]`.
    pub kinetic: f64,
    /// How fast the coefficient changes from one to the other `[s/m]`.
    pub decay: f64,
    /// Largest shear traction `[Pa]`, e.g. the shear yield stress. Default: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cap: Option<f64>,
}

impl FrictionLaw for ExponentialDecay {
    fn limit(&self, at: &FrictionPoint) -> Limit {
        let excess = (self.r#static - self.kinetic) * (-self.decay * at.speed).exp();
        let mu = self.kinetic + excess;
        Limit {
            value: mu * at.pressure,
            d_pressure: mu,
            d_speed: -self.decay * excess * at.pressure,
            ..Limit::default()
        }
        .capped(self.cap)
    }

    fn frictional(&self) -> bool {
        self.r#static > 0.0 || self.kinetic > 0.0
    }

    fn faults(&self) -> Vec<(&'static str, String)> {
        [
            not_negative("static", self.r#static),
            not_negative("kinetic", self.kinetic),
            positive("decay", self.decay),
            self.cap.and_then(|cap| positive("cap", cap)),
        ]
        .into_iter()
        .flatten()
        .collect()
    }
}

impl Samples for ExponentialDecay {
    fn samples() -> Vec<Self> {
        vec![
            ExponentialDecay {
                r#static: 0.5,
                kinetic: 0.3,
                decay: 4.0,
                cap: None,
            },
            ExponentialDecay {
                r#static: 0.2,
                kinetic: 0.6,
                decay: 0.7,
                cap: Some(5e7),
            },
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_of_the_excess_is_left_at_the_half_speed() {
        let law = ExponentialDecay::samples()[0];
        let at = |speed| FrictionPoint {
            pressure: 100.0,
            speed,
            ..FrictionPoint::default()
        };
        assert!((law.limit(&at(0.0)).value - 50.0).abs() < 1e-12);
        assert!((law.limit(&at(2.0_f64.ln() / 4.0)).value - 40.0).abs() < 1e-12);
        assert!((law.limit(&at(1e3)).value - 30.0).abs() < 1e-12);
        // at rest the slope is that to the right: -decay (μ_s - μ_k) p
        assert!((law.limit(&at(0.0)).d_speed + 80.0).abs() < 1e-12);
    }

    #[test]
    fn faults_name_the_parameter() {
        let law = ExponentialDecay {
            r#static: -0.1,
            kinetic: f64::INFINITY,
            decay: 0.0,
            cap: Some(-1.0),
        };
        let keys: Vec<_> = law.faults().into_iter().map(|(key, _)| key).collect();
        assert_eq!(keys, ["static", "kinetic", "decay", "cap"]);
    }
}
