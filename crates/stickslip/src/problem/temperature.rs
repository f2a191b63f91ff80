use serde::{Deserialize, Serialize};

use crate::body::heat::TemperatureKind;

/// `[temperature.NAME]`: the temperature of a set, which makes its bodies expand.
///
/// Over the step in which it becomes active, the temperature of each point goes linearly from what it was to what is given; in a dynamic step
/// at once. Where a step does not list it, points go back to their temperature at the start, or on to what takes its place.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct Temperature {
    /// The points: a body, `body.set` or a `[set.NAME]`.
    pub set: String,
    /// An `[amplitude.NAME]` over the time of the analysis, by which the temperature is multiplied as long as it acts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub amplitude: Option<String>,
    /// How it is spread.
    #[serde(flatten)]
    pub kind: TemperatureKind,
}
