use serde::{Deserialize, Serialize};

use super::{Row, Term, Tie, equation};

use super::model::{CouplingModel, Ground};
use crate::error::Diagnostic;
use crate::registry::Samples;
use crate::system::Component;

/// A dashpot: a viscous force on a linear combination of velocities. It does not act in quasi-static steps.
///
/// Sets of n points stand for n dashpots, as with equations. What they take counts with damping in the balance of energies.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Dashpot {
    /// The elongation: `[{ set = "a.tip", component = "y" }, { set = "b.foot", component = "y", factor = -1 }]`.
    #[cfg_attr(feature = "schema", schemars(length(min = 1)))]
    pub terms: Vec<Term>,
    /// Force of each dashpot per velocity `[N s/m]`: over the whole thickness of a plane body, around the whole circumference of an axisymmetric one.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0)))]
    pub coefficient: f64,
}

impl CouplingModel for Dashpot {
    fn sets(&self) -> Vec<(String, &str)> {
        equation::sets(&self.terms)
    }

    fn rows(&self, points: &[Vec<usize>], ground: Ground) -> Result<Vec<Row>, Diagnostic> {
        equation::rows(&self.terms, points, ground)
    }

    fn tie(&self) -> Tie {
        Tie::Dashpot {
            coefficient: self.coefficient,
        }
    }
}

impl Samples for Dashpot {
    fn samples() -> Vec<Self> {
        vec![Dashpot {
            terms: vec![Term {
                set: "a.left".into(),
                component: Component::Y,
                factor: 1.0,
            }],
            coefficient: 1e2,
        }]
    }
}
