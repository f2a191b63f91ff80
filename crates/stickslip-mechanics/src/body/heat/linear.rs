use super::model::{Spot, TemperatureModel, finite, vec3, vector};
use crate::body::Space;
use crate::math::{dot, sub};
use crate::registry::Samples;

/// A temperature that changes along a straight line: `value + gradient · (x - point)`.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[cfg_attr(feature = "schema", schemars(rename = "LinearTemperature"))]
pub struct Linear {
    /// The temperature `[K]` at `point`.
    pub value: f64,
    /// A point `[length]`, as many components as the space has.
    pub point: Vec<f64>,
    /// Its slope `[K/length]`, as many components as the space has.
    pub gradient: Vec<f64>,
}

impl TemperatureModel for Linear {
    fn at(&self, _space: Space, spot: &Spot) -> Option<f64> {
        let from = sub(spot.x, vec3(&self.point));
        Some(self.value + dot(vec3(&self.gradient), from))
    }

    fn faults(&self, space: Space) -> Vec<(&'static str, String)> {
        let value = finite("value", &[self.value]);
        let point = vector("point", &self.point, space);
        let gradient = vector("gradient", &self.gradient, space);
        [value, point, gradient].into_iter().flatten().collect()
    }
}

impl Samples for Linear {
    fn samples() -> Vec<Self> {
        vec![Linear {
            value: 20.0,
            point: vec![0.0; 3],
            gradient: vec![0.0, 1500.0, 0.0],
        }]
    }
}
