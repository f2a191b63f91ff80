use serde::{Deserialize, Serialize};

use super::penalty::stiffness_faults;
use super::rule::{Enforcement, Multipliers, Stiffness};
use crate::contact::law::normal::positive;
use crate::registry::Samples;

/// Augmented Lagrangian: as the perturbed one, with a moderate stiffness whose yielding is removed by updating the multipliers until what is left is
/// below `error` times the elastic approach ([Simo and Laursen 1992](stickslip_base::references::simo_laursen_1992)). The default:
/// the answer does not depend on the stiffness, only the number of updates does. Where an update gains less than a factor of ten the stiffness
/// is raised tenfold, up to 10⁶ times the bodies' own, so that even the wrong one gets there.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct AugmentedLagrangian {
    /// Largest penetration, and largest false slip of a sticking point, relative to the elastic approach `[-]`. Default: 10⁻⁴.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub error: Option<f64>,
    /// Stiffness to start with as a multiple of the bodies' own, `M / h` `[-]`. Default: 1000.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub factor: Option<f64>,
    /// Stiffness to start with per area `[Pa/m]`, instead of `factor`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stiffness: Option<f64>,
}

impl Enforcement for AugmentedLagrangian {
    fn multipliers(&self) -> Multipliers {
        Multipliers::Augmented {
            error: self.error.unwrap_or(1e-4),
        }
    }

    fn normal(&self) -> Stiffness {
        Stiffness::choose(self.stiffness, self.factor, 1000.0)
    }

    fn tangential(&self) -> Stiffness {
        self.normal()
    }

    fn faults(&self) -> Vec<(&'static str, String)> {
        let error = self.error.and_then(|error| positive("error", error));
        let stiffness = stiffness_faults(&[("factor", self.factor), ("stiffness", self.stiffness)]);
        error.into_iter().chain(stiffness).collect()
    }
}

impl Samples for AugmentedLagrangian {
    fn samples() -> Vec<Self> {
        vec![AugmentedLagrangian::default()]
    }
}
