use super::domain::{Action, Domain, LoadModel, Region, Target};
use crate::error::Diagnostic;
use crate::math::scale;
use crate::registry::Samples;

/// Force per area against the outward normal, on boundary facets. The normal is that of the undeformed body.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Pressure {
    /// Pressure `[Pa]`, positive when it pushes.
    pub value: f64,
}

impl LoadModel for Pressure {
    fn region(&self) -> Region {
        Region::Facets
    }

    fn action(&self, target: &Target, domain: &Domain) -> Result<Action, Diagnostic> {
        if !self.value.is_finite() {
            return Err(Diagnostic::new(
                "value",
                format!("value = {} is not finite", self.value),
            ));
        }
        domain.over_facets(target, &|q| scale(-self.value, q.normal))
    }
}

impl Samples for Pressure {
    fn samples() -> Vec<Self> {
        vec![Pressure { value: 3e6 }]
    }
}
