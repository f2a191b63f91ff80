use serde::{Deserialize, Serialize};

use super::set::PlaneRegion;

/// `[pretension.NAME]`: a cut through a bolt, whose two sides are drawn together as tightening does it.
///
/// The two sides stay together across the normal, and along it all of the section has one displacement between them, the shortening. In the
/// problem of a bolted joint a force draws them together in the first step, and later steps keep the shortening that it has come to, so that the force
/// changes with what the joint has to carry. What is done in which step is said in the steps: `pretension.NAME = { force = 2e4 }`, then
/// `pretension.NAME = { hold = true }`. The history has the force of the section, positive in tension, and the shortening.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct Pretension {
    /// The body that a plane cuts, or a set of cells `body.set`, if it is to cut no others. Facets say by themselves of which body they are.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub of: Option<String>,
    /// Where the cut is.
    #[serde(flatten)]
    pub section: Section,
}

/// Where a [`Pretension`] cuts.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum Section {
    /// The layer of faces between cells that is nearest to a plane; of several sections that the plane meets the one nearest to its point. The normal is along
    /// the bolt.
    Plane(PlaneRegion),
    /// Facets inside a mesh.
    Facets(FacetSection),
}

/// A section along facets inside a mesh: a physical surface of Gmsh within a volume, faces of elements of a deck.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct FacetSection {
    /// The facets, `body.set`. They run through the whole section, from surface to surface.
    pub set: String,
    /// Along the bolt, of any length; the mean normal of the facets if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub normal: Option<Vec<f64>>,
}

/// Pretension in a step: one of `force`, `shortening` and `hold`.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields, default)]
pub struct Tension {
    /// Force of the whole section, reached linearly over the step `[force]`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub force: Option<f64>,
    /// Overlap of the two sides, as if that length of the bolt was removed, reached linearly over the step `[length]`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shortening: Option<f64>,
    /// Keeps the present shortening.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub hold: bool,
    /// An `[amplitude.NAME]` over the time of the analysis, by which force or shortening is multiplied instead.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub amplitude: Option<String>,
}
