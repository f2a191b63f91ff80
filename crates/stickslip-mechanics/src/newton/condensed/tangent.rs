//! The linear system of one iteration as an operator.

use rayon::prelude::*;

use super::active::{Active, NONE, Placed};
use super::condensation::Condensation;
use super::rows::Rows;
use crate::math::vector::{dot, norm};
use crate::tolerance::SAME;

/// One artificial spring of a floating part.
pub(super) struct Spring<'a> {
    /// First candidate of its part.
    pub start: usize,
    /// Stiffness `[N/m]`.
    pub sigma: f64,
    /// The rigid motion `R` along which it acts.
    pub mode: &'a [f64],
    /// The compliance product `Z = W R`.
    pub product: &'a [f64],
}

/// Numbers in which compliance products are made.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Precision {
    Single,
    Double,
}

/// Error of a compliance product in single precision relative to the product: `6·10⁻⁸` for each number and sums of thousands of them.
const SINGLE_ERROR: f64 = 3e-7;

impl Precision {
    /// The coarsest numbers in which a product is as good as asked for, if they are not to be coarser than `self`.
    pub fn within(self, error: f64) -> Precision {
        match error >= SINGLE_ERROR {
            true => self,
            false => Precision::Double,
        }
    }
}

/// The system of one iteration. Vectors hold forces at the active dofs, then one for each artificial spring.
pub(super) struct Tangent<'a> {
    pub condensation: &'a Condensation,
    pub active: &'a Active,
    pub blocks: &'a [Placed<'a>],
    pub springs: &'a [Spring<'a>],
}

impl Tangent<'_> {
    /// The compliance product at the active dofs, forces of springs left out.
    pub fn apply_compliance(&self, y: &[f64], precision: Precision) -> Vec<f64> {
        let parts: Vec<Vec<f64>> = (0..self.condensation.parts.len())
            .into_par_iter()
            .map(|k| {
                let range = self.active.starts[k]..self.active.starts[k + 1];
                let mut u = vec![0.0; range.len()];
                let w = self.active.compliance(self.condensation, k);
                match precision {
                    Precision::Single => w.mul_single(&y[range], &mut u),
                    Precision::Double => w.mul(&y[range], &mut u),
                }
                u
            })
            .collect();
        parts.concat()
    }

    /// `W Bᵀ` of one row of a point, forces of springs left out.
    pub fn displacement_along(&self, rows: &Rows, q: usize) -> Vec<f64> {
        let mut u = vec![0.0; self.active.len()];
        for (at, b) in rows.gradient(q) {
            let part = self.active.starts.partition_point(|&start| start <= at) - 1;
            let range = self.active.starts[part]..self.active.starts[part + 1];
            let (n, column) = (range.len(), at - range.start);
            let w = self.active.compliance(self.condensation, part).values();
            let column = &w[column * n..(column + 1) * n];
            for (u, w) in u[range].iter_mut().zip(column) {
                *u += b * w;
            }
        }
        u
    }

    /// `Z` of a spring at an active dof.
    pub fn product_at(&self, spring: &Spring, i: usize) -> f64 {
        let at = self.active.list[i];
        at.checked_sub(spring.start)
            .and_then(|k| spring.product.get(k))
            .copied()
            .unwrap_or(0.0)
    }

    /// `W b` at the active dofs. Once the bodies are in balance there are forces at active dofs only.
    pub fn displacement_under(&self, b: &[f64]) -> Vec<f64> {
        let active: Vec<f64> = self.active.list.iter().map(|&i| b[i]).collect();
        let all = norm(b);
        let rest = (all * all - dot(&active, &active)).max(0.0).sqrt();
        if rest <= SAME * all {
            return self.apply_compliance(&active, Precision::Double);
        }
        let u = self.condensation.apply_compliance(b);
        self.active.list.iter().map(|&i| u[i]).collect()
    }

    /// `-K u`, and what the springs make of `b`.
    pub fn right_hand_side(&self, u: &[f64], b: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; u.len()];
        self.add_contact(u, &mut out);
        out.iter_mut().for_each(|o| *o = -*o);
        for spring in self.springs {
            let own = &b[spring.start..spring.start + spring.product.len()];
            out.push(spring.sigma * dot(spring.product, own));
        }
        out
    }

    /// Adds the forces of the interfaces that come with displacements `u`.
    fn add_contact(&self, u: &[f64], out: &mut [f64]) {
        let mut local = Vec::new();
        let mut result = Vec::new();
        for Placed { at, block } in self.blocks {
            local.clear();
            local.extend(
                at.iter()
                    .map(|&k| if k == NONE { 0.0 } else { u[k as usize] }),
            );
            result.clear();
            result.resize(at.len(), 0.0);
            block.apply(&local, &mut result);
            for (&k, r) in at.iter().zip(&result) {
                if k != NONE {
                    out[k as usize] += r;
                }
            }
        }
    }

    /// The displacements of the active dofs under all forces of `v`.
    fn displacement(&self, v: &[f64], precision: Precision) -> Vec<f64> {
        let n = self.active.len();
        let mut u = self.apply_compliance(&v[..n], precision);
        for (spring, &beta) in self.springs.iter().zip(&v[n..]) {
            if beta != 0.0 {
                for (i, u) in u.iter_mut().enumerate() {
                    *u += beta * self.product_at(spring, i);
                }
            }
        }
        u
    }

    /// The operator times `v`.
    pub fn apply(&self, v: &[f64], out: &mut [f64], precision: Precision) {
        let n = self.active.len();
        let u = self.displacement(v, precision);
        out.copy_from_slice(v);
        self.add_contact(&u, &mut out[..n]);
        for (k, spring) in self.springs.iter().enumerate() {
            let mut sum = 0.0;
            for (i, y) in v[..n].iter().enumerate() {
                sum += self.product_at(spring, i) * y;
            }
            for (other, &beta) in self.springs.iter().zip(&v[n..]) {
                if other.start == spring.start {
                    sum += dot(spring.mode, other.product) * beta;
                }
            }
            out[n + k] -= spring.sigma * sum;
        }
    }

    /// Adds the forces of a solution to those at all candidates.
    pub fn add_forces(&self, y: &[f64], s: &mut [f64]) {
        let n = self.active.len();
        for (&i, y) in self.active.list.iter().zip(y) {
            s[i] += y;
        }
        for (spring, beta) in self.springs.iter().zip(&y[n..]) {
            for (s, m) in s[spring.start..].iter_mut().zip(spring.mode) {
                *s += beta * m;
            }
        }
    }
}
