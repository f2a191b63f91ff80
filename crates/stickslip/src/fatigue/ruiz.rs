use serde::{Deserialize, Serialize};

use super::criterion::{Criterion, Rubbed};
use crate::registry::Samples;

/// The second parameter named after Ruiz (see [Ruiz, Boddington and Chen 1984](crate::references::ruiz_1984)), `σ_T τ δ` `[Pa² m]`: the largest tension along the surface in the direction of the slip, times the
/// largest shear traction, times the slip from end to end of a cycle. At points of interfaces, on both sides.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Ruiz {}

/// The first parameter named after Ruiz (see [Ruiz, Boddington and Chen 1984](crate::references::ruiz_1984)), `τ δ` `[J/m²]`: the largest shear traction times the slip from end to end of a cycle. At points of
/// interfaces, on both sides.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct RuizWork {}

impl Criterion for Ruiz {
    fn name(&self) -> &'static str {
        "RUIZ"
    }

    fn on_surface(&self, at: &Rubbed) -> Option<f64> {
        Some(at.tension * at.shear * at.slip)
    }
}

impl Criterion for RuizWork {
    fn name(&self) -> &'static str {
        "RUIZWORK"
    }

    fn on_surface(&self, at: &Rubbed) -> Option<f64> {
        Some(at.shear * at.slip)
    }
}

impl Samples for Ruiz {
    fn samples() -> Vec<Self> {
        vec![Ruiz {}]
    }
}

impl Samples for RuizWork {
    fn samples() -> Vec<Self> {
        vec![RuizWork {}]
    }
}
