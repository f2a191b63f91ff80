use serde::{Deserialize, Serialize};

use super::law::{NormalLaw, positive};
use crate::math::Slope;
use crate::registry::Samples;

/// Normal compliance `p = c δ^m` with the penetration `δ = max(0, -gap)`:
/// [Pop 1995](stickslip_base::references::pop_1995), eq. (5); [Oden and Martins 1985](stickslip_base::references::oden_martins_1985),
/// who find `m` between 2 and 3.33 for metal surfaces.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct PowerLaw {
    /// Coefficient c_n `[Pa/m^m]`.
    pub c: f64,
    /// Exponent m_n `[-]`, at least 1.
    pub m: f64,
}

impl NormalLaw for PowerLaw {
    fn pressure(&self, gap: f64) -> Option<Slope> {
        let d = (-gap).max(0.0);
        Some(if d > 0.0 {
            Slope {
                value: self.c * d.powf(self.m),
                slope: -self.c * self.m * d.powf(self.m - 1.0),
            }
        } else {
            Slope::default()
        })
    }

    fn gap(&self, pressure: f64) -> Slope {
        let d = (pressure / self.c).powf(1.0 / self.m);
        Slope {
            value: -d,
            slope: -d / (self.m * pressure),
        }
    }

    fn energy(&self, gap: f64) -> f64 {
        self.c * (-gap).max(0.0).powf(self.m + 1.0) / (self.m + 1.0)
    }

    fn faults(&self) -> Vec<(&'static str, String)> {
        let mut faults: Vec<_> = positive("c", self.c).into_iter().collect();
        if !(self.m >= 1.0 && self.m.is_finite()) {
            faults.push(("m", format!("must be at least 1, not {}", self.m)));
        }
        faults
    }
}

impl Samples for PowerLaw {
    fn samples() -> Vec<Self> {
        vec![
            PowerLaw { c: 1e15, m: 1.0 },
            PowerLaw { c: 1e20, m: 2.0 },
            PowerLaw { c: 1e23, m: 2.5 },
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn uniform_pressure_gives_the_known_penetration() {
        // VERIFICATION B7: 50 MPa on c = 1e20 Pa/m², m = 2
        let law = PowerLaw { c: 1e20, m: 2.0 };
        assert!((law.gap(50e6).value + 7.071_067_81e-7).abs() < 1e-15);
    }
}
