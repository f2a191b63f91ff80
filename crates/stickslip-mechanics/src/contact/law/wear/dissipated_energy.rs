use serde::{Deserialize, Serialize};

use super::law::{WearLaw, WearPoint, WearRate, beyond, coefficients, is_zero, negative};
use crate::registry::Samples;

/// Wear in proportion to the energy that friction dissipates ([Fouvry et al. 2003](stickslip_base::references::fouvry_2003)): a surface
/// that slides by `ds` under a shear traction `τ` loses a layer of depth `α τ |ds|`, once it has taken up the energy that it takes to begin.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct DissipatedEnergy {
    /// Volume of the secondary lost over energy dissipated `α` `[1/Pa]`.
    pub coefficient: f64,
    /// The same of the primary `[1/Pa]`, whose surface has a depth of its own. Default: 0, it does not wear.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub primary_coefficient: f64,
    /// Energy that friction has to dissipate at a point before it wears `[J/m²]`. Default: 0.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub energy: f64,
}

impl WearLaw for DissipatedEnergy {
    fn rates(&self, at: &WearPoint) -> [WearRate; 2] {
        let begun = beyond(at.energy, at.spent, self.energy);
        [self.coefficient, self.primary_coefficient].map(|k| WearRate {
            dissipated: begun * k,
            ..WearRate::default()
        })
    }

    fn fastest(&self) -> [WearRate; 2] {
        [self.coefficient, self.primary_coefficient].map(|k| WearRate {
            dissipated: k,
            ..WearRate::default()
        })
    }

    fn faults(&self) -> Vec<(&'static str, String)> {
        let mut faults = coefficients([self.coefficient, self.primary_coefficient]);
        faults.extend(negative([("energy", self.energy)]));
        faults
    }
}

impl Samples for DissipatedEnergy {
    fn samples() -> Vec<Self> {
        vec![DissipatedEnergy {
            coefficient: 3e-14,
            primary_coefficient: 1e-14,
            energy: 0.0,
        }]
    }
}
