use serde::{Deserialize, Serialize};

use super::{Row, Term, Tie, equation};

use super::model::{CouplingModel, Ground};
use crate::error::Diagnostic;
use crate::registry::Samples;
use crate::system::Component;

/// A spring whose elongation is a weighted sum of displacements: of one point against the ground with one term, between two points with two
/// terms of opposite factors.
///
/// Sets of n points stand for n springs, as with equations. The springs are free of force where nothing has moved.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Spring {
    /// The elongation: `[{ set = "a.tip", component = "y" }, { set = "b.foot", component = "y", factor = -1 }]`.
    #[cfg_attr(feature = "schema", schemars(length(min = 1)))]
    pub terms: Vec<Term>,
    /// Stiffness of each spring `[N/m]`: over the whole thickness of a plane body, around the whole circumference of an axisymmetric one.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0)))]
    pub stiffness: f64,
}

impl CouplingModel for Spring {
    fn sets(&self) -> Vec<(String, &str)> {
        equation::sets(&self.terms)
    }

    fn rows(&self, points: &[Vec<usize>], ground: Ground) -> Result<Vec<Row>, Diagnostic> {
        equation::rows(&self.terms, points, ground)
    }

    fn tie(&self) -> Tie {
        Tie::Spring {
            stiffness: self.stiffness,
        }
    }
}

impl Samples for Spring {
    fn samples() -> Vec<Self> {
        vec![Spring {
            terms: vec![Term {
                set: "a.left".into(),
                component: Component::Y,
                factor: 1.0,
            }],
            stiffness: 1e6,
        }]
    }
}
