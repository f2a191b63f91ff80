use serde::{Deserialize, Serialize};

use super::law::{Extra, NormalDamping};
use crate::registry::Samples;

/// No damping: pressure follows from the gap alone. No parameters.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Undamped {}

impl NormalDamping for Undamped {
    fn extra(&self, _pressure: f64, _rate: f64) -> Extra {
        Extra::default()
    }

    fn active(&self) -> bool {
        false
    }

    fn faults(&self) -> Vec<(&'static str, String)> {
        Vec::new()
    }
}

impl Samples for Undamped {
    fn samples() -> Vec<Self> {
        vec![Undamped {}]
    }
}
