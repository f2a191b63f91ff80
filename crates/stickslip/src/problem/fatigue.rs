use serde::{Deserialize, Serialize};

use crate::fatigue::FatigueModel;

/// `[output.fatigue]`: criteria of fretting fatigue, which are evaluated for every cycle that is computed in steps with `cycles`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct Fatigue {
    /// Criteria: `criteria = [{ findley = { k = 0.3 } }, { ruiz = {} }]`. Each has a field of its name with the values of the last cycle and one with the
    /// normals of the worst planes, columns of its largest value in `cycles.csv`, and an entry in the summary.
    pub criteria: Vec<FatigueModel>,
    /// Distance from interfaces within which points are evaluated, as meshed `[length]`. Default: all points of bodies at an interface.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0)))]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub depth: Option<f64>,
}
