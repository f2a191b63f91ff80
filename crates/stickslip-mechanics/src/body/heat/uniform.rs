use super::model::{Spot, TemperatureModel, finite};
use crate::body::Space;
use crate::registry::Samples;

/// One temperature everywhere.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[cfg_attr(feature = "schema", schemars(rename = "UniformTemperature"))]
pub struct Uniform {
    /// The temperature `[K]`, in any unit whose steps are those of the coefficients of expansion.
    pub value: f64,
}

impl TemperatureModel for Uniform {
    fn at(&self, _space: Space, _spot: &Spot) -> Option<f64> {
        Some(self.value)
    }

    fn faults(&self, _space: Space) -> Vec<(&'static str, String)> {
        finite("value", &[self.value]).into_iter().collect()
    }
}

impl Samples for Uniform {
    fn samples() -> Vec<Self> {
        vec![Uniform { value: 120.0 }]
    }
}
