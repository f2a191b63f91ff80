//! Stress from strain in several cells: a shortcut for isotropic materials, and any other tensor.

use pulp::Simd;

use super::lane::Lane;
use crate::material::Stiffness;

/// A linear law.
pub trait Law: Copy + Send + Sync + 'static {
    /// `factor · C e`, with `V` components in the order of [`material`](crate::material).
    fn stress<S: Simd, const V: usize>(
        &self,
        simd: S,
        e: &[Lane<S>; V],
        factor: Lane<S>,
    ) -> [Lane<S>; V];

    /// The law times a number.
    fn scaled(self, factor: f64) -> Self;
}

/// The same in all directions: Lamé's constants `[Pa]`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Isotropic {
    lambda: f64,
    mu: f64,
}

impl Isotropic {
    /// The constants of a stiffness, if it is isotropic but for rounding.
    pub fn of(c: &Stiffness) -> Option<Self> {
        let (lambda, mu) = (c[0][1], c[3][3]);
        let scale = c.iter().flatten().fold(0.0_f64, |m, x| m.max(x.abs()));
        let mut fits = true;
        for (v, row) in c.iter().enumerate() {
            for (w, &entry) in row.iter().enumerate() {
                let expected = match (v == w, v < 3 && w < 3) {
                    (true, true) => lambda + 2.0 * mu,
                    (false, true) => lambda,
                    (true, false) => mu,
                    (false, false) => 0.0,
                };
                fits &= (entry - expected).abs() <= 4.0 * f64::EPSILON * scale;
            }
        }
        fits.then_some(Isotropic { lambda, mu })
    }
}

impl Law for Isotropic {
    #[inline(always)]
    fn stress<S: Simd, const V: usize>(
        &self,
        simd: S,
        e: &[Lane<S>; V],
        factor: Lane<S>,
    ) -> [Lane<S>; V] {
        let lambda = Lane::splat(simd, self.lambda) * factor;
        let mu = Lane::splat(simd, self.mu) * factor;
        let pressure = lambda * (e[0] + e[1] + e[2]);
        let twice = mu + mu;
        let mut s = *e;
        for v in 0..V {
            s[v] = if v < 3 {
                twice.times_plus(e[v], pressure)
            } else {
                mu * e[v]
            };
        }
        s
    }

    fn scaled(self, factor: f64) -> Self {
        Isotropic {
            lambda: factor * self.lambda,
            mu: factor * self.mu,
        }
    }
}

/// Any tensor `[Pa]`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct General(pub Stiffness);

impl Law for General {
    #[inline(always)]
    fn stress<S: Simd, const V: usize>(
        &self,
        simd: S,
        e: &[Lane<S>; V],
        factor: Lane<S>,
    ) -> [Lane<S>; V] {
        let mut scaled = *e;
        for v in 0..V {
            scaled[v] = e[v] * factor;
        }
        let mut s = scaled;
        for v in 0..V {
            s[v] = Lane::splat(simd, self.0[v][0]) * scaled[0];
            for w in 1..V {
                s[v] = Lane::splat(simd, self.0[v][w]).times_plus(scaled[w], s[v]);
            }
        }
        s
    }

    fn scaled(self, factor: f64) -> Self {
        General(self.0.map(|row| row.map(|entry| factor * entry)))
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::testing::{anisotropic, isotropic};
    use super::*;

    #[test]
    fn only_isotropic_tensors_take_the_shortcut() {
        let c = isotropic(70e9, 0.3);
        let law = Isotropic::of(&c).expect("isotropic");
        assert_eq!(law.scaled(1.0), law);
        assert!((law.lambda + 2.0 * law.mu - c[0][0]).abs() < 1e-15 * c[0][0]);
        assert_eq!(Isotropic::of(&anisotropic()), None);
        let mut nearly = c;
        nearly[4][4] *= 1.0 + 1e-12;
        assert_eq!(Isotropic::of(&nearly), None);
    }
}
