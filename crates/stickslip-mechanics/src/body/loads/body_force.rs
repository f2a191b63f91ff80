use super::domain::{Action, Domain, LoadModel, Region, Target};
use crate::error::Diagnostic;
use crate::registry::Samples;

/// Force per volume, on cells.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct BodyForce {
    /// Force per volume `[N/m³]`, as many components as the space has.
    pub value: Vec<f64>,
}

impl LoadModel for BodyForce {
    fn region(&self) -> Region {
        Region::Cells
    }

    fn action(&self, target: &Target, domain: &Domain) -> Result<Action, Diagnostic> {
        let f = domain.vector("value", &self.value)?;
        domain.over_cells(target, &|_| f)
    }
}

impl Samples for BodyForce {
    fn samples() -> Vec<Self> {
        vec![BodyForce {
            value: vec![0.0, -7.7e4],
        }]
    }
}
