use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Enforcement, Multipliers, Stiffness};
use crate::contact::law::normal::positive;
use crate::registry::Samples;

/// Augmented Lagrangian: as the perturbed one, with a moderate stiffness whose yielding is removed by updating the multipliers until what is left is
/// below `error` times the elastic approach ([Simo and Laursen 1992](crate::references::simo_laursen_1992)). The default:
/// the answer does not depend on the stiffness, only the number of updates does.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct AugmentedLagrangian {
    /// Largest penetration, and largest false slip of a sticking point, relative to the elastic approach `[-]`. Default: 10⁻⁴.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub error: Option<f64>,
    /// Stiffness as a multiple of the bodies' own, `M / h` `[-]`. Default: 1000.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub factor: Option<f64>,
}

impl Enforcement for AugmentedLagrangian {
    fn multipliers(&self) -> Multipliers {
        Multipliers::Augmented {
            error: self.error.unwrap_or(1e-4),
        }
    }

    fn normal(&self) -> Stiffness {
        Stiffness::Factor(self.factor.unwrap_or(1000.0))
    }

    fn tangential(&self) -> Stiffness {
        self.normal()
    }

    fn faults(&self) -> Vec<(&'static str, String)> {
        [("error", self.error), ("factor", self.factor)]
            .into_iter()
            .filter_map(|(key, value)| value.and_then(|value| positive(key, value)))
            .collect()
    }
}

impl Samples for AugmentedLagrangian {
    fn samples() -> Vec<Self> {
        vec![AugmentedLagrangian::default()]
    }
}
