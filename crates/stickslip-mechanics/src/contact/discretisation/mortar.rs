use serde::{Deserialize, Serialize};

use super::rule::Discretisation;
use crate::registry::Samples;

/// Surface to surface, the default: the gap of a node is a mean over the faces around it, weighted by a dual function, over what the two
/// surfaces have in common ([Puso and Laursen 2004](stickslip_base::references::puso_2004),
/// [Popp et al. 2012](stickslip_base::references::popp_2012)).
///
/// A uniform pressure passes between any two meshes without error, and forces do not jump when nodes slide from facet to facet. Linear and
/// quadratic faces, in 2D and 3D. On an obstacle, which has no facets, contact is checked at points, as with `node-to-facet`.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct MortarContact {
    /// Angle between neighbouring faces of the secondary `[°]` up to which the surface is taken as smooth there, and normals are
    /// averaged; across sharper edges each side has contact points of its own. Default: 30.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub smooth_angle: Option<f64>,
    /// Both surfaces are secondary, each for one half of the pressure: the result does not depend on which is called primary. Costs twice as
    /// much, and needs `enforcement.penalty` or a compliant normal law without friction: multipliers of both sides would not be determined. Results of the
    /// second half stand under `NAME-reverse`. Default: false.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub two_sided: bool,
}

impl Discretisation for MortarContact {
    fn weighted(&self) -> Option<f64> {
        Some(self.smooth_angle.unwrap_or(30.0))
    }

    fn two_sided(&self) -> bool {
        self.two_sided
    }

    fn faults(&self) -> Vec<(&'static str, String)> {
        match self.smooth_angle {
            Some(a) if !(0.0..=180.0).contains(&a) => vec![(
                "smooth-angle",
                format!("{a} is no angle between 0 and 180 degrees"),
            )],
            _ => Vec::new(),
        }
    }
}

impl Samples for MortarContact {
    fn samples() -> Vec<Self> {
        vec![
            MortarContact::default(),
            MortarContact {
                smooth_angle: Some(45.0),
                two_sided: true,
            },
        ]
    }
}
