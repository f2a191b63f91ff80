use super::{Action, Domain, LoadModel, Region, Target};
use crate::error::Diagnostic;
use crate::math::scale;
use crate::mesh::CellRef;
use crate::registry::Samples;

/// Weight: the density of the material times an acceleration, on cells.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Gravity {
    /// Acceleration [m/s²], as many components as the space has: `[0, -9.81]`.
    pub acceleration: Vec<f64>,
}

impl LoadModel for Gravity {
    fn region(&self) -> Region {
        Region::Cells
    }

    fn action(&self, target: &Target, domain: &Domain) -> Result<Action, Diagnostic> {
        let g = domain.vector("acceleration", &self.acceleration)?;
        if let Target::Cells(cells) = target {
            let light =
                |c: &CellRef| !(domain.densities.get(c.block).is_some_and(|&rho| rho > 0.0));
            if cells.iter().any(light) {
                return Err(
                    Diagnostic::new("", "gravity acts on a body without density")
                        .help("give the density of its material"),
                );
            }
        }
        domain.over_cells(target, &|block| {
            scale(domain.densities.get(block).copied().unwrap_or(0.0), g)
        })
    }
}

impl Samples for Gravity {
    fn samples() -> Vec<Self> {
        vec![Gravity {
            acceleration: vec![0.0, -9.81],
        }]
    }
}
