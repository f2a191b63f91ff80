//! Laws that a program brings along instead of choosing them from the families: functions of many points at once.
//!
//! They are for prototypes. What a function does not say is found numerically: derivatives by differences, the inverse by bisection, the
//! energy by quadrature.

use std::fmt;
use std::sync::Arc;

use super::friction::{FrictionLaw, FrictionPoint, Limit};
use super::normal::NormalLaw;
use crate::math::Slope;

/// Pressure against gap, at many points at once; falling and zero far from the surface.
pub trait PressureFunction: Send + Sync {
    /// Pressures `[Pa]` at gaps `[m]`, and their derivatives `[Pa/m]` if the function knows them. A list of another length counts as
    /// not finite.
    fn pressures(&self, gaps: &[f64]) -> (Vec<f64>, Option<Vec<f64>>);
}

/// Limit of the shear traction, at many points at once.
pub trait LimitFunction: Send + Sync {
    /// Limits `[Pa]` at pressures `[Pa]` and sliding speeds `[m/s]`, and their derivatives by both if the function knows them. A list of
    /// another length counts as not finite.
    fn limits(&self, pressures: &[f64], speeds: &[f64]) -> (Vec<f64>, Option<[Vec<f64>; 2]>);
}

/// The laws of an interface that a program has brought along; they take the place of those of the problem.
#[derive(Clone, Default)]
pub struct UserLaws {
    /// Pressure against gap.
    pub normal: Option<UserNormal>,
    /// Limit of the shear traction.
    pub friction: Option<UserFriction>,
}

impl UserLaws {
    /// Whether there are any.
    pub fn any(&self) -> bool {
        self.normal.is_some() || self.friction.is_some()
    }
}

impl fmt::Debug for UserLaws {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (normal, friction) = (self.normal.is_some(), self.friction.is_some());
        write!(f, "Own {{ normal: {normal}, friction: {friction} }}")
    }
}

impl PartialEq for UserLaws {
    fn eq(&self, other: &Self) -> bool {
        let normal = match (&self.normal, &other.normal) {
            (Some(a), Some(b)) => Arc::ptr_eq(&a.function, &b.function),
            (a, b) => a.is_none() && b.is_none(),
        };
        let friction = match (&self.friction, &other.friction) {
            (Some(a), Some(b)) => Arc::ptr_eq(&a.function, &b.function),
            (a, b) => a.is_none() && b.is_none(),
        };
        normal && friction
    }
}

/// Step of a difference relative to the argument. The error of a central difference in double precision is least near the cube root of an
/// epsilon, 6e-6.
const DIFFERENCE_STEP: f64 = 1e-6;
/// The same relative to the length of an interface, for gaps near zero: that of gaps of 1e-5 of this length. Between 3e-13 and 1e-8 the tests of laws of
/// programs pass.
const GAP_STEP: f64 = 1e-11;

/// Nodes and weights of Gauss' rule of five points on `[0, 1]`.
const GAUSS: [(f64, f64); 5] = [
    (0.046_910_077_030_668, 0.118_463_442_528_094_5),
    (0.230_765_344_947_158_5, 0.239_314_335_249_683_2),
    (0.5, 0.284_444_444_444_444_4),
    (0.769_234_655_052_841_5, 0.239_314_335_249_683_2),
    (0.953_089_922_969_332, 0.118_463_442_528_094_5),
];
/// Pieces between a gap and the surface in which the energy is integrated.
const ENERGY_PIECES: usize = 4;
/// Pieces of the tail of a law beyond the surface, each four times as long as the last, up to the length of the interface.
const TAIL: usize = 20;

/// A normal law from a function.
#[derive(Clone)]
pub struct UserNormal {
    function: Arc<dyn PressureFunction>,
    /// A length `[m]` that gaps are small against, the mean height of the cells beneath.
    length: f64,
}

/// A list of the wanted length, all NaN if it has another.
fn sized(values: Vec<f64>, count: usize) -> Vec<f64> {
    match values.len() == count {
        true => values,
        false => vec![f64::NAN; count],
    }
}

impl UserNormal {
    /// The law of a function; `length` is one that gaps are small against `[m]`.
    pub fn new(function: Arc<dyn PressureFunction>, length: f64) -> Self {
        UserNormal { function, length }
    }

    fn values(&self, gaps: &[f64]) -> Vec<f64> {
        match gaps.is_empty() {
            true => Vec::new(),
            false => sized(self.function.pressures(gaps).0, gaps.len()),
        }
    }

    /// Pressures and derivatives at gaps `[m]`.
    pub fn pressures(&self, gaps: &[f64]) -> Vec<Slope> {
        if gaps.is_empty() {
            return Vec::new();
        }
        let (values, slopes) = self.function.pressures(gaps);
        let values = sized(values, gaps.len());
        let slopes = match slopes {
            Some(slopes) => sized(slopes, gaps.len()),
            None => {
                let steps: Vec<f64> = gaps
                    .iter()
                    .map(|g| DIFFERENCE_STEP * g.abs() + GAP_STEP * self.length)
                    .collect();
                let beside = |sign: f64| gaps.iter().zip(&steps).map(move |(g, h)| g + sign * h);
                let at: Vec<f64> = beside(1.0).chain(beside(-1.0)).collect();
                let around = self.values(&at);
                let (after, before) = around.split_at(gaps.len());
                let pairs = after.iter().zip(before).zip(&steps);
                pairs.map(|((a, b), h)| (a - b) / (2.0 * h)).collect()
            }
        };
        let both = values.into_iter().zip(slopes);
        both.map(|(value, slope)| Slope { value, slope }).collect()
    }

    /// Recoverable energies per area `[J/m²]` at gaps.
    pub fn energies(&self, gaps: &[f64]) -> Vec<f64> {
        let here = self.values(gaps);
        let mut at = Vec::new();
        let mut weights = Vec::new();
        let mut piece = |from: f64, to: f64, whose: usize| {
            for (x, w) in GAUSS {
                at.push(from + x * (to - from));
                weights.push((whose, w * (to - from)));
            }
        };
        let far = gaps.iter().zip(&here).map(|(g, p)| (*g, *p > 0.0));
        for (i, (gap, carries)) in far.enumerate() {
            if !carries || !gap.is_finite() {
                continue;
            }
            if gap < 0.0 {
                let part = -gap / ENERGY_PIECES as f64;
                for k in 0..ENERGY_PIECES {
                    piece(gap + k as f64 * part, gap + (k + 1) as f64 * part, i);
                }
            } else {
                self.tail(gap, &mut |a, b| piece(a, b, i));
            }
        }
        // What lies beyond the surface is the same for all that penetrate.
        let whole = gaps.len();
        self.tail(0.0, &mut |a, b| piece(a, b, whole));
        let mut sums = vec![0.0; whole + 1];
        for ((whose, w), p) in weights.into_iter().zip(self.values(&at)) {
            sums[whose] += w * p;
        }
        let tail = sums.pop().unwrap_or_default();
        for ((sum, gap), p) in sums.iter_mut().zip(gaps).zip(&here) {
            if *gap < 0.0 && *p > 0.0 {
                *sum += tail;
            }
        }
        sums
    }

    fn tail(&self, from: f64, piece: &mut dyn FnMut(f64, f64)) {
        let mut length = self.length * 0.25_f64.powi(TAIL as i32);
        let mut at = from;
        for _ in 0..TAIL {
            piece(at, at + length);
            at += length;
            length *= 4.0;
        }
    }
}

impl NormalLaw for UserNormal {
    fn pressure(&self, gap: f64) -> Option<Slope> {
        self.pressures(&[gap]).pop()
    }

    fn gap(&self, pressure: f64) -> Slope {
        let value = |gap: f64| self.values(&[gap]).pop().unwrap_or(f64::NAN);
        let (mut low, mut high) = (-GAP_STEP * self.length, self.length);
        while value(low) < pressure && low > -self.length {
            low *= 4.0;
        }
        for _ in 0..100 {
            let middle = 0.5 * (low + high);
            if value(middle) < pressure {
                high = middle;
            } else {
                low = middle;
            }
        }
        let slope = self.pressure(low).unwrap_or_default().slope;
        Slope {
            value: low,
            slope: 1.0 / slope,
        }
    }

    fn energy(&self, gap: f64) -> f64 {
        self.energies(&[gap]).pop().unwrap_or_default()
    }

    fn faults(&self) -> Vec<(&'static str, String)> {
        Vec::new()
    }
}

/// A friction law from a function.
#[derive(Clone)]
pub struct UserFriction {
    function: Arc<dyn LimitFunction>,
}

impl UserFriction {
    /// The law of a function.
    pub fn new(function: Arc<dyn LimitFunction>) -> Self {
        UserFriction { function }
    }

    /// Limits and derivatives at many points. At zero pressure or speed the derivative by it is taken as zero where the function does
    /// not say it.
    pub fn limits(&self, points: &[FrictionPoint]) -> Vec<Limit> {
        let n = points.len();
        if n == 0 {
            return Vec::new();
        }
        let pressures: Vec<f64> = points.iter().map(|p| p.pressure).collect();
        let speeds: Vec<f64> = points.iter().map(|p| p.speed).collect();
        let (values, slopes) = self.function.limits(&pressures, &speeds);
        let values = sized(values, n);
        let [by_pressure, by_speed] = match slopes {
            Some(slopes) => slopes.map(|s| sized(s, n)),
            None => {
                let beside = |of: &[f64], sign: f64| -> Vec<f64> {
                    of.iter()
                        .map(|x| x * (1.0 + sign * DIFFERENCE_STEP))
                        .collect()
                };
                let p = [beside(&pressures, 1.0), beside(&pressures, -1.0)];
                let v = [beside(&speeds, 1.0), beside(&speeds, -1.0)];
                let at_p = [&p[0], &p[1], &pressures, &pressures].map(Vec::as_slice);
                let at_v = [&speeds, &speeds, &v[0], &v[1]].map(Vec::as_slice);
                let (around, _) = self.function.limits(&at_p.concat(), &at_v.concat());
                let around = sized(around, 4 * n);
                let slope = |first: usize, of: &[f64]| -> Vec<f64> {
                    let pairs = around[first..first + n].iter().zip(&around[first + n..]);
                    let both = pairs.zip(of);
                    both.map(|((a, b), x)| match *x > 0.0 {
                        true => (a - b) / (2.0 * DIFFERENCE_STEP * x),
                        false => 0.0,
                    })
                    .collect()
                };
                [slope(0, &pressures), slope(2 * n, &speeds)]
            }
        };
        (0..n)
            .map(|i| Limit {
                value: values[i],
                d_pressure: by_pressure[i],
                d_speed: by_speed[i],
                ..Limit::default()
            })
            .collect()
    }
}

impl FrictionLaw for UserFriction {
    fn limit(&self, at: &FrictionPoint) -> Limit {
        self.limits(&[*at]).pop().unwrap_or_default()
    }

    fn faults(&self) -> Vec<(&'static str, String)> {
        Vec::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Power;

    impl PressureFunction for Power {
        fn pressures(&self, gaps: &[f64]) -> (Vec<f64>, Option<Vec<f64>>) {
            let law = |g: &f64| 1e16 * (-g).max(0.0).powi(2);
            (gaps.iter().map(law).collect(), None)
        }
    }

    struct Exponential;

    impl PressureFunction for Exponential {
        fn pressures(&self, gaps: &[f64]) -> (Vec<f64>, Option<Vec<f64>>) {
            let law = |g: &f64| 1e6 * (-g / 1e-6).exp();
            (gaps.iter().map(law).collect(), None)
        }
    }

    impl LimitFunction for Power {
        fn limits(&self, p: &[f64], v: &[f64]) -> (Vec<f64>, Option<[Vec<f64>; 2]>) {
            let law = |(p, v): (&f64, &f64)| 0.3 * p / (1.0 + v);
            (p.iter().zip(v).map(law).collect(), None)
        }
    }

    #[test]
    fn slope_inverse_and_energy_follow_from_the_function() {
        let law = UserNormal::new(Arc::new(Power), 1e-3);
        let p = law.pressure(-2e-6).unwrap();
        assert!((p.value / 4e4 - 1.0).abs() < 1e-14);
        assert!((p.slope / -4e10 - 1.0).abs() < 1e-6, "{p:?}");
        assert!((law.gap(4e4).value / -2e-6 - 1.0).abs() < 1e-9);
        let wanted = 1e16 * 8e-18 / 3.0;
        assert!((law.energy(-2e-6) / wanted - 1.0).abs() < 1e-12);
        assert_eq!(law.energy(1e-6), 0.0);
    }

    #[test]
    fn the_energy_counts_what_acts_beyond_the_surface() {
        let law = UserNormal::new(Arc::new(Exponential), 1e-3);
        for gap in [-3e-6, 0.0, 2e-6] {
            let wanted = (-gap / 1e-6_f64).exp();
            assert!((law.energy(gap) / wanted - 1.0).abs() < 1e-3, "{gap}");
        }
    }

    #[test]
    fn limits_have_derivatives() {
        let law = UserFriction::new(Arc::new(Power));
        let at = FrictionPoint {
            pressure: 2e6,
            speed: 0.5,
            ..FrictionPoint::default()
        };
        let limit = law.limit(&at);
        assert!((limit.d_pressure / 0.2 - 1.0).abs() < 1e-6);
        assert!((limit.d_speed / (-6e5 / 2.25) - 1.0).abs() < 1e-6);
        let still = law.limit(&FrictionPoint { speed: 0.0, ..at });
        assert_eq!(still.d_speed, 0.0);
    }
}
