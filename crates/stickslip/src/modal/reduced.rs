//! The model in a space of few displacements: real modes, and what their friction causes at rest.

use super::linear::{Pair, add_pairs, product};
use super::shifted::Shifted;
use crate::math::vector::dot;

/// Part of a vector that has to be left after orthogonalisation.
const DEPENDENT: f64 = 1e-9;

/// The model in a space of few displacements, orthonormal in the product of the factored matrix.
pub(crate) struct Reduced {
    pub basis: Vec<Vec<f64>>,
    pub stiffness: Vec<f64>,
    pub mass: Vec<f64>,
    pub damping: Vec<f64>,
    pub friction: Vec<f64>,
    pub drag: Vec<f64>,
    pub sigma: f64,
    /// By what velocities are divided.
    pub pace: f64,
}

/// Displacements at rest under the friction of others.
pub(super) fn images(shifted: &Shifted, block: &[Vec<f64>], solves: &mut usize) -> Vec<Vec<f64>> {
    let linear = shifted.linear;
    let mut columns = Vec::new();
    for x in block {
        for pairs in [&linear.friction, &linear.drag] {
            if !pairs.is_empty() {
                let mut column = vec![0.0; linear.size()];
                add_pairs(pairs, 1.0, x, &mut column);
                columns.push(column);
            }
        }
    }
    *solves += columns.len();
    shifted.solved(&columns)
}

/// Adds vectors to a basis; returns those parts of them that are new.
pub(super) fn extend(
    shifted: &Shifted,
    basis: &mut Vec<Vec<f64>>,
    more: Vec<Vec<f64>>,
) -> Vec<Vec<f64>> {
    let product = |x: &[f64]| shifted.times(x);
    let images: Vec<Vec<f64>> = basis.iter().map(|x| product(x)).collect();
    let mut pairs: Vec<(Vec<f64>, Vec<f64>)> =
        std::mem::take(basis).into_iter().zip(images).collect();
    let first = pairs.len();
    for mut x in more {
        let before = dot(&x, &product(&x)).max(0.0).sqrt();
        for _ in 0..2 {
            for (q, aq) in &pairs {
                let part = dot(aq, &x);
                x.iter_mut().zip(q).for_each(|(x, q)| *x -= part * q);
            }
        }
        let left = dot(&x, &product(&x)).max(0.0).sqrt();
        if left > DEPENDENT * before && pairs.len() < shifted.linear.free() {
            x.iter_mut().for_each(|v| *v /= left);
            let image = product(&x);
            pairs.push((x, image));
        }
    }
    *basis = pairs.into_iter().map(|(x, _)| x).collect();
    basis[first..].to_vec()
}

impl Reduced {
    pub fn new(shifted: &Shifted, basis: Vec<Vec<f64>>, pace: f64) -> Self {
        let linear = shifted.linear;
        let r = basis.len();
        let symmetric = |image: &dyn Fn(&[f64]) -> Vec<f64>| -> Vec<f64> {
            let images: Vec<Vec<f64>> = basis.iter().map(|x| image(x)).collect();
            (0..r * r)
                .map(|k| dot(&basis[k / r], &images[k % r]))
                .collect()
        };
        let of = |pairs: &[Pair]| -> Vec<f64> {
            let mut out = vec![0.0; r * r];
            for pair in pairs {
                let left: Vec<f64> = basis.iter().map(|x| product(&pair.left, x)).collect();
                let right: Vec<f64> = basis.iter().map(|x| product(&pair.right, x)).collect();
                for (row, l) in out.chunks_exact_mut(r).zip(left) {
                    row.iter_mut().zip(&right).for_each(|(o, x)| *o += l * x);
                }
            }
            out
        };
        Reduced {
            stiffness: symmetric(&|x| linear.times(&linear.stiffness, x)),
            mass: symmetric(&|x| linear.times(&linear.mass, x)),
            damping: symmetric(&|x| linear.damped(x)),
            friction: of(&linear.friction),
            drag: of(&linear.drag),
            sigma: shifted.sigma,
            pace,
            basis,
        }
    }
}
