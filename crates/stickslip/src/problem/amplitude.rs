use serde::{Deserialize, Serialize};

/// `[amplitude.NAME]`: a factor over the time of the analysis, linear between the rows, constant outside.
/// Increments land on its times.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct AmplitudeTable {
    /// Rows `[time, factor]` with increasing times. Time counts from the start of the first step.
    #[cfg_attr(feature = "schema", schemars(length(min = 1)))]
    pub table: Vec<[f64; 2]>,
}
