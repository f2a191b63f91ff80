//! What modes of a space of few displacements leave open in the equations of all dofs, estimated at the price of a few solutions for all modes of a map together.
//!
//! The displacements at rest under the forces `r` that are left, `e = A⁻¹ r`, are to be small beside those of the mode. With random signs `ξ` and the masses `m` of the
//! dofs the mean square of `(√m ξ)ᵀ e = zᵀ r`, `z = A⁻¹ √m ξ`, is `Σ m e²`. `zᵀ r` is a sum over products of `z` with the matrices and the basis, which are known before the
//! mode is: no mode costs an operation over all dofs (Smetana, Zahm and Patera, Randomized residual-based error estimators for parametrized equations, 2019).

use super::linear::FrictionTerms;
use super::quadratic::Eigen;
use super::reduced::{Reduced, bordered, projected};
use super::shifted::Shifted;
use crate::linear::products;
use crate::math::vector::dot_in_fours as dot;
use crate::roughness::random::Random;

/// How many random vectors: an estimate is then within a factor of two nearly always.
const RANDOM: usize = 16;

/// Products of random displacements with a space.
pub(crate) struct Estimate {
    /// `z`.
    at_rest: Vec<Vec<f64>>,
    /// Stiffness, damping and mass times those.
    forces: [Vec<Vec<f64>>; 3],
    /// `m`.
    masses: Vec<f64>,
    /// `zᵀ K V`, `zᵀ C V` and `zᵀ M V`, a row for each `z`.
    products: [Vec<f64>; 3],
    /// `Vᵀ m V`.
    weights: Vec<f64>,
    /// Displacements of the space that are in those.
    known: usize,
}

impl Estimate {
    /// Without a space.
    pub fn new(shifted: &Shifted, solves: &mut usize) -> Self {
        let linear = shifted.linear;
        let diagonal = linear.mass.diagonal().into_iter().zip(&linear.fixed);
        let masses = diagonal.map(|(m, fixed)| if *fixed { 0.0 } else { m.max(0.0) });
        let masses: Vec<f64> = masses.collect();
        let mut random = Random(0x5eed);
        let mut signed = |m: &f64| m.sqrt() * if random.unit() < 0.5 { -1.0 } else { 1.0 };
        let signed: Vec<Vec<f64>> = (0..RANDOM)
            .map(|_| masses.iter().map(&mut signed).collect())
            .collect();
        *solves += RANDOM;
        let at_rest = shifted.solved(&signed);
        let images = |of: &dyn Fn(&[f64]) -> Vec<f64>| at_rest.iter().map(|z| of(z)).collect();
        Estimate {
            forces: [
                images(&|z| linear.times(&linear.stiffness, z)),
                images(&|z| linear.damped(z)),
                images(&|z| linear.times(&linear.mass, z)),
            ],
            at_rest,
            masses,
            products: Default::default(),
            weights: Vec::new(),
            known: 0,
        }
    }

    /// Takes the displacements that a space has now.
    pub fn take(&mut self, space: &Reduced) {
        let (first, basis) = (self.known, &space.basis);
        let forces = self.forces.iter().map(|f| products(f, basis));
        self.products
            .iter_mut()
            .zip(forces)
            .for_each(|(to, p)| *to = p);
        let weighed = |x: &Vec<f64>| x.iter().zip(&self.masses).map(|(x, m)| m * x).collect();
        let weighed: Vec<Vec<f64>> = basis[first..].iter().map(weighed).collect();
        let columns = products(basis, &weighed);
        self.weights = bordered(&self.weights, [first, basis.len()], &columns);
        self.known = basis.len();
    }

    /// What modes, in the coordinates of the space, leave open with such friction, relative to what is in them.
    pub fn open(&self, space: &Reduced, rub: FrictionTerms, modes: &[Eigen]) -> Vec<f64> {
        let [f, g] = rub.factors;
        let along = |pairs| projected(&self.at_rest, &space.basis, pairs);
        let friction = along(rub.friction.iter().collect());
        let drag = along(rub.drag.iter().filter(|p| !p.approach).collect());
        let approach = along(rub.drag.iter().filter(|p| p.approach).collect());
        let [k, c, m] = &self.products;
        let add = |a: &[f64], factor: f64, b: &[f64]| -> Vec<f64> {
            a.iter().zip(b).map(|(a, b)| a + factor * b).collect()
        };
        let stiffness = add(k, f, &friction);
        let damping = add(&add(c, g, &drag), f, &approach);
        let one = |mode: &Eigen| {
            let rows = [&stiffness, &damping, m];
            (squared(rows, mode) / (RANDOM as f64 * self.weight(mode))).sqrt()
        };
        modes.iter().map(one).collect()
    }

    /// `Σ m |x|²` of a mode.
    fn weight(&self, mode: &Eigen) -> f64 {
        let part = |x: &Vec<f64>| -> f64 {
            let rows = self.weights.chunks_exact(x.len()).zip(x);
            rows.map(|(row, own)| own * dot(row, x)).sum()
        };
        mode.vector
            .iter()
            .map(part)
            .sum::<f64>()
            .max(f64::MIN_POSITIVE)
    }
}

/// `Σ |zᵀ r|²` of a mode.
fn squared(matrices: [&Vec<f64>; 3], mode: &Eigen) -> f64 {
    let [l, w] = mode.value;
    let powers = [[1.0, 0.0], [l, w], [l * l - w * w, 2.0 * l * w]];
    let r = mode.vector[0].len();
    let row = |i: usize| {
        let mut left = [0.0; 2];
        for (matrix, [a, b]) in matrices.iter().zip(powers) {
            let own = &matrix[i * r..(i + 1) * r];
            let [x, y] = [0, 1].map(|q| dot(own, &mode.vector[q]));
            left[0] += a * x - b * y;
            left[1] += a * y + b * x;
        }
        left[0] * left[0] + left[1] * left[1]
    };
    (0..matrices[0].len() / r.max(1)).map(row).sum()
}
