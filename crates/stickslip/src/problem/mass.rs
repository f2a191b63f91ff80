use serde::{Deserialize, Serialize};

/// `[mass.NAME]`: a mass at each point of a set, beside that of the cells: what is fixed to a body and not meshed.
///
/// It takes part in dynamic steps, in all directions, and bears the gravity and the centrifugal forces that act on the cells of its point; it has no moment
/// of inertia. Points of rigid bodies cannot carry any. A point of an interface that carries a mass keeps that of its cells as well.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct Mass {
    /// The points: `body.set`, a `[set.NAME]`, a body, or a `[reference.NAME]`.
    pub set: String,
    /// Mass at each point `[kg]`: over the whole thickness of a plane body, around the whole circumference of an axisymmetric one.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0)))]
    pub mass: f64,
}
