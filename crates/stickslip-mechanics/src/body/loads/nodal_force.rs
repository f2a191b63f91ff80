use super::domain::{Action, Domain, LoadModel, Region, Target};
use crate::error::Diagnostic;
use crate::registry::Samples;

/// The same force at each point of a set.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct NodalForce {
    /// Force at each point `[N]`, as many components as the space has: over the whole thickness of a plane body, around
    /// the whole circumference of an axisymmetric one.
    pub value: Vec<f64>,
}

impl LoadModel for NodalForce {
    fn region(&self) -> Region {
        Region::Points
    }

    fn action(&self, target: &Target, domain: &Domain) -> Result<Action, Diagnostic> {
        let f = domain.vector("value", &self.value)?;
        domain.at_points(target, f).map(Action::Forces)
    }
}

impl Samples for NodalForce {
    fn samples() -> Vec<Self> {
        vec![NodalForce {
            value: vec![100.0, 0.0],
        }]
    }
}
