use serde::{Deserialize, Serialize};

use super::law::{WearLaw, WearPoint, WearRate, beyond, coefficients, is_zero, negative};
use crate::registry::Samples;

/// Wear that begins beyond a threshold: a surface that slides by `ds` under a pressure `p` loses a layer of depth `k (p - p₀) |ds|` where the pressure is above `p₀`, once the
/// point has slid a path, and friction has dissipated an energy there.
///
/// Thresholds of path and energy are met in the middle of an increment, and of the cycles that it stands for.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct ArchardThreshold {
    /// Specific wear rate `k` of the secondary `[1/Pa]`.
    pub coefficient: f64,
    /// The same of the primary `[1/Pa]`, whose surface has a depth of its own. Default: 0, it does not wear.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub primary_coefficient: f64,
    /// Pressure `p₀` below which nothing wears `[Pa]`. Default: 0.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub pressure: f64,
    /// Path of a point over which nothing wears at first `[m]`. Default: 0.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub path: f64,
    /// Energy that friction has to dissipate at a point before it wears `[J/m²]`. Default: 0.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub energy: f64,
}

impl WearLaw for ArchardThreshold {
    fn rates(&self, at: &WearPoint) -> [WearRate; 2] {
        let path = beyond(at.path, at.way, self.path);
        let energy = beyond(at.energy, at.spent, self.energy);
        let begun = path.min(energy);
        let (over, slope) = match at.pressure > self.pressure {
            true => {
                let below = self.pressure / at.pressure;
                (1.0 - below, below / at.pressure)
            }
            false => (0.0, 0.0),
        };
        [self.coefficient, self.primary_coefficient].map(|k| WearRate {
            pressed: begun * k * over,
            d_pressure: begun * k * slope,
            ..WearRate::default()
        })
    }

    fn fastest(&self) -> [WearRate; 2] {
        [self.coefficient, self.primary_coefficient].map(WearRate::pressed)
    }

    fn faults(&self) -> Vec<(&'static str, String)> {
        let thresholds = [self.pressure, self.path, self.energy];
        let mut faults = coefficients([self.coefficient, self.primary_coefficient]);
        faults.extend(negative([
            ("pressure", self.pressure),
            ("path", self.path),
            ("energy", self.energy),
        ]));
        if thresholds == [0.0; 3] {
            faults.push((
                "pressure",
                "one of `pressure`, `path` and `energy` must be positive; without a threshold write wear.archard".into(),
            ));
        }
        faults
    }
}

impl Samples for ArchardThreshold {
    fn samples() -> Vec<Self> {
        let pressed = ArchardThreshold {
            coefficient: 2.9e-14,
            primary_coefficient: 1.9e-14,
            pressure: 1.0,
            path: 0.0,
            energy: 0.0,
        };
        vec![
            pressed,
            ArchardThreshold {
                pressure: 0.0,
                path: 0.02,
                ..pressed
            },
            ArchardThreshold {
                pressure: 0.0,
                energy: 0.01,
                ..pressed
            },
        ]
    }
}
