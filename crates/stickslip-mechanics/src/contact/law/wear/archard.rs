use serde::{Deserialize, Serialize};

use super::law::{WearLaw, WearPoint, WearRate, coefficients, is_zero, negative};
use crate::contact::law::normal::positive;
use crate::registry::Samples;

/// Wear after [Archard 1953](stickslip_base::references::archard_1953): a surface that slides by `ds` under a pressure `p` loses a layer of
/// depth `k p |ds|`.
///
/// A surface that runs in wears faster at first, by the factor `1 + running-in exp(-s / running-in-path)` after a path `s`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Archard {
    /// Specific wear rate `k` of the secondary: volume lost over force and path `[1/Pa]`, Archard's dimensionless coefficient over the
    /// hardness.
    pub coefficient: f64,
    /// The same of the primary `[1/Pa]`, whose surface has a depth of its own. Default: 0, it does not wear.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub primary_coefficient: f64,
    /// By what part of the coefficients both surfaces wear faster at first `[-]`. Default: 0.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub running_in: f64,
    /// Path over which they do `[m]`; needed with `running-in`.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub running_in_path: f64,
}

/// `(1 - e^-x) / x`, the mean of `e^-t` up to `x`.
fn mean_decay(x: f64) -> f64 {
    match x == 0.0 {
        true => 1.0,
        false => -(-x).exp_m1() / x,
    }
}

impl WearLaw for Archard {
    fn rates(&self, at: &WearPoint) -> [WearRate; 2] {
        let faster = match self.running_in {
            0.0 => 1.0,
            part => {
                let [path, way] = [at.path, at.way].map(|s| s / self.running_in_path);
                1.0 + part * (-path).exp() * mean_decay(way)
            }
        };
        [self.coefficient, self.primary_coefficient].map(|k| WearRate::pressed(faster * k))
    }

    fn faults(&self) -> Vec<(&'static str, String)> {
        let mut faults = coefficients([self.coefficient, self.primary_coefficient]);
        faults.extend(negative([("running-in", self.running_in)]));
        match self.running_in != 0.0 {
            true => faults.extend(positive("running-in-path", self.running_in_path)),
            false if self.running_in_path != 0.0 => faults.push((
                "running-in-path",
                "has no meaning without `running-in`".into(),
            )),
            false => {}
        }
        faults
    }
}

impl Samples for Archard {
    fn samples() -> Vec<Self> {
        let plain = Archard {
            coefficient: 2.9e-14,
            primary_coefficient: 1.9e-14,
            running_in: 0.0,
            running_in_path: 0.0,
        };
        vec![
            plain,
            Archard {
                running_in: 2.0,
                running_in_path: 0.1,
                ..plain
            },
        ]
    }
}
