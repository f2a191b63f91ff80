use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::{ComplexModes, Dynamic, Harmonic, Kick, Modes, SteadySliding, Tension};
use crate::contact::interface::Change;
use crate::model::Jump;

/// `[[step]]`: a stretch of the analysis with its own supports, loads and interfaces. Steps follow each other in the
/// order of the file; a step starts from the state at the end of the one before.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct Step {
    /// A name for messages and results; `step 1`, `step 2` if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Duration of the step, or with `cycles` of one cycle `[time]`.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0)))]
    #[serde(default = "one")]
    pub duration: f64,
    /// The supports active in this step; all if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub supports: Option<Vec<String>>,
    /// The loads active in this step; all if not given. A load that was active in the step before and is not listed
    /// falls linearly to zero.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub loads: Option<Vec<String>>,
    /// The temperatures active in this step; all if not given. Points without an active temperature return to their temperature at the start.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub temperatures: Option<Vec<String>>,
    /// The interfaces active in this step; all if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub interfaces: Option<Vec<String>>,
    /// The couplings active in this step; all if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub couplings: Option<Vec<String>>,
    /// Pretensions in this step: `pretension.bolt = { force = 2e4 }`, `pretension.bolt = { hold = true }`. Until a step names a pretension, its cut is
    /// closed as meshed.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub pretension: BTreeMap<String, Tension>,
    /// Laws that change in this step, by interface: `change.base = { friction.coulomb = { mu = 0.1 } }`.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub change: BTreeMap<String, Change>,
    /// Repeats the step, for fretting and wear: amplitude tables describe one cycle, which must end as it begins.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cycles: Option<Cycles>,
    /// Steady sliding: `steady = {}`. Where the surface of a primary moves (`primary-velocity`, or `velocity` and `turning` here), contact points slide
    /// along that motion from the first increment on. Interfaces without such a velocity stick and slip as usual.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub steady: Option<SteadySliding>,
    /// Real modes about the state of the step before: frequencies, shapes and participation factors, without friction. The step has no increments.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub modes: Option<Modes>,
    /// Complex modes of steady sliding about the state of the step before: frequencies and growth rates, with friction and damping. The step has no
    /// increments.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub complex_modes: Option<ComplexModes>,
    /// Response to harmonic loads about the state of the step before, by modal superposition: amplitudes and phases over the frequency. The step has no
    /// increments.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub harmonic: Option<Harmonic>,
    /// Time increments of the step, or with `cycles` of one cycle.
    #[serde(default)]
    pub increments: Increments,
    /// Makes the step dynamic; quasi-static if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dynamic: Option<Dynamic>,
    /// Starts a dynamic step with a mode of the step before: `kick = { amplitude = 1e-6 }`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kick: Option<Kick>,
}

/// Cycles of a step. The time of the analysis advances by one duration for each computed cycle, with chosen jumps for each completed cycle; amplitude
/// tables count one cycle.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct Cycles {
    /// Number of cycles.
    #[cfg_attr(feature = "schema", schemars(range(min = 1)))]
    pub count: usize,
    /// Number of cycles that each computed one stands for: its wear counts that often. Or the largest error of jumps over cycles, `{ error = 0.01 }`,
    /// from which each jump is chosen. Default: 1.
    #[serde(default)]
    pub jump: Jump,
}

impl Cycles {
    /// How many cycles there are in the time of the analysis.
    pub fn blocks(self) -> usize {
        match self.jump {
            Jump::Fixed(jump) => self.count.div_ceil(jump.max(1)).max(1),
            Jump::Chosen(_) => self.count,
        }
    }
}

impl Step {
    /// What is looked for in a step without increments.
    pub(super) fn modal(&self) -> Option<crate::model::Modal> {
        let real = self.modes.as_ref().map(Modes::plan);
        let complex = self.complex_modes.as_ref().map(ComplexModes::plan);
        let harmonic = self.harmonic.as_ref().map(Harmonic::plan);
        real.or(complex).or(harmonic)
    }
}

fn one() -> f64 {
    1.0
}

/// How a step is divided into increments. All sizes are fractions of the duration of the step.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields, default)]
pub struct Increments {
    /// This many equal increments, never cut or grown: one that fails ends the analysis. Excludes the other keys.
    #[cfg_attr(feature = "schema", schemars(range(min = 1, max = 100_000_000)))]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fixed: Option<usize>,
    /// Size of the first increment `[fraction of the duration]`.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0), range(max = 1)))]
    pub initial: f64,
    /// Size below which the analysis gives up `[fraction of the duration]`.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0), range(max = 1)))]
    pub smallest: f64,
    /// Size that is never exceeded `[fraction of the duration]`.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0), range(max = 1)))]
    pub largest: f64,
    /// Largest change of the state variables of friction laws over an increment, relative to what they are `[-]`: of θ of rate-and-state friction, and of the slip relative to `dc`. Increments
    /// are chosen by it, and one over which more than twice as much changes is halved. The error falls with its square. No meaning under laws without a state.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0), range(max = 1)))]
    pub state_change: f64,
}

impl Default for Increments {
    fn default() -> Self {
        Increments {
            fixed: None,
            initial: 0.1,
            smallest: 1e-6,
            largest: 1.0,
            state_change: 0.1,
        }
    }
}
