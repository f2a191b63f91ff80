use serde::{Deserialize, Serialize};

/// `[output]`: when fields are written to `fields.pvd`. The summary covers every increment.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields, default)]
pub struct Output {
    /// Fields are written every so many increments, and at the end of every step; 0 for the ends of steps only.
    pub every: usize,
    /// A row of `history.csv` is written every so many increments, at times of output, and at the end of every step.
    #[cfg_attr(feature = "schema", schemars(range(min = 1)))]
    pub history_every: usize,
    /// Further times `[time]` at which fields are written, increasing. Increments land on them.
    pub times: Vec<f64>,
}

impl Default for Output {
    fn default() -> Self {
        Output {
            every: 1,
            history_every: 1,
            times: Vec::new(),
        }
    }
}
