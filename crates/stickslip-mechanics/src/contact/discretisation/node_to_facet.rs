use serde::{Deserialize, Serialize};

use super::rule::Discretisation;
use crate::registry::Samples;

/// The paper's contact elements ([Pop 1995](stickslip_base::references::pop_1995), eq. 27-40): each point of the secondary meets the facet it lies over.
/// Cheaper by a part, and with second derivatives in the tangent, but between meshes that do not match a uniform pressure comes out wrong by some
/// 5 to 20 %, however fine they are. No parameters.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct NodeToFacet {}

impl Discretisation for NodeToFacet {}

impl Samples for NodeToFacet {
    fn samples() -> Vec<Self> {
        vec![NodeToFacet {}]
    }
}
