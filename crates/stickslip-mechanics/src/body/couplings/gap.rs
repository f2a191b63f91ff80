use serde::{Deserialize, Serialize};

use super::{Row, Term, Tie, equation};

use super::model::{CouplingModel, Ground};
use crate::error::Diagnostic;
use crate::registry::Samples;
use crate::system::Component;

/// A stop: a weighted sum of displacements does not fall below minus the clearance. Of two points with terms of opposite factors along an axis that is
/// contact between them, without friction and along that axis, wherever they are; with terms of one point it is contact with the ground.
///
/// Sets of n points stand for n gaps, as with equations. What is met does not give way, unless it has a stiffness. In explicit steps it has one in any
/// case, as equations have.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Gap {
    /// The opening: `[{ set = "a.tip", component = "y" }, { set = "b.foot", component = "y", factor = -1 }]`.
    #[cfg_attr(feature = "schema", schemars(length(min = 1)))]
    pub terms: Vec<Term>,
    /// How far the sum may fall before it meets something `[length]`; below zero there is an overlap at the start. Zero if not given.
    #[serde(default, skip_serializing_if = "equation::is_zero")]
    pub clearance: f64,
    /// Stiffness of what is met, for each gap `[N/m]`: over the whole thickness of a plane body, around the whole circumference of an axisymmetric
    /// one. Nothing that gives way if not given.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0)))]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stiffness: Option<f64>,
}

impl CouplingModel for Gap {
    fn sets(&self) -> Vec<(String, &str)> {
        equation::sets(&self.terms)
    }

    fn rows(&self, points: &[Vec<usize>], ground: Ground) -> Result<Vec<Row>, Diagnostic> {
        if !self.clearance.is_finite() {
            return Err(Diagnostic::new("clearance", "the clearance is not finite"));
        }
        equation::rows(&self.terms, points, ground)
    }

    fn tie(&self) -> Tie {
        Tie::Gap {
            clearance: self.clearance,
            stiffness: self.stiffness,
        }
    }
}

impl Samples for Gap {
    fn samples() -> Vec<Self> {
        let terms = vec![Term {
            set: "a.left".into(),
            component: Component::Y,
            factor: 1.0,
        }];
        let gap = |clearance, stiffness| Gap {
            terms: terms.clone(),
            clearance,
            stiffness,
        };
        vec![gap(1e-3, None), gap(0.0, Some(1e6))]
    }
}
