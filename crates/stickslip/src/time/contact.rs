//! How interfaces stand in the equations of motion.

use serde::{Deserialize, Serialize};

/// Whether points in contact have mass.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum ContactMass {
    /// The mass of the points of both surfaces is given to their neighbours
    /// ([`khenous_2008`](crate::references::khenous_2008)); mass and centre of mass of the body stay. Contact forces do not chatter,
    /// and hardly any energy is gained or lost at impact.
    Redistributed,
    /// Every point has the mass that the cells give it: the classical scheme.
    AsMeshed,
}

/// Where in the increment the forces of the interfaces are taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum ContactAt {
    /// At its end: nothing overlaps there and friction opposes the velocity there. Of first order; it dissipates.
    End,
    /// As the mean over the increment with which the scheme weighs all other forces: of second order where laws are compliant. For Newmark's method it is the same.
    Stage,
}
