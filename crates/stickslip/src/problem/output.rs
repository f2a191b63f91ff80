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
    /// When the state is written from which `stickslip resume` goes on. It is written in any case when a run is asked to stop.
    pub checkpoint: CheckpointPlan,
}

/// When checkpoints are written: whichever comes first.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields, default)]
pub struct CheckpointPlan {
    /// After so many increments; 0: not by their number. Of condensed bodies up to sixteen are found together: then after the last of them.
    pub increments: usize,
    /// After so many minutes of the clock on the wall; 0: not by the clock.
    #[cfg_attr(feature = "schema", schemars(range(min = 0)))]
    pub minutes: f64,
}

impl Default for CheckpointPlan {
    fn default() -> Self {
        CheckpointPlan {
            increments: 0,
            minutes: 10.0,
        }
    }
}

impl Default for Output {
    fn default() -> Self {
        Output {
            every: 1,
            history_every: 1,
            times: Vec::new(),
            checkpoint: CheckpointPlan::default(),
        }
    }
}
