use serde::{Deserialize, Serialize};

use super::circle::smallest_circle;
use super::criterion::{Criterion, OnPlane, factor};
use crate::registry::Samples;

/// [Findley 1959](crate::references::findley_1959): the largest `τ_a + k σ_n,max` of all planes `[Pa]`. The amplitude `τ_a` is the radius of the smallest circle around the path of the shear in the plane,
/// `σ_n,max` the largest stress across it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Findley {
    /// How much the normal stress counts `[-]`: 0.2 to 0.3 for ductile steels.
    pub k: f64,
}

impl Criterion for Findley {
    fn name(&self) -> &'static str {
        "FINDLEY"
    }

    fn on_plane(&self, at: &OnPlane) -> Option<f64> {
        let (_, amplitude) = smallest_circle(&at.shear);
        Some(amplitude + self.k * at.opening())
    }

    fn faults(&self) -> Vec<(&'static str, String)> {
        factor("k", self.k)
    }
}

impl Samples for Findley {
    fn samples() -> Vec<Self> {
        vec![Findley { k: 0.3 }, Findley { k: 0.0 }]
    }
}
