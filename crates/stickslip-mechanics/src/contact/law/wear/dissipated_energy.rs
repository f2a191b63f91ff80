use serde::{Deserialize, Serialize};

use super::law::{WearLaw, WearRate, is_zero, rate_fault};
use crate::registry::Samples;

/// Wear in proportion to the energy that friction dissipates ([Fouvry et al. 2003](stickslip_base::references::fouvry_2003)): a surface
/// that slides by `ds` under a shear traction `τ` loses a layer of depth `α τ |ds|`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct DissipatedEnergy {
    /// Volume of the secondary lost over energy dissipated `α` `[1/Pa]`.
    pub coefficient: f64,
    /// The same of the primary `[1/Pa]`, whose surface has a depth of its own. Default: 0, it does not wear.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub primary_coefficient: f64,
}

impl WearLaw for DissipatedEnergy {
    fn rates(&self, _path: f64) -> [WearRate; 2] {
        [self.coefficient, self.primary_coefficient].map(|k| WearRate {
            pressed: 0.0,
            dissipated: k,
        })
    }

    fn faults(&self) -> Vec<(&'static str, String)> {
        let faults = [
            rate_fault("coefficient", self.coefficient),
            rate_fault("primary-coefficient", self.primary_coefficient),
        ];
        let mut faults: Vec<_> = faults.into_iter().flatten().collect();
        if self.coefficient == 0.0 && self.primary_coefficient == 0.0 {
            faults.push((
                "coefficient",
                "one of `coefficient` and `primary-coefficient` must be positive".into(),
            ));
        }
        faults
    }
}

impl Samples for DissipatedEnergy {
    fn samples() -> Vec<Self> {
        vec![DissipatedEnergy {
            coefficient: 3e-14,
            primary_coefficient: 1e-14,
        }]
    }
}
