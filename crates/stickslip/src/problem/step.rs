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
    /// How long it lasts, or where it has `cycles` each of them `[time]`.
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
    /// The temperatures that act in this step; all if not given. Points whose temperature is not listed any more go back to the one of the start.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub temperatures: Option<Vec<String>>,
    /// The interfaces active in this step; all if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub interfaces: Option<Vec<String>>,
    /// The couplings active in this step; all if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub couplings: Option<Vec<String>>,
    /// What is done with pretensions from this step on: `pretension.bolt = { force = 2e4 }`, `pretension.bolt = { hold = true }`. Before the first step that
    /// says so they are held as meshed.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub pretension: BTreeMap<String, Tension>,
    /// Laws that change from this step on, by interface: `change.base = { friction.coulomb = { mu = 0.1 } }`.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub change: BTreeMap<String, Change>,
    /// Goes through the step again and again, for fretting and wear: amplitude tables give one cycle, which has to end as it begins.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cycles: Option<Cycles>,
    /// Sliding that lasts: `steady = {}`. Where the surface of a primary moves by itself (`primary-velocity`, or `velocity` and `turning` here), points that touch slide along
    /// that motion from the first increment on, whatever their displacements, as after a long way; others stick and slip as ever.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub steady: Option<SteadySliding>,
    /// Real modes about the state that the step before has reached: frequencies, shapes and participation, without friction. The step has no increments: time passes, and
    /// nothing moves.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub modes: Option<Modes>,
    /// Modes of steady sliding about that state: frequencies and growth rates, with friction and damping. No increments either.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub complex_modes: Option<ComplexModes>,
    /// The answer to harmonic loads about that state, by superposition of modes: amplitudes and phases over the frequency. No increments either.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub harmonic: Option<Harmonic>,
    /// How the step is divided, or where it has `cycles` each of them.
    #[serde(default)]
    pub increments: Increments,
    /// Makes the step dynamic; quasi-static if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dynamic: Option<Dynamic>,
    /// Begins a dynamic step along a mode that the step before has found: `kick = { amplitude = 1e-6 }`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kick: Option<Kick>,
}

/// How often a step is gone through. The time of the analysis goes on by one duration for each cycle that is computed, or where jumps are chosen for each cycle that is over;
/// amplitude tables, and what follows in them, count one cycle.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct Cycles {
    /// How many cycles there are.
    #[cfg_attr(feature = "schema", schemars(range(min = 1)))]
    pub count: usize,
    /// How many of them each cycle that is computed stands for: what slides in it wears as often. Or the error that jumps over cycles may make, `{ error = 0.01 }`, by
    /// which each is chosen. Default: 1.
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
}

impl Default for Increments {
    fn default() -> Self {
        Increments {
            fixed: None,
            initial: 0.1,
            smallest: 1e-6,
            largest: 1.0,
        }
    }
}
