use serde::{Deserialize, Serialize};

use crate::body::loads::LoadKind;

/// `[load.NAME]`: a force or springs on a set.
///
/// Over the step in which it becomes active, a load grows linearly from zero, unless an amplitude says otherwise.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct Load {
    /// Where it acts: `body.set`, a `[set.NAME]`, a body, or, of a force at points, a moment or springs, a `[reference.NAME]`.
    pub set: String,
    /// An `[amplitude.NAME]` over the time of the analysis, by which the load is multiplied.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub amplitude: Option<String>,
    /// On a body that turns (`body.NAME.rotation`): whether the load turns with it. A pressure and a centrifugal force do in any case; others keep their
    /// direction in space unless this says so.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub follow: bool,
    /// What acts.
    #[serde(flatten)]
    pub kind: LoadKind,
}

impl Load {
    /// Whether it turns with a body that does.
    pub(crate) fn follows(&self) -> bool {
        self.follow || matches!(self.kind, LoadKind::Pressure(_) | LoadKind::Centrifugal(_))
    }
}
