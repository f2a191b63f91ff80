use serde::{Deserialize, Serialize};

use super::law::{WearLaw, WearPoint, WearRate, coefficients, is_zero};
use crate::contact::law::normal::positive;
use crate::registry::Samples;

/// Wear after [Archard 1953](stickslip_base::references::archard_1953) with the hardness written out: a surface that slides by `ds` under a pressure `p` loses a layer of
/// depth `K p |ds| / H`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct ArchardHardness {
    /// Archard's coefficient `K` of the secondary `[-]`.
    pub coefficient: f64,
    /// Hardness `H` of the secondary `[Pa]`; a Vickers number times 9.807e6 Pa.
    pub hardness: f64,
    /// The coefficient of the primary `[-]`, whose surface has a depth of its own. Default: 0, it does not wear.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub primary_coefficient: f64,
    /// The hardness of the primary `[Pa]`. Default: that of the secondary.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub primary_hardness: Option<f64>,
}

impl WearLaw for ArchardHardness {
    fn rates(&self, _at: &WearPoint) -> [WearRate; 2] {
        let other = self.primary_hardness.unwrap_or(self.hardness);
        [
            self.coefficient / self.hardness,
            self.primary_coefficient / other,
        ]
        .map(WearRate::pressed)
    }

    fn faults(&self) -> Vec<(&'static str, String)> {
        let mut faults = coefficients([self.coefficient, self.primary_coefficient]);
        faults.extend(positive("hardness", self.hardness));
        let other = self.primary_hardness;
        faults.extend(other.and_then(|h| positive("primary-hardness", h)));
        faults
    }
}

impl Samples for ArchardHardness {
    fn samples() -> Vec<Self> {
        vec![ArchardHardness {
            coefficient: 1e-4,
            hardness: 2e9,
            primary_coefficient: 3e-4,
            primary_hardness: Some(7e9),
        }]
    }
}
