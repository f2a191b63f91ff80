use serde::{Deserialize, Serialize};

/// `[set.NAME]`: a set of points chosen by geometry, before any deformation. Where facets are wanted (pressure,
/// interfaces), it stands for the boundary facets, and where cells are wanted (weight) for the cells, all of whose points are in
/// the set.
///
/// Meshes bring sets of their own, `body.set`; the name of a body alone stands for all of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct Set {
    /// The body, or the set `body.set`, from which points are chosen. Needed by all but `union`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub of: Option<String>,
    /// How far a point may lie from the place described, as a fraction of the body's diagonal.
    #[cfg_attr(feature = "schema", schemars(range(min = 0)))]
    #[serde(default = "default_tolerance")]
    pub tolerance: f64,
    /// Which points.
    #[serde(flatten)]
    pub select: Select,
}

fn default_tolerance() -> f64 {
    1e-6
}

/// How the points of a [`Set`] are chosen.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum Select {
    /// The one point at these coordinates `[length]`; an error if there is none within the tolerance.
    Point(Vec<f64>),
    /// The points in a box with sides along the axes.
    Box(BoxRegion),
    /// The points on a plane (in 2D: a line).
    Plane(PlaneRegion),
    /// The points in a ball (in 2D: a disc).
    Ball(BallRegion),
    /// The points of the boundary facets that look in a direction; where facets are wanted, these.
    Normal(NormalRegion),
    /// The points with these numbers of the mesh.
    Numbers(Vec<u64>),
    /// The points of other sets, `body.set` or names of `[set.NAME]`.
    Union(Vec<String>),
}

/// A box with sides along the axes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct BoxRegion {
    /// Corner with the smallest coordinates `[length]`.
    pub from: Vec<f64>,
    /// Corner with the largest coordinates `[length]`.
    pub to: Vec<f64>,
}

/// A plane; in 2D a line.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct PlaneRegion {
    /// A point on it `[length]`.
    pub point: Vec<f64>,
    /// Its normal, of any length.
    pub normal: Vec<f64>,
}

/// Facets by the direction in which they look.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct NormalRegion {
    /// The direction of the outward normal, of any length.
    pub direction: Vec<f64>,
    /// Largest angle between the normal of a facet, at its middle, and the direction `[degrees]`.
    #[cfg_attr(feature = "schema", schemars(range(min = 0, max = 180)))]
    #[serde(default = "default_angle")]
    pub angle: f64,
}

fn default_angle() -> f64 {
    20.0
}

/// A ball; in 2D a disc.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct BallRegion {
    /// Its centre `[length]`.
    pub centre: Vec<f64>,
    /// Its radius `[length]`.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0)))]
    pub radius: f64,
}
