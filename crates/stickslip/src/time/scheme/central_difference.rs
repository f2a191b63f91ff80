use serde::{Deserialize, Serialize};

use super::method::{Method, Scheme};
use crate::registry::Samples;

/// Central differences: explicit, second order, with lumped masses and without a matrix. Contact and stick are enforced by
/// springs, whatever `enforcement` says: those of a penalty, or of the stiffness of the bodies' own cells. Equations, and ties but for those by a penalty, hold exactly.
///
/// The increment follows from the highest frequency of the bodies and the stiffness of the contact. `increments.fixed` sets it instead;
/// more than the stable one is refused. Give `increments.largest` to bound it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default, rename_all = "kebab-case")]
pub struct CentralDifference {
    /// Fraction of the stable increment that is used `[-]`. Default: 0.9.
    pub safety: f64,
    /// Increment `[s]` to be reached by raising the masses of cells that are too small for it. What this adds is reported. Default:
    /// masses stay as they are.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mass_scaling: Option<f64>,
}

impl Default for CentralDifference {
    fn default() -> Self {
        CentralDifference {
            safety: 0.9,
            mass_scaling: None,
        }
    }
}

impl Scheme for CentralDifference {
    fn method(&self) -> Method {
        Method::Explicit {
            safety: self.safety,
            mass_scaling: self.mass_scaling,
        }
    }

    fn faults(&self) -> Vec<(&'static str, String)> {
        let mut faults = Vec::new();
        if !(self.safety > 0.0 && self.safety <= 1.0) {
            let message = format!("must be positive and at most 1, not {}", self.safety);
            faults.push(("safety", message));
        }
        if let Some(step) = self.mass_scaling
            && !(step > 0.0 && step.is_finite())
        {
            let message = format!("must be a positive time increment, not {step}");
            faults.push(("mass-scaling", message));
        }
        faults
    }
}

impl Samples for CentralDifference {
    fn samples() -> Vec<Self> {
        vec![
            CentralDifference::default(),
            CentralDifference {
                safety: 0.5,
                mass_scaling: Some(1e-6),
            },
        ]
    }
}
