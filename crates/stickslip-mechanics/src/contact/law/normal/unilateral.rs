use serde::{Deserialize, Serialize};

use super::law::NormalLaw;
use crate::math::Slope;
use crate::registry::Samples;

/// Unilateral contact (Signorini): gap ≥ 0, pressure ≥ 0, and one of them is zero. No parameters.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Unilateral {}

impl NormalLaw for Unilateral {
    fn pressure(&self, _gap: f64) -> Option<Slope> {
        None
    }

    fn gap(&self, _pressure: f64) -> Slope {
        Slope::default()
    }

    fn energy(&self, _gap: f64) -> f64 {
        0.0
    }

    fn faults(&self) -> Vec<(&'static str, String)> {
        Vec::new()
    }
}

impl Samples for Unilateral {
    fn samples() -> Vec<Self> {
        vec![Unilateral {}]
    }
}
