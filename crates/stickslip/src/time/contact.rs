//! How interfaces stand in the equations of motion.

use serde::{Deserialize, Serialize};

/// Whether points in contact have mass.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum ContactMass {
    /// The mass of contact points is moved to their neighbours ([`khenous_2008`](crate::references::khenous_2008)); mass and centre of mass of the body
    /// stay. Contact forces do not oscillate, and impacts hardly change the energy.
    Redistributed,
    /// Contact points keep their mass: the classical scheme.
    AsMeshed,
}

/// Where in the increment contact forces are evaluated. Default: `stage` if the laws of all interfaces are compliant and couplings are springs and
/// dashpots only, else `end`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum ContactAt {
    /// At the end: no overlap at that time, and friction opposes the velocity. First order; dissipative.
    End,
    /// With the weights of the scheme for all other forces: second order with compliant laws. Equal to `end` for Newmark's method.
    Stage,
}
