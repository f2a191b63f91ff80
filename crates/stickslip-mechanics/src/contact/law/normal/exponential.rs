use serde::{Deserialize, Serialize};

use super::law::{NormalLaw, positive};
use crate::math::Slope;
use crate::registry::Samples;

/// Exponential compliance `p = p0 exp(-ln(100) gap / c0)`: `p0` where the gap closes, a hundredth of it at the clearance `c0`.
///
/// This is the law of `PRESSURE-OVERCLOSURE=EXPONENTIAL` in CalculiX, which drops what little pressure there is beyond `c0`. A jump has no equilibrium:
/// here the tangent at `c0` goes on until it meets zero, at a clearance of 1.217 `c0`. Beyond a penetration of 5 `c0`, where the pressure is 10¹⁰ `p0`,
/// the curve goes on as its tangent as well.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Exponential {
    /// Clearance at which the pressure is `p0 / 100` `[m]`.
    pub c0: f64,
    /// Pressure at zero gap `[Pa]`.
    pub p0: f64,
}

impl Exponential {
    /// `ln(100) / c0` `[1/m]`.
    fn rate(&self) -> f64 {
        100.0_f64.ln() / self.c0
    }

    /// The part of the gap in which the pressure is an exponential.
    fn curved(&self) -> [f64; 2] {
        // The curve is a straight line from a penetration of five times `c0` on.
        [-5.0 * self.c0, self.c0]
    }

    fn exponential(&self, gap: f64) -> f64 {
        self.p0 * (-self.rate() * gap).exp()
    }
}

impl NormalLaw for Exponential {
    fn pressure(&self, gap: f64) -> Option<Slope> {
        let [from, to] = self.curved();
        let at = gap.max(from).min(to);
        let value = self.exponential(at);
        let slope = -self.rate() * value;
        let value = value + slope * (gap - at);
        Some(match value > 0.0 {
            true => Slope { value, slope },
            false => Slope::default(),
        })
    }

    fn gap(&self, pressure: f64) -> Slope {
        let [from, to] = self.curved();
        let free = -(pressure / self.p0).ln() / self.rate();
        let at = free.max(from).min(to);
        let value = self.exponential(at);
        let slope = -1.0 / (self.rate() * value);
        Slope {
            // on the curve itself the difference is rounding
            value: match free == at {
                true => at,
                false => at + slope * (pressure - value),
            },
            slope,
        }
    }

    fn energy(&self, gap: f64) -> f64 {
        let [from, to] = self.curved();
        let tail = self.exponential(to) / self.rate();
        if gap > to {
            let left = (1.0 - self.rate() * (gap - to)).max(0.0);
            return 0.5 * tail * left * left;
        }
        let at = gap.max(from);
        let p = self.exponential(at);
        let deeper = at - gap;
        let straight = deeper * (p + 0.5 * self.rate() * p * deeper);
        0.5 * tail + (p / self.rate() - tail) + straight
    }

    fn faults(&self) -> Vec<(&'static str, String)> {
        [("c0", self.c0), ("p0", self.p0)]
            .into_iter()
            .filter_map(|(key, value)| positive(key, value))
            .collect()
    }
}

impl Samples for Exponential {
    fn samples() -> Vec<Self> {
        vec![Exponential { c0: 1e-5, p0: 1e7 }]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAW: Exponential = Exponential { c0: 1e-5, p0: 1e7 };

    fn at(gap: f64) -> f64 {
        LAW.pressure(gap).unwrap().value
    }

    #[test]
    fn the_two_points_that_define_it_are_on_the_curve() {
        assert!((at(0.0) - 1e7).abs() < 1e-6);
        assert!((at(1e-5) - 1e5).abs() < 1e-7);
        assert!((at(-1e-5) / 1e9 - 1.0).abs() < 1e-12);
    }

    #[test]
    fn the_ends_are_straight_and_meet_the_curve_without_a_kink() {
        for joint in [1e-5, -5e-5] {
            let [below, above] = [-1e-9, 1e-9].map(|h| LAW.pressure(joint + h * 1e-5).unwrap());
            assert!((below.value / above.value - 1.0).abs() < 1e-7);
            assert!((below.slope / above.slope - 1.0).abs() < 1e-7);
        }
        assert_eq!(at(1.2172e-5), 0.0);
        assert!(at(1.2171e-5) > 0.0);
        assert!(at(-1.0).is_finite());
    }

    #[test]
    fn inverse_and_energy_follow_it_everywhere() {
        for gap in [1.2e-5, 1.1e-5, 0.9e-5, 0.0, -2e-5, -4.9e-5, -5.1e-5, -8e-5] {
            let p = LAW.pressure(gap).unwrap();
            let inverse = LAW.gap(p.value);
            assert!((inverse.value - gap).abs() < 1e-17, "{gap}");
            assert!((inverse.slope * p.slope - 1.0).abs() < 1e-12, "{gap}");
            let h = 1e-10;
            let work = (LAW.energy(gap - h) - LAW.energy(gap + h)) / (2.0 * h);
            assert!((work / p.value - 1.0).abs() < 1e-5, "{gap}");
        }
    }
}
