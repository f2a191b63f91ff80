use serde::{Deserialize, Serialize};

use super::law::{NormalLaw, positive};
use crate::math::Slope;
use crate::registry::Samples;

/// Linear compliance: `p = c δ` with the penetration `δ = max(0, -gap)`.
///
/// A physical compliance, as of a thin soft layer; it is not a penalty and does not depend on the mesh.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Linear {
    /// Stiffness per area `[Pa/m]`.
    pub c: f64,
}

impl NormalLaw for Linear {
    fn pressure(&self, gap: f64) -> Option<Slope> {
        Some(if gap < 0.0 {
            Slope {
                value: -self.c * gap,
                slope: -self.c,
            }
        } else {
            Slope::default()
        })
    }

    fn gap(&self, pressure: f64) -> Slope {
        Slope {
            value: -pressure / self.c,
            slope: -1.0 / self.c,
        }
    }

    fn energy(&self, gap: f64) -> f64 {
        0.5 * self.c * gap.min(0.0).powi(2)
    }

    fn faults(&self) -> Vec<(&'static str, String)> {
        positive("c", self.c).into_iter().collect()
    }
}

impl Samples for Linear {
    fn samples() -> Vec<Self> {
        vec![Linear { c: 1e13 }]
    }
}
