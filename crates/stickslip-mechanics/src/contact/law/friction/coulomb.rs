use serde::{Deserialize, Serialize};

use super::law::{FrictionLaw, FrictionPoint, Limit};
use crate::contact::law::normal::{not_negative, positive};
use crate::registry::Samples;

/// Coulomb friction: limit `μ p`, at most `cap`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Coulomb {
    /// Coefficient of friction μ `[-]`.
    pub mu: f64,
    /// Largest shear traction `[Pa]`, e.g. the shear yield stress. Default: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cap: Option<f64>,
}

impl FrictionLaw for Coulomb {
    fn limit(&self, at: &FrictionPoint) -> Limit {
        Limit {
            value: self.mu * at.pressure,
            d_pressure: self.mu,
            ..Limit::default()
        }
        .capped(self.cap)
    }

    fn frictional(&self) -> bool {
        self.mu > 0.0
    }

    fn faults(&self) -> Vec<(&'static str, String)> {
        let mut faults: Vec<_> = not_negative("mu", self.mu).into_iter().collect();
        faults.extend(self.cap.and_then(|cap| positive("cap", cap)));
        faults
    }
}

impl Samples for Coulomb {
    fn samples() -> Vec<Self> {
        vec![
            Coulomb { mu: 0.3, cap: None },
            Coulomb {
                mu: 0.5,
                cap: Some(1e7),
            },
        ]
    }
}
