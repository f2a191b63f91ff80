use super::domain::{Action, Domain, LoadModel, Region, Target};
use crate::error::Diagnostic;
use crate::registry::Samples;

/// Springs between each point of a set and the ground, one along each axis. Not scaled by an amplitude.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct GroundSpring {
    /// Stiffness along each axis at each point `[N/m]`, zero or more, as many as the space has: over the whole thickness
    /// of a plane body, around the whole circumference of an axisymmetric one.
    pub stiffness: Vec<f64>,
}

impl LoadModel for GroundSpring {
    fn region(&self) -> Region {
        Region::Points
    }

    fn action(&self, target: &Target, domain: &Domain) -> Result<Action, Diagnostic> {
        let k = domain.vector("stiffness", &self.stiffness)?;
        if let Some(bad) = k.iter().find(|k| **k < 0.0) {
            return Err(
                Diagnostic::new("stiffness", format!("stiffness {bad} is negative"))
                    .help("a spring to ground has a stiffness of zero or more along each axis"),
            );
        }
        domain.at_points(target, k).map(Action::Springs)
    }
}

impl Samples for GroundSpring {
    fn samples() -> Vec<Self> {
        vec![GroundSpring {
            stiffness: vec![1e6, 0.0],
        }]
    }
}
