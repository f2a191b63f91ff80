use serde::{Deserialize, Serialize};

use super::Fatigue;
use crate::io::frd::Encoding;

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
    /// Writes fields also to an `.frd` file for CalculiX GraphiX, PrePoMax, FreeCAD and ccx2paraview: `fields.frd`, and for a deck `JOB.frd` with what it
    /// asks for.
    pub frd: Frd,
    /// Criteria of fretting fatigue, for every cycle that is computed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fatigue: Option<Fatigue>,
    /// Events of fast slip, as earthquakes, of interfaces under friction laws that keep their speed: a table `interfaces/NAME-events.csv`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub slip_events: Option<SlipEvents>,
    /// Checkpoints, from which `stickslip resume` continues. One is also written when a run is interrupted.
    pub checkpoint: CheckpointPlan,
}

/// `output.slip-events`: when sliding counts as an event. Events are found in the rows of the history.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct SlipEvents {
    /// An event lasts while some point slides faster than that `[length/time]`.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0)))]
    pub speed: f64,
    /// Shear modulus by which slip integrated over the surface is a moment `[pressure]`; the table has no moment without it.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0)))]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub modulus: Option<f64>,
}

/// How the `.frd` file is written.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum Frd {
    /// It is not written.
    #[default]
    None,
    /// As text, with six digits; every program that knows the format reads it.
    Text,
    /// As bytes, values of 32 bits: a third of the size, but fewer programs read it.
    Binary,
}

impl Frd {
    /// How numbers are written, if they are.
    pub fn encoding(self) -> Option<Encoding> {
        match self {
            Frd::None => None,
            Frd::Text => Some(Encoding::Text),
            Frd::Binary => Some(Encoding::Binary),
        }
    }
}

/// When checkpoints are written: whichever comes first.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields, default)]
pub struct CheckpointPlan {
    /// After so many increments; 0: not by their number. Of condensed bodies up to sixteen are found together: then after the last of them.
    pub increments: usize,
    /// Wall-clock minutes between checkpoints; 0: not by time.
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
            frd: Frd::None,
            fatigue: None,
            slip_events: None,
            checkpoint: CheckpointPlan::default(),
        }
    }
}
