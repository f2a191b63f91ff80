use serde::{Deserialize, Serialize};

use crate::roughness::RoughnessKind;

/// `interface.NAME.roughness`: heights of the secondary surface above its mesh, which its gaps are less by.
///
/// Meshes and matrices stay as they are, so that bodies are factored once for all roughnesses. That is right to first order, for waves that are long beside their heights.
/// Heights belong to the points of the secondary and move with them; the primary is smooth.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct Roughness {
    /// The place on the surface from which heights are counted along its axes `[length]`. Default: the corner in which both are least.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub origin: Option<Vec<f64>>,
    /// The first axis, along the lines of a map; the part of it that is normal to the surface has no effect. The second one is to the left of it for who
    /// looks at the surface from outside. Default: x, or y if the surface faces along x.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub along: Option<Vec<f64>>,
    /// Where heights come from.
    #[serde(flatten)]
    pub kind: RoughnessKind,
}
