use std::f64::consts::TAU;
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::model::{Heights, Relief, RoughnessModel, positive};
use super::random::Random;
use crate::error::Error;
use crate::registry::Samples;

/// A random self-affine surface: waves of random phase whose power falls with the wave number like `q^(-2H-2)`, in a profile `q^(-2H-1)`,
/// between a longest and a shortest wavelength ([Persson 2001](stickslip_base::references::persson_2001)).
///
/// It repeats itself after its period, has no grid, and is the same on every machine for the same seed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct SelfAffine {
    /// Length after which it repeats itself, along each axis `[length]`; one number is for both.
    pub period: Vec<f64>,
    /// The longest wave, from which on the power of waves falls `[length]`. Default: the period.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub longest: Option<f64>,
    /// The shortest wave: a few times the distance of nodes, or they will not show it `[length]`.
    pub shortest: f64,
    /// Hurst exponent `[-]`, above 0 and up to 1; most surfaces have 0.7 to 0.9.
    pub hurst: f64,
    /// Root mean square of heights `[length]`. Give this or `slope`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rms: Option<f64>,
    /// Root mean square of the gradient `[-]`, of both axes together.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub slope: Option<f64>,
    /// Which of all such surfaces. Default: 0.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub seed: u32,
}

#[allow(clippy::trivially_copy_pass_by_ref)] // what serde asks for
fn is_zero(seed: &u32) -> bool {
    *seed == 0
}

/// Most waves along an axis: what more would take is better read from a file.
const MOST_WAVES: f64 = 512.0;

/// One wave: how often it fits into the periods, and its amplitudes.
#[derive(Debug, Clone, Copy)]
struct Mode {
    times: [i32; 2],
    cos: f64,
    sin: f64,
}

/// A sum of waves.
#[derive(Debug)]
struct Waves {
    period: [f64; 2],
    most: [usize; 2],
    modes: Vec<Mode>,
}

impl SelfAffine {
    fn periods(&self) -> [f64; 2] {
        let first = self.period.first().copied().unwrap_or(1.0);
        [first, self.period.get(1).copied().unwrap_or(first)]
    }

    fn longest(&self) -> f64 {
        let [a, b] = self.periods();
        self.longest.unwrap_or(a.max(b))
    }

    fn waves(&self, profile: bool) -> Waves {
        let period = self.periods();
        let most = period.map(|p| (p / self.shortest) as usize);
        let across = if profile { 0 } else { most[1] as i32 };
        let mut random = Random(u64::from(self.seed));
        let (mut modes, mut heights, mut slopes) = (Vec::new(), 0.0, 0.0);
        let power = if profile { 0.5 } else { 1.0 } + self.hurst;
        // A wave and the one against it are the same: half of the plane.
        for i in 0..=most[0] as i32 {
            for j in -across..=across {
                let phase = TAU * random.unit();
                let q = TAU * (f64::from(i) / period[0]).hypot(f64::from(j) / period[1]);
                if (i == 0 && j <= 0) || q > TAU / self.shortest * (1.0 + 1e-12) {
                    continue;
                }
                let a = q.max(TAU / self.longest()).powf(-power);
                heights += 0.5 * a * a;
                slopes += 0.5 * (a * q).powi(2);
                modes.push(Mode {
                    times: [i, j],
                    cos: a * phase.cos(),
                    sin: a * phase.sin(),
                });
            }
        }
        let scale = match (self.rms, self.slope) {
            (Some(rms), _) => rms / heights.sqrt(),
            (None, slope) => slope.unwrap_or(0.0) / slopes.sqrt(),
        };
        for mode in &mut modes {
            mode.cos *= scale;
            mode.sin *= scale;
        }
        Waves {
            period,
            most,
            modes,
        }
    }
}

/// `e^(i k x)` for `k` from 0 to `most`.
fn powers(x: f64, most: usize) -> Vec<[f64; 2]> {
    let angles = (0..=most).map(|k| (k as f64 * x).sin_cos());
    angles.map(|(sin, cos)| [cos, sin]).collect()
}

impl Heights for Waves {
    fn at(&self, place: [f64; 2]) -> Option<f64> {
        let along = |i: usize| powers(TAU * place[i] / self.period[i], self.most[i]);
        let (first, second) = (along(0), along(1));
        let height = self.modes.iter().map(|mode| {
            let [a, b] = first[mode.times[0] as usize];
            let [c, d] = second[mode.times[1].unsigned_abs() as usize];
            let d = if mode.times[1] < 0 { -d } else { d };
            mode.cos * (a * c - b * d) - mode.sin * (a * d + b * c)
        });
        Some(height.sum())
    }
}

impl RoughnessModel for SelfAffine {
    fn heights(&self, _: &Path, profile: bool) -> Result<Relief, Error> {
        Ok(self.waves(profile).into())
    }

    fn shortest(&self) -> Option<f64> {
        Some(self.shortest)
    }

    fn faults(&self, dim: usize) -> Vec<(&'static str, String)> {
        let mut faults = Vec::new();
        if !(1..dim).contains(&self.period.len()) {
            let (count, most) = (self.period.len(), dim - 1);
            faults.push(("period", format!("has {count} lengths; give 1 to {most}")));
        }
        for period in &self.period {
            faults.extend(positive("period", *period));
        }
        faults.extend(positive("shortest", self.shortest));
        faults.extend(self.longest.and_then(|l| positive("longest", l)));
        if !(self.hurst > 0.0 && self.hurst <= 1.0) {
            let message = format!("is {} and has to be above 0 and at most 1", self.hurst);
            faults.push(("hurst", message));
        }
        match (self.rms, self.slope) {
            (Some(rms), None) => faults.extend(positive("rms", rms)),
            (None, Some(slope)) => faults.extend(positive("slope", slope)),
            _ => faults.push(("rms", "or `slope` has to be given, and not both".into())),
        }
        if !faults.is_empty() {
            return faults;
        }
        let [a, b] = self.periods();
        if self.shortest > a.min(b) || self.shortest > self.longest() {
            let message =
                "is longer than the period or the longest wave: there is no wave between them";
            faults.push(("shortest", message.into()));
        }
        if a.max(b) / self.shortest > MOST_WAVES {
            let message =
                format!("is so short that more than {MOST_WAVES} waves fit into a period");
            faults.push(("shortest", message));
        }
        faults
    }
}

impl Samples for SelfAffine {
    fn samples() -> Vec<Self> {
        vec![SelfAffine {
            period: vec![1e-3],
            longest: Some(5e-4),
            shortest: 5e-5,
            hurst: 0.8,
            rms: Some(1e-6),
            slope: None,
            seed: 3,
        }]
    }
}

#[cfg(test)]
mod tests {
    use super::super::Statistics;
    use super::*;

    /// Heights and gradients have the figures that were asked for, by finite differences on a grid that shares nothing with the sum of squares; the power falls as
    /// it should, by a Fourier transform of the grid; seeds differ; the period is one.
    #[test]
    fn a_surface_has_the_figures_asked_for() {
        let n = 96;
        for profile in [false, true] {
            let surface = SelfAffine {
                period: vec![2.0],
                longest: Some(1.0),
                shortest: 0.1,
                hurst: 0.7,
                rms: None,
                slope: Some(0.2),
                seed: 5,
            };
            let heights = surface
                .heights(Path::new(""), profile)
                .expect("heights")
                .heights;
            let rows = if profile { 1 } else { n };
            let h = 2.0 / n as f64;
            let at =
                |i: usize, j: usize| heights.at([i as f64 * h, j as f64 * h]).expect("a height");
            let grid: Vec<f64> = (0..rows)
                .flat_map(|j| (0..n).map(move |i| (i, j)))
                .map(|(i, j)| at(i, j))
                .collect();
            // The gradient by central differences a thousandth of the shortest wave apart.
            let e = 1e-4;
            let slope = |i: usize, j: usize| -> f64 {
                let x = [i as f64 * h, j as f64 * h];
                let d = |k: usize| {
                    let mut a = x;
                    let mut b = x;
                    a[k] += e;
                    b[k] -= e;
                    (heights.at(a).expect("a height") - heights.at(b).expect("a height"))
                        / (2.0 * e)
                };
                d(0).powi(2) + if profile { 0.0 } else { d(1).powi(2) }
            };
            let mean: f64 = (0..rows)
                .flat_map(|j| (0..n).map(move |i| (i, j)))
                .map(|(i, j)| slope(i, j))
                .sum::<f64>()
                / grid.len() as f64;
            assert!((mean.sqrt() / 0.2 - 1.0).abs() < 1e-5, "{}", mean.sqrt());
            // Over whole periods the mean is zero and waves do not mix.
            let figures = Statistics::of(n, rows, [h, h], &grid);
            assert!(figures.mean.abs() < 1e-12 * figures.rq);
            let power = |k: usize| -> f64 {
                let angle = |i: usize| TAU * (k * i) as f64 / n as f64;
                let [c, s] = [f64::cos, f64::sin]
                    .map(|f| (0..n).map(|i| grid[i] * f(angle(i))).sum::<f64>());
                c * c + s * s
            };
            if profile {
                let exponent = (power(16) / power(8)).log2();
                assert!((exponent + 2.0 * 0.7 + 1.0).abs() < 1e-6, "{exponent}");
                let longer = power(1) / power(2);
                assert!(
                    (longer - 1.0).abs() < 1e-6,
                    "no longer than the longest: {longer}"
                );
            }
            let far = heights.at([0.3 + 4.0, 0.7 - 2.0]).expect("a height");
            assert!((far - heights.at([0.3, 0.7]).expect("a height")).abs() < 1e-9);
            let other = SelfAffine { seed: 6, ..surface };
            let other = other
                .heights(Path::new(""), profile)
                .expect("heights")
                .heights;
            assert!((other.at([0.3, 0.7]).expect("a height") - far).abs() > 1e-3 * figures.rq);
        }
    }
}
