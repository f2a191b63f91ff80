use serde::{Deserialize, Serialize};

use super::law::{FrictionLaw, FrictionPoint, Limit};
use crate::contact::law::normal::positive;
use crate::registry::Samples;

/// Generalised friction `c δ^m`, at most `cap`, with the penetration δ: [Pop 1995](stickslip_base::references::pop_1995), eq. (6).
///
/// With the exponent of the normal compliance it is Coulomb's law with `μ = c / c_n`; otherwise the coefficient
/// depends on pressure. It needs a compliant normal law: without one the penetration has no meaning.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct PowerLaw {
    /// Coefficient c_T `[Pa/m^m]`.
    pub c: f64,
    /// Exponent m_T `[-]`, at least 1.
    pub m: f64,
    /// Largest shear traction `[Pa]`. Default: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cap: Option<f64>,
}

impl FrictionLaw for PowerLaw {
    fn limit(&self, at: &FrictionPoint) -> Limit {
        let d = at.penetration;
        if d <= 0.0 {
            return Limit::default();
        }
        Limit {
            value: self.c * d.powf(self.m),
            d_penetration: self.c * self.m * d.powf(self.m - 1.0),
            ..Limit::default()
        }
        .capped(self.cap)
    }

    fn needs_penetration(&self) -> bool {
        true
    }

    fn faults(&self) -> Vec<(&'static str, String)> {
        let mut faults: Vec<_> = positive("c", self.c).into_iter().collect();
        if !(self.m >= 1.0 && self.m.is_finite()) {
            faults.push(("m", format!("must be at least 1, not {}", self.m)));
        }
        faults.extend(self.cap.and_then(|cap| positive("cap", cap)));
        faults
    }
}

impl Samples for PowerLaw {
    fn samples() -> Vec<Self> {
        vec![
            PowerLaw {
                c: 0.5e20,
                m: 2.0,
                cap: None,
            },
            PowerLaw {
                c: 1e15,
                m: 1.0,
                cap: Some(2e8),
            },
        ]
    }
}
