use serde::{Deserialize, Serialize};

use crate::contact::obstacle::{Motion, ObstacleShape};

/// `[obstacle.NAME]`: a rigid body that can be the primary of an interface.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct Obstacle {
    /// Its prescribed motion; at rest if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub motion: Option<Motion>,
    /// Its shape at time zero, before any motion.
    #[serde(flatten)]
    pub shape: ObstacleShape,
}
