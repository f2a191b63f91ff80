use super::domain::{Action, Domain, LoadModel, Region, Target};
use crate::error::Diagnostic;
use crate::registry::Samples;

/// Force per area with a fixed direction, on boundary facets.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Traction {
    /// Traction `[Pa]`, as many components as the space has; radius and axis in an axisymmetric problem.
    pub value: Vec<f64>,
}

impl LoadModel for Traction {
    fn region(&self) -> Region {
        Region::Facets
    }

    fn action(&self, target: &Target, domain: &Domain) -> Result<Action, Diagnostic> {
        let t = domain.vector("value", &self.value)?;
        domain.over_facets(target, &|_| t)
    }
}

impl Samples for Traction {
    fn samples() -> Vec<Self> {
        vec![Traction {
            value: vec![1e6, -2e6],
        }]
    }
}
