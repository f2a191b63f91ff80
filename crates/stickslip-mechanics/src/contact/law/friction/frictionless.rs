use serde::{Deserialize, Serialize};

use super::law::{FrictionLaw, FrictionPoint, Limit};
use crate::registry::Samples;

/// No friction: the interface carries pressure only. No parameters.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Frictionless {}

impl FrictionLaw for Frictionless {
    fn limit(&self, _at: &FrictionPoint) -> Limit {
        Limit::default()
    }

    fn frictional(&self) -> bool {
        false
    }

    fn faults(&self) -> Vec<(&'static str, String)> {
        Vec::new()
    }
}

impl Samples for Frictionless {
    fn samples() -> Vec<Self> {
        vec![Frictionless {}]
    }
}
