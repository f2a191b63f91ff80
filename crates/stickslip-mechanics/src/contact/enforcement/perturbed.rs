use serde::{Deserialize, Serialize};

use super::penalty::stiffness_faults;
use super::rule::{Enforcement, Multipliers, Stiffness};
use crate::registry::Samples;

/// Perturbed Lagrangian: the tractions are unknowns of Newton's iteration, coupled to the gaps by the blocks `-1/ω` of
/// [Pop 1995](stickslip_base::references::pop_1995), eq. (27) and (33)-(38). They are eliminated point by point before the solve.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct PerturbedLagrangian {
    /// ω against penetration as a multiple of the bodies' own stiffness `M / h` `[-]`. Default: 10⁴.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub factor: Option<f64>,
    /// ω against penetration per area `[Pa/m]`, instead of `factor`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stiffness: Option<f64>,
    /// ω of sticking as a multiple of `M / h` `[-]`. Default: as against penetration.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tangential_factor: Option<f64>,
    /// ω of sticking per area `[Pa/m]`, instead of `tangential-factor`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tangential_stiffness: Option<f64>,
}

impl Enforcement for PerturbedLagrangian {
    fn multipliers(&self) -> Multipliers {
        Multipliers::Unknown
    }

    fn normal(&self) -> Stiffness {
        Stiffness::choose(self.stiffness, self.factor, 1e4)
    }

    fn tangential(&self) -> Stiffness {
        match (self.tangential_stiffness, self.tangential_factor) {
            (None, None) => self.normal(),
            (absolute, factor) => Stiffness::choose(absolute, factor, 1e4),
        }
    }

    fn faults(&self) -> Vec<(&'static str, String)> {
        stiffness_faults(&[
            ("factor", self.factor),
            ("stiffness", self.stiffness),
            ("tangential-factor", self.tangential_factor),
            ("tangential-stiffness", self.tangential_stiffness),
        ])
    }
}

impl Samples for PerturbedLagrangian {
    fn samples() -> Vec<Self> {
        vec![PerturbedLagrangian::default()]
    }
}
