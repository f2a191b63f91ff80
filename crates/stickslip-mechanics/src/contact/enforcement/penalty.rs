use serde::{Deserialize, Serialize};

use super::rule::{Enforcement, Multipliers, Stiffness};
use crate::contact::law::normal::positive;
use crate::registry::Samples;

/// Springs against penetration and slip of sticking points. Their penetration is reported and not corrected.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Penalty {
    /// Stiffness against penetration as a multiple of the bodies' own, `M / h` `[-]`. Default: 100.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub factor: Option<f64>,
    /// Stiffness against penetration per area `[Pa/m]`, instead of `factor`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stiffness: Option<f64>,
    /// Stiffness of sticking as a multiple of `M / h` `[-]`. Default: as against penetration.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tangential_factor: Option<f64>,
    /// Stiffness of sticking per area `[Pa/m]`, instead of `tangential-factor`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tangential_stiffness: Option<f64>,
}

/// What is wrong with the parameters that say how stiff, a multiple and an absolute one each.
pub(super) fn stiffness_faults(
    values: &[(&'static str, Option<f64>)],
) -> Vec<(&'static str, String)> {
    let mut faults: Vec<_> = values
        .iter()
        .filter_map(|&(key, value)| value.and_then(|value| positive(key, value)))
        .collect();
    for pair in values.chunks(2) {
        if let [(factor, Some(_)), (absolute, Some(_))] = *pair {
            faults.push((
                absolute,
                format!("give `{factor}` or `{absolute}`, not both"),
            ));
        }
    }
    faults
}

impl Enforcement for Penalty {
    fn multipliers(&self) -> Multipliers {
        Multipliers::None
    }

    fn normal(&self) -> Stiffness {
        Stiffness::choose(self.stiffness, self.factor, 100.0)
    }

    fn tangential(&self) -> Stiffness {
        match (self.tangential_stiffness, self.tangential_factor) {
            (None, None) => self.normal(),
            (absolute, factor) => Stiffness::choose(absolute, factor, 100.0),
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

impl Samples for Penalty {
    fn samples() -> Vec<Self> {
        vec![Penalty::default()]
    }
}
