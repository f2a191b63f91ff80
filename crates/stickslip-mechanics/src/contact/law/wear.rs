use serde::{Deserialize, Serialize};

use super::normal::positive;

/// Wear after [Archard 1953](stickslip_base::references::archard_1953): a surface that slides by `ds` under a pressure `p` loses a layer of
/// depth `k p |ds|`. The depth is reported; it does not change the geometry.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Wear {
    /// Specific wear rate `k` of the secondary: volume lost over force and path `[1/Pa]`, Archard's dimensionless coefficient over the
    /// hardness.
    pub coefficient: f64,
    /// The same of the primary `[1/Pa]`, whose surface has a depth of its own. Default: 0, it does not wear.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub primary_coefficient: f64,
}

#[allow(clippy::trivially_copy_pass_by_ref)] // what serde asks for
fn is_zero(x: &f64) -> bool {
    *x == 0.0
}

impl Wear {
    /// What is wrong with the parameters, as `(key, message)`; empty if nothing.
    pub fn faults(&self) -> Vec<(&'static str, String)> {
        let mut faults: Vec<_> = positive("coefficient", self.coefficient)
            .into_iter()
            .collect();
        if self.primary_coefficient != 0.0 {
            faults.extend(positive("primary-coefficient", self.primary_coefficient));
        }
        faults
    }
}
