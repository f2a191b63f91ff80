use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use crate::body::heat::TemperatureKind;

/// `[initial.NAME]`: displacements and temperatures at the start of the analysis, and velocities at the start of a dynamic step.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct Initial {
    /// The points: a body, `body.set` or a `[set.NAME]`.
    pub set: String,
    /// Displacement `[length]` at the start of the analysis.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub displacement: Option<Vec<f64>>,
    /// Velocity `[length/time]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub velocity: Option<Vec<f64>>,
    /// Angular velocity about the centre of the points of the set `[1/time]`, added to `velocity`: one number in the plane, a vector
    /// in 3D.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub spin: Option<Vec<f64>>,
    /// Temperature at the start of the analysis, at which nothing has expanded: `temperature.uniform = { value = 20 }`; 0 if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub temperature: Option<TemperatureKind>,
    /// Displacements and velocities from a result file `.vtu` of the same mesh, relative to the folder of the problem file; instead of
    /// `displacement`, `velocity` and `spin`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub result: Option<PathBuf>,
    /// The name of the dynamic step at whose start the velocity is given; the first dynamic step if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub step: Option<String>,
}
