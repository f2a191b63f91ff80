use serde::{Deserialize, Serialize};

use super::law::{WearLaw, WearPoint, WearRate};
use crate::registry::Samples;

/// No wear. No parameters.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Unworn {}

impl WearLaw for Unworn {
    fn rates(&self, _at: &WearPoint) -> [WearRate; 2] {
        [WearRate::default(); 2]
    }

    fn active(&self) -> bool {
        false
    }

    fn faults(&self) -> Vec<(&'static str, String)> {
        Vec::new()
    }
}

impl Samples for Unworn {
    fn samples() -> Vec<Self> {
        vec![Unworn {}]
    }
}
