//! Solutions with the linearised matrices at a shift: one factor of the symmetric part, a dense matrix for what friction adds.

use std::sync::Arc;

use super::linear::{FrictionTerms, Linear, Pair, add_pairs, fault, product};
use crate::error::RunError;
use crate::linear::{BlockCsr, DenseLu, Factor, LinearError, Symbolic, noise};
use crate::math::vector::dot;
use crate::model::frame::Frame;
use crate::tolerance::ROUNDING;

/// Most rows of the dense matrix of friction.
const MOST_FRICTION_ROWS: usize = 8000;

/// Columns that are solved for together.
const SOLVED_TOGETHER: usize = 32;

/// The factor of `A = K + σ C + σ² M`.
pub(crate) struct Shifted<'a> {
    pub linear: &'a Linear,
    pub factor: Factor,
    /// `σ ≥ 0` `[1/s]`.
    pub sigma: f64,
    /// How many matrices were factored until one could be.
    pub factorisations: usize,
    /// Whether the damping of bodies is in it.
    damped: bool,
}

impl<'a> Shifted<'a> {
    /// Without a shift where the stiffness holds everything, with a small one where it does not, or by rounding alone. `damped`: with the damping of bodies.
    pub fn new(linear: &'a Linear, frame: &Frame, damped: bool) -> Result<Self, RunError> {
        let fixed = &linear.fixed;
        let symbolic = Symbolic::analyze(&linear.stiffness, fixed, &[]);
        let symbolic = Arc::new(symbolic.map_err(|e| fault(frame, e.to_string()))?);
        let mut shift = 0.0;
        for before in 0..7 {
            let sigma = f64::sqrt(shift);
            let matrix = matrix(linear, sigma, damped);
            match Factor::new(&symbolic, &matrix, &[]) {
                Ok(factor) if shift > 0.0 || holds(linear, &factor) => {
                    return Ok(Shifted {
                        linear,
                        factor,
                        sigma,
                        factorisations: before + 1,
                        damped,
                    });
                }
                Ok(_) | Err(LinearError::NotPositive { .. } | LinearError::Singular { .. }) => {
                    // Shift where the stiffness alone is singular, relative to the largest squared frequency that the diagonals tell of.
                    let first = 1e-7 * highest(linear);
                    shift = if shift == 0.0 { first } else { 30.0 * shift };
                }
                Err(e) => return Err(fault(frame, e.to_string())),
            }
            if !(shift > 0.0 && shift.is_finite()) {
                break;
            }
        }
        let mut error = fault(
            frame,
            "the linearised stiffness with masses cannot be factored: something moves that has neither stiffness nor mass",
        );
        error.help =
            Some("give every material a density, and hold or weigh reference points".into());
        Err(error)
    }

    /// The shift `σ²` `[1/s²]`.
    pub fn shift(&self) -> f64 {
        self.sigma * self.sigma
    }

    /// `A x`.
    pub fn times(&self, x: &[f64]) -> Vec<f64> {
        let linear = self.linear;
        let mut out = linear.times(&linear.stiffness, x);
        if self.sigma > 0.0 {
            let mass = linear.times(&linear.mass, x);
            let add = |out: &mut [f64], factor: f64, y: Vec<f64>| {
                out.iter_mut().zip(y).for_each(|(o, y)| *o += factor * y);
            };
            add(&mut out, self.shift(), mass);
            if self.damped {
                add(&mut out, self.sigma, linear.damped(x));
            }
        }
        out
    }

    /// `A⁻¹ b` of several.
    pub fn solved(&self, columns: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let mut out = Vec::new();
        for chunk in columns.chunks(SOLVED_TOGETHER) {
            let mut all = chunk.concat();
            self.factor.solve_columns(&mut all, chunk.len());
            out.extend(all.chunks_exact(self.linear.size()).map(<[f64]>::to_vec));
        }
        out
    }

    /// How much forces `r` are beside those of displacements `x`: `√(rᵀ A⁻¹ r / xᵀ A x)`, real and imaginary parts together; `solved` are `A⁻¹ r`. Constraints that are
    /// as stiff as rounding allows do not count in this norm for more than the energy that rounding stores in them, as they would if forces were compared.
    pub fn relative(&self, r: &[Vec<f64>], solved: &[Vec<f64>], x: &[Vec<f64>]) -> f64 {
        let open: f64 = r.iter().zip(solved).map(|(r, s)| dot(r, s)).sum();
        let whole: f64 = x.iter().map(|x| dot(x, &self.times(x))).sum();
        (open.max(0.0) / whole.max(f64::MIN_POSITIVE)).sqrt()
    }
}

/// Whether the lowest frequency with a factored stiffness is more than rounding, by inverse iteration: an unconstrained motion outgrows all else within two solutions.
fn holds(linear: &Linear, factor: &Factor) -> bool {
    let mut seed = 0x5eed;
    let mut x: Vec<f64> = (0..linear.size()).map(|_| noise(&mut seed)).collect();
    let mut lowest = f64::INFINITY;
    for _ in 0..3 {
        let mut force = linear.times(&linear.mass, &x);
        let before = dot(&x, &force).max(0.0).sqrt();
        factor.solve_columns(&mut force, 1);
        x = force;
        let after = dot(&x, &linear.times(&linear.mass, &x)).max(0.0).sqrt();
        if before == 0.0 || after == 0.0 {
            return true;
        }
        lowest = before / after;
        x.iter_mut().for_each(|x| *x /= after);
    }
    // Rounding of the stiffness may leave this much of a lowest squared frequency of none: a factor of such a stiffness is one of rounding.
    lowest > ROUNDING * highest(linear)
}

fn matrix(linear: &Linear, sigma: f64, damped: bool) -> BlockCsr {
    let mut matrix = linear.stiffness.clone();
    if sigma > 0.0 {
        matrix.add_scaled(sigma * sigma, &linear.mass);
        if let (true, Some(damping)) = (damped, &linear.damping) {
            matrix.add_scaled(sigma, damping);
        }
    }
    matrix
}

/// The largest ratio of stiffness to mass on the diagonals of what is free.
pub(crate) fn highest(linear: &Linear) -> f64 {
    let (k, m) = (linear.stiffness.diagonal(), linear.mass.diagonal());
    let all = k.iter().zip(&m).zip(&linear.fixed);
    let ratios = all.filter(|((_, m), fixed)| !**fixed && **m > 0.0);
    ratios.map(|((k, m), _)| k / m).fold(0.0, f64::max)
}

/// Friction at the shift: `P = A + f L Rᵀ`, and the dense matrix `Rᵀ A⁻¹ L`.
pub(crate) struct Root {
    /// Pairs of stiffness and, times the shift, of damping.
    pub pairs: Vec<Pair>,
    /// `Rᵀ A⁻¹ L`, row by row.
    w: Vec<f64>,
    lu: DenseLu,
    factor: f64,
    /// Whether left and right rows have changed places: the transposed problem.
    transposed: bool,
}

impl Root {
    pub fn new(shifted: &Shifted, frame: &Frame) -> Result<Self, RunError> {
        let linear = shifted.linear;
        let mut pairs = linear.friction.clone();
        if shifted.sigma > 0.0 {
            pairs.extend(linear.drag.iter().map(|p| {
                Pair {
                    left: p
                        .left
                        .iter()
                        .map(|(d, v)| (*d, shifted.sigma * v))
                        .collect(),
                    ..p.clone()
                }
            }));
        }
        let q = pairs.len();
        if q > MOST_FRICTION_ROWS {
            let mut error = fault(
                frame,
                format!(
                    "{q} rows of friction are too many for the dense matrix of sliding points (at most {MOST_FRICTION_ROWS})"
                ),
            );
            error.help = Some("mesh the sliding surface more coarsely".into());
            return Err(error);
        }
        let n = linear.size();
        let mut w = vec![0.0; q * q];
        for (block, chunk) in pairs.chunks(SOLVED_TOGETHER).enumerate() {
            let mut columns = vec![0.0; n * chunk.len()];
            for (column, pair) in columns.chunks_exact_mut(n).zip(chunk) {
                pair.left.iter().for_each(|&(dof, v)| column[dof] += v);
            }
            shifted.factor.solve_columns(&mut columns, chunk.len());
            for (k, column) in columns.chunks_exact(n).enumerate() {
                for (i, pair) in pairs.iter().enumerate() {
                    w[i * q + block * SOLVED_TOGETHER + k] = product(&pair.right, column);
                }
            }
        }
        let mut root = Root {
            pairs,
            w,
            lu: DenseLu::new(0, &[]),
            factor: 0.0,
            transposed: false,
        };
        root.set(1.0, false);
        Ok(root)
    }

    /// `Rᵀ A⁻¹ L`, row by row.
    pub fn compliance(&self) -> &[f64] {
        &self.w
    }

    /// Chooses the friction relative to that of the state, and whether the transposed problem is meant.
    pub fn set(&mut self, factor: f64, transposed: bool) {
        let q = self.pairs.len();
        let entry = |k: usize| {
            let (i, j) = (k / q, k % q);
            let w = match transposed {
                true => self.w[j * q + i],
                false => self.w[k],
            };
            factor * w + if i == j { 1.0 } else { 0.0 }
        };
        let dense: Vec<f64> = (0..q * q).map(entry).collect();
        self.lu = DenseLu::new(q, &dense);
        (self.factor, self.transposed) = (factor, transposed);
    }

    /// `P⁻¹ b` in place, for several `b` one after the other; of the transposed problem `P⁻ᵀ b`.
    pub fn solve(&self, shifted: &Shifted, b: &mut [f64], columns: usize) {
        shifted.factor.solve_columns(b, columns);
        if self.pairs.is_empty() || self.factor == 0.0 {
            return;
        }
        let n = b.len() / columns;
        let sides: Vec<_> = self
            .pairs
            .iter()
            .map(|p| p.sides(self.transposed))
            .collect();
        let along = |b| sides.iter().map(move |(_, right)| product(right, b));
        let mut z: Vec<f64> = b.chunks_exact(n).flat_map(along).collect();
        self.lu.solve(&mut z);
        let mut y = vec![0.0; b.len()];
        let each = y.chunks_exact_mut(n).zip(z.chunks_exact(self.pairs.len()));
        for (y, z) in each {
            for (z, (left, _)) in z.iter().zip(&sides) {
                left.iter()
                    .for_each(|&(dof, v)| y[dof] += self.factor * z * v);
            }
        }
        shifted.factor.solve_columns(&mut y, columns);
        b.iter_mut().zip(y).for_each(|(b, y)| *b -= y);
    }
}

/// Forces of stiffness, damping and mass of a displacement, with such friction.
pub fn forces(linear: &Linear, x: &[f64], rub: FrictionTerms) -> [Vec<f64>; 3] {
    let mut k = linear.times(&linear.stiffness, x);
    add_pairs(rub.friction, rub.factors[0], x, &mut k);
    let mut c = linear.damped(x);
    for (approach, factor) in [true, false].into_iter().zip(rub.factors) {
        let own = rub.drag.iter().filter(|p| p.approach == approach);
        add_pairs(own, factor, x, &mut c);
    }
    [k, c, linear.times(&linear.mass, x)]
}
