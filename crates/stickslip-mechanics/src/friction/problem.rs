use crate::tolerance::ROUNDING;

use super::cone::Cone;
use super::ellipse::{Ellipse, SlipDirection};

/// Limit of the friction force at a point: `adhesion + mu p` at a contact force `p`, never below zero.
///
/// Coulomb's law has no adhesion, Tresca's no coefficient; any other law is its tangent.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct PointLaw {
    /// Coefficient of friction `[-]`.
    pub mu: f64,
    /// Limit without contact force `[N]`.
    pub adhesion: f64,
    /// The shape of the set of admissible shear where that is no circle; in the plane its angle is zero.
    pub ellipse: Option<Ellipse>,
}

impl PointLaw {
    /// Coulomb's law.
    pub fn coulomb(mu: f64) -> Self {
        PointLaw {
            mu,
            ..PointLaw::default()
        }
    }

    /// Tresca's law: a limit that is given.
    pub fn tresca(limit: f64) -> Self {
        PointLaw {
            adhesion: limit,
            ..PointLaw::default()
        }
    }

    /// The shear forces that are allowed at a contact force.
    pub fn cone(&self, force: f64) -> Cone {
        Cone {
            limit: self.limit(force).0,
            skew: 0.0,
            ellipse: self.ellipse,
        }
    }

    /// The limit at a contact force, and its derivative.
    pub fn limit(&self, force: f64) -> (f64, f64) {
        let limit = self.adhesion + self.mu * force;
        match limit > 0.0 {
            true => (limit, self.mu),
            false => (0.0, 0.0),
        }
    }
}

/// Frictional contact at a number of points: forces `r` with
///
/// ```text
/// u = W r + q      0 <= u_n, 0 <= r_n, u_n r_n = 0      |r_t| <= limit(r_n), and r_t against u_t with the limit where u_t is not zero
/// ```
///
/// `u` is the gap or the speed of approach, `r` a force or an impulse: the problem does not ask. In vectors the normal component of each point comes
/// first.
#[derive(Debug, Clone, PartialEq)]
pub struct FrictionProblem {
    /// 2 or 3 components a point.
    pub dimension: usize,
    /// The operator `W`, row by row, of shape `(n, n)`; it may be singular.
    pub operator: Vec<f64>,
    /// The motion `q` without contact, of shape `(n,)`.
    pub free: Vec<f64>,
    /// One a point.
    pub laws: Vec<PointLaw>,
}

impl FrictionProblem {
    /// Unknowns: points times dimension.
    pub fn size(&self) -> usize {
        self.free.len()
    }

    /// Number of points.
    pub fn points(&self) -> usize {
        self.laws.len()
    }

    /// What makes it no problem at all, in a sentence.
    pub fn fault(&self) -> Option<String> {
        let (d, n) = (self.dimension, self.free.len());
        if d != 2 && d != 3 {
            return Some(format!("the dimension is 2 or 3, not {d}"));
        }
        if n != d * self.laws.len() || self.operator.len() != n * n {
            let (points, entries) = (self.laws.len(), self.operator.len());
            return Some(format!(
                "{points} laws, {n} motions and an operator of {entries} entries do not belong together"
            ));
        }
        let numbers = self.operator.iter().chain(&self.free);
        if !numbers.clone().all(|x| x.is_finite()) {
            return Some("a number is not finite".into());
        }
        if let Some(k) = self.laws.iter().position(|law| {
            let fine = |x: f64| x.is_finite() && x >= 0.0;
            !fine(law.mu) || !fine(law.adhesion)
        }) {
            return Some(format!("the law of point {k} is negative or not finite"));
        }
        if let Some(k) = self.laws.iter().position(|law| {
            law.ellipse.is_some_and(|ellipse| {
                let outside = ellipse.half.iter().any(|h| !(0.0..=1.0).contains(h));
                let thin =
                    ellipse.flow == SlipDirection::AgainstTraction && ellipse.half.contains(&0.0);
                outside || thin || !ellipse.angle.is_finite() || d == 2 && ellipse.angle != 0.0
            })
        }) {
            return Some(format!(
                "the ellipse of point {k} is none: half axes are between 0 and 1, positive where slip is against the traction, and the angle is finite, in the plane 0"
            ));
        }
        let own = |i: usize| self.operator[i * (n + 1)];
        (0..n).find(|&i| own(i) < 0.0).map(|i| {
            format!(
                "row {i} of the operator has {:e} on the diagonal: a force would pull its own point towards itself",
                own(i)
            )
        })
    }

    /// The motion under forces: `W r + q`.
    pub fn motion(&self, forces: &[f64]) -> Vec<f64> {
        (0..self.size())
            .map(|i| self.motion_at(i, forces))
            .collect()
    }

    /// One component of the motion.
    pub(super) fn motion_at(&self, i: usize, forces: &[f64]) -> f64 {
        let n = self.size();
        let row = &self.operator[i * n..(i + 1) * n];
        let product: f64 = row.iter().zip(forces).map(|(w, r)| w * r).sum();
        product + self.free[i]
    }

    /// The block of the operator at a point, row by row, in the first `d²` entries.
    pub(super) fn own(&self, point: usize) -> [f64; 9] {
        let (d, n) = (self.dimension, self.size());
        let mut block = [0.0; 9];
        for a in 0..d {
            for b in 0..d {
                block[a * d + b] = self.operator[(point * d + a) * n + point * d + b];
            }
        }
        block
    }

    /// By point a stiffness `[N/m]` with which motions become forces: the inverse of the mean of its own compliances, and where it has none that of all.
    pub fn stiffness(&self) -> Vec<f64> {
        let (d, n) = (self.dimension, self.size());
        let trace = |k: usize| {
            (k * d..(k + 1) * d)
                .map(|i| self.operator[i * (n + 1)])
                .sum::<f64>()
        };
        let all: f64 = (0..self.points()).map(trace).sum::<f64>() / self.points().max(1) as f64;
        let typical = if all > 0.0 { all } else { d as f64 };
        (0..self.points())
            .map(|k| match trace(k) {
                own if own > ROUNDING * typical => d as f64 / own,
                _ => d as f64 / typical,
            })
            .collect()
    }
}
