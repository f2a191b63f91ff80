use super::super::facets::combine;
use super::domain::{Action, Domain, LoadModel, Region, Target, mismatch};
use crate::error::Diagnostic;
use crate::math::scale;
use crate::registry::Samples;

/// Weight: the density of the material times an acceleration, on cells, and that of point masses at them.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Gravity {
    /// Acceleration `[m/s²]`, as many components as the space has: `[0, -9.81]`.
    pub acceleration: Vec<f64>,
}

impl LoadModel for Gravity {
    fn region(&self) -> Region {
        Region::Cells
    }

    fn action(&self, target: &Target, domain: &Domain) -> Result<Action, Diagnostic> {
        let g = domain.vector("acceleration", &self.acceleration)?;
        domain.heavy(target, "gravity")?;
        let weight = domain.over_cells(target, &|block| {
            scale(domain.densities.get(block).copied().unwrap_or(0.0), g)
        })?;
        let (Action::Forces(mut forces), Target::Cells(cells)) = (weight, target) else {
            return Err(mismatch(Region::Cells));
        };
        let dofs = domain.dofs();
        for (p, mass) in domain.masses_at(cells) {
            forces.extend((0..dofs.dim).map(|i| (dofs.of(p, i), mass * g[i])));
        }
        Ok(Action::Forces(combine(forces)))
    }
}

impl Samples for Gravity {
    fn samples() -> Vec<Self> {
        vec![Gravity {
            acceleration: vec![0.0, -9.81],
        }]
    }
}
