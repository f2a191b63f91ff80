use serde::{Deserialize, Serialize};

use super::law::{Extra, NormalDamping};
use crate::contact::law::normal::positive;
use crate::registry::Samples;

/// Damping in proportion to the pressure: `p (1 + coefficient ġ)` in all, with the closing velocity ġ
/// ([Hunt and Crossley 1975](stickslip_base::references::hunt_crossley_1975)).
///
/// The extra pressure is zero where contact begins and ends, so that nothing jumps. On a normal law that is a power of the
/// penetration a rigid mass that strikes at a velocity `v` comes back at about `v (1 - 2/3 coefficient v)`, whatever the
/// power, if that is a small loss.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct HuntCrossley {
    /// Extra pressure over pressure, per closing velocity `[s/m]`.
    pub coefficient: f64,
}

impl NormalDamping for HuntCrossley {
    fn extra(&self, pressure: f64, rate: f64) -> Extra {
        Extra {
            value: self.coefficient * pressure * rate,
            d_pressure: self.coefficient * rate,
            d_rate: self.coefficient * pressure,
        }
    }

    fn faults(&self) -> Vec<(&'static str, String)> {
        positive("coefficient", self.coefficient)
            .into_iter()
            .collect()
    }
}

impl Samples for HuntCrossley {
    fn samples() -> Vec<Self> {
        vec![HuntCrossley { coefficient: 0.3 }]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::law::normal::{NormalLaw, PowerLaw};

    /// The velocity at which a unit mass leaves that came at `v`, by steps of the midpoint rule.
    fn rebound(normal: &PowerLaw, damping: &HuntCrossley, v: f64, dt: f64) -> f64 {
        let acceleration = |x: f64, v: f64| {
            let p = normal.pressure(-x).map_or(f64::NAN, |p| p.value);
            -(p + damping.extra(p, v).value)
        };
        let (mut x, mut v) = (0.0, v);
        loop {
            let middle = v + 0.5 * dt * acceleration(x, v);
            v += dt * acceleration(x + 0.5 * dt * v, middle);
            x += dt * middle;
            if x <= 0.0 {
                return -v;
            }
        }
    }

    #[test]
    fn restitution_falls_with_the_speed_of_impact() {
        // Dividing m v dv/dx = -p (1 + χ v) by 1 + χ v and integrating from touch to release gives, for any p(x),
        // χ (v + e v) = ln((1 + χ v) / (1 - χ e v)).
        for m in [1.0, 2.0] {
            let normal = PowerLaw { c: 1e4, m };
            for (chi, v) in [(0.02, 1.0), (0.3, 1.0), (0.3, 2.0)] {
                let law = HuntCrossley { coefficient: chi };
                let back = rebound(&normal, &law, v, 1e-5);
                let balance = chi * (v + back) - ((1.0 + chi * v) / (1.0 - chi * back)).ln();
                assert!(balance.abs() < 1e-4 * chi * chi, "{m} {chi} {v}: {balance}");
                let e = 1.0 - 2.0 / 3.0 * chi * v;
                assert!((back / v - e).abs() < (chi * v).powi(2), "{m} {chi} {v}");
            }
        }
    }
}
