use serde::{Deserialize, Serialize};

use crate::body::MassKind;
use crate::time::scheme::SchemeModel;
use crate::time::{ContactAt, ContactMass};

/// `[step.dynamic]`: the bodies have inertia in this step. An empty table takes the defaults.
///
/// The velocities at its start are those of the step before (zero after a quasi-static one) or those of `[initial.NAME]`; the
/// accelerations follow from the equations of motion. A load without an amplitude acts at once in full, and a support
/// or load that is not listed any more lets go at once.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields, default)]
pub struct Dynamic {
    /// How the equations of motion are integrated.
    pub scheme: SchemeModel,
    /// Mass matrix of cells. An explicit scheme has lumped masses.
    pub mass: MassKind,
    /// Mass of contact points. Default: redistributed if the normal law is unilateral, as meshed if it is compliant or the scheme explicit. Tied surfaces
    /// keep their mass.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub contact_mass: Option<ContactMass>,
    /// Where in the increment contact forces are evaluated. Default: `stage` if the laws of all interfaces are compliant and couplings are springs and
    /// dashpots only, else `end`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub contact_at: Option<ContactAt>,
    /// Largest local error of the displacements over an increment, relative to the motion since the start of the step; an increment with
    /// more is halved. Not checked if not given.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0)))]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error: Option<f64>,
    /// Time `[time]` to which opening, closing, sticking and slipping are located: an increment over which a point changes
    /// status is halved until it is no longer than this. Not located if not given.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0)))]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub events: Option<f64>,
}
