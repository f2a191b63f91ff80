use serde::{Deserialize, Serialize};

use super::law::{NormalLaw, positive};
use crate::math::Slope;
use crate::registry::Samples;

/// Statistical micro-contact of rough surfaces, [Zavarise et al. 1992](stickslip_base::references::zavarise_1992) and the second
/// form of eq. (5) of [Pop 1995](stickslip_base::references::pop_1995). With `d = separation + gap` the distance of the mean planes:
///
/// `p(d) = c1 (1617646.152 σ/m)^c2 / 5.589^k · exp(-k d² / (1.363 σ)²)`, `k = 1 + 0.0711 c2`, lengths in metres.
///
/// The formula is even in `d` and would soften below its inflection `d* = 1.363 σ/√(2k)`; there it is continued along
/// its tangent. Beyond `5 σ` it ends in a parabola, so that the pressure is continuously differentiable and exactly zero
/// where the asperities no longer touch. The constant 1617646.152 makes the law dimensional: σ must be in metres.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct MicroContact {
    /// Vickers correlation coefficient c1 `[Pa]`.
    pub c1: f64,
    /// Vickers size index c2 `[-]`, negative for most metals.
    pub c2: f64,
    /// Combined root-mean-square roughness σ `[m]`.
    pub sigma: f64,
    /// Combined mean absolute asperity slope m `[-]`.
    pub slope: f64,
    /// Distance of the mean planes at zero gap `[m]`. Default: where the asperities just touch, about 5.4 σ.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub separation: Option<f64>,
}

impl MicroContact {
    fn k(&self) -> f64 {
        1.0 + 0.0711 * self.c2
    }

    fn formula(&self, d: f64) -> Slope {
        let k = self.k();
        let width = 1.363 * self.sigma;
        let p0 =
            self.c1 * (1_617_646.152 * self.sigma / self.slope).powf(self.c2) / 5.589_f64.powf(k);
        let value = p0 * (-k * (d / width).powi(2)).exp();
        Slope {
            value,
            slope: -2.0 * k * d / (width * width) * value,
        }
    }

    /// Below this distance the formula is replaced by its tangent.
    pub fn inflection(&self) -> f64 {
        1.363 * self.sigma / (2.0 * self.k()).sqrt()
    }

    fn tail(&self) -> (f64, f64, f64) {
        let start = 5.0 * self.sigma;
        let p = self.formula(start);
        (start, p.value, -2.0 * p.value / p.slope)
    }

    fn offset(&self) -> f64 {
        self.separation.unwrap_or_else(|| {
            let (start, _, length) = self.tail();
            start + length
        })
    }

    /// Pressure `[Pa]` and `dp/dd` `[Pa/m]` at a distance `d` `[m]` of the mean planes.
    pub fn at_distance(&self, d: f64) -> Slope {
        let d0 = self.inflection();
        if d < d0 {
            let p = self.formula(d0);
            return Slope {
                value: p.value + p.slope * (d - d0),
                slope: p.slope,
            };
        }
        let (start, p, length) = self.tail();
        if d <= start {
            return self.formula(d);
        }
        let s = 1.0 - (d - start) / length;
        if s <= 0.0 {
            return Slope::default();
        }
        Slope {
            value: p * s * s,
            slope: -2.0 * p * s / length,
        }
    }

    fn distance(&self, pressure: f64) -> f64 {
        let d0 = self.inflection();
        let p0 = self.formula(d0);
        if pressure >= p0.value {
            return d0 + (pressure - p0.value) / p0.slope;
        }
        let (start, p, length) = self.tail();
        if pressure <= p {
            return start + length * (1.0 - (pressure / p).sqrt());
        }
        let width = 1.363 * self.sigma;
        let peak = self.formula(0.0).value;
        width * ((peak / pressure).ln() / self.k()).sqrt()
    }
}

impl NormalLaw for MicroContact {
    fn pressure(&self, gap: f64) -> Option<Slope> {
        Some(self.at_distance(self.offset() + gap))
    }

    fn gap(&self, pressure: f64) -> Slope {
        let d = self.distance(pressure);
        Slope {
            value: d - self.offset(),
            slope: 1.0 / self.at_distance(d).slope,
        }
    }

    fn energy(&self, gap: f64) -> f64 {
        let d = self.offset() + gap;
        let (start, p, length) = self.tail();
        let end = start + length;
        if d >= end {
            return 0.0;
        }
        let tail = |d: f64| p * length / 3.0 * (1.0 - (d - start) / length).powi(3);
        if d >= start {
            return tail(d);
        }
        // ∫ formula from d to start, by composite Gauss-Legendre: the integrand is a smooth Gaussian.
        let d0 = self.inflection();
        let from = d.max(d0);
        let mut sum = tail(start);
        const PIECES: usize = 16;
        let h = (start - from) / PIECES as f64;
        for i in 0..PIECES {
            let mid = from + (i as f64 + 0.5) * h;
            for (x, w) in [
                (0.0, 8.0 / 9.0),
                (-0.6_f64.sqrt(), 5.0 / 9.0),
                (0.6_f64.sqrt(), 5.0 / 9.0),
            ] {
                sum += 0.5 * h * w * self.formula(mid + 0.5 * h * x).value;
            }
        }
        if d < d0 {
            let p = self.formula(d0);
            let x = d0 - d;
            sum += p.value * x - 0.5 * p.slope * x * x;
        }
        sum
    }

    fn faults(&self) -> Vec<(&'static str, String)> {
        let mut faults: Vec<_> = [
            positive("c1", self.c1),
            positive("sigma", self.sigma),
            positive("slope", self.slope),
        ]
        .into_iter()
        .flatten()
        .collect();
        if !(self.k() > 0.0 && self.c2.is_finite()) {
            faults.push((
                "c2",
                format!("1 + 0.0711 c2 must be positive; c2 is {}", self.c2),
            ));
        }
        if self.separation.is_some_and(|s| !s.is_finite()) {
            faults.push(("separation", "must be finite".into()));
        }
        faults
    }
}

impl Samples for MicroContact {
    fn samples() -> Vec<Self> {
        let steel = MicroContact {
            c1: 6271e6,
            c2: -0.229,
            sigma: 0.478e-6,
            slope: 0.072,
            separation: None,
        };
        vec![
            steel,
            MicroContact {
                separation: Some(1.2e-6),
                ..steel
            },
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reproduces_the_table() {
        // THEORY A2; d/σ = 0 and 1 lie on either side of the inflection at 0.97 σ, so the formula itself is checked there.
        let law = MicroContact::samples()[0];
        let table = [
            (0.0, 670.002_67, 0.0),
            (1.0, 394.557_89, -8.741_617_1e8),
            (2.0, 80.577_413, -3.570_461_6e8),
            (3.0, 5.706_690_2, -3.793_032_8e7),
            (4.0, 0.140_159_86, -1.242_123_3e6),
        ];
        for (ratio, p, slope) in table {
            let d = ratio * law.sigma;
            let formula = law.formula(d);
            assert!((formula.value / 1e6 / p - 1.0).abs() < 5e-8, "{ratio}");
            assert!(
                (formula.slope / 1e6 - slope).abs() <= 5e-8 * slope.abs(),
                "{ratio}"
            );
            if d >= law.inflection() {
                assert_eq!(law.at_distance(d), formula);
            }
        }
        assert!(law.at_distance(0.0).value > 670.0e6);
    }
}
