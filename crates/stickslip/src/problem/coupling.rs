use serde::{Deserialize, Serialize};

use crate::body::couplings::CouplingKind;

/// `[coupling.NAME]`: an equation between displacements, a spring, a gap or a dashpot between points, or what ties points to a reference point.
///
/// Over the step in which it becomes active an equation leads its sum linearly from what it is to the value, unless an amplitude says otherwise; in a step
/// that does not list it, it lets go like a support. A spring that is active in the first step acts in full from the beginning; later the
/// stiffness grows and falls linearly over a quasi-static step, like a load. So do the stiffness of a gap, which without one acts at once, and the
/// coefficient of a dashpot.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct Coupling {
    /// An `[amplitude.NAME]` over the time of the analysis, by which the value of an equation, the stiffness of a spring or gap, or
    /// the coefficient of a dashpot is multiplied.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub amplitude: Option<String>,
    /// What it is.
    #[serde(flatten)]
    pub kind: CouplingKind,
}
