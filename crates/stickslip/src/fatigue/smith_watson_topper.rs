use serde::{Deserialize, Serialize};

use super::criterion::{Criterion, OnPlane};
use crate::registry::Samples;

/// [Smith, Watson and Topper 1970](crate::references::smith_1970) on the critical plane: the largest `σ_n,max ε_a` of all planes `[Pa]`, with the largest stress across the plane and the amplitude of the elastic strain
/// across it, half of its range. Zero where no plane ever opens.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct SmithWatsonTopper {}

impl Criterion for SmithWatsonTopper {
    fn name(&self) -> &'static str {
        "SWT"
    }

    fn on_plane(&self, at: &OnPlane) -> Option<f64> {
        let [mut low, mut high] = [f64::INFINITY, f64::NEG_INFINITY];
        for &strain in &at.strain {
            low = low.min(strain);
            high = high.max(strain);
        }
        Some(at.opening().max(0.0) * 0.5 * (high - low))
    }
}

impl Samples for SmithWatsonTopper {
    fn samples() -> Vec<Self> {
        vec![SmithWatsonTopper {}]
    }
}
