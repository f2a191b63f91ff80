//! The model in a space of few displacements: real modes, and what their friction causes at rest.

use super::linear::{Linear, Pair, add_pairs, product};
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
    /// The part of the drag that follows from how surfaces approach.
    pub approach: Vec<f64>,
    /// Of what follows motion across the surface, and of what goes with the pressure at hand.
    pub factors: [f64; 2],
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
        Reduced {
            stiffness: symmetric(&|x| linear.times(&linear.stiffness, x)),
            mass: symmetric(&|x| linear.times(&linear.mass, x)),
            damping: symmetric(&|x| linear.damped(x)),
            friction: projected(&basis, &linear.friction),
            drag: projected(&basis, &linear.drag),
            approach: projected(&basis, approach(linear)),
            factors: [1.0; 2],
            sigma: shifted.sigma,
            pace,
            basis,
        }
    }

    /// Takes other friction.
    pub fn take(&mut self, linear: &Linear) {
        self.friction = projected(&self.basis, &linear.friction);
        self.drag = projected(&self.basis, &linear.drag);
        self.approach = projected(&self.basis, approach(linear));
    }

    /// The model in the space of fewer displacements, which are orthonormal in coordinates.
    pub fn within(&self, columns: &[Vec<f64>]) -> Self {
        let r = self.basis.len();
        let of = |matrix: &[f64]| -> Vec<f64> {
            let image = |x: &Vec<f64>| -> Vec<f64> {
                matrix.chunks_exact(r).map(|row| dot(row, x)).collect()
            };
            let images: Vec<Vec<f64>> = columns.iter().map(image).collect();
            let rows = columns.iter();
            rows.flat_map(|x| images.iter().map(move |y| dot(x, y)))
                .collect()
        };
        let basis = columns.iter().map(|z| {
            let mut x = vec![0.0; self.basis[0].len()];
            for (z, q) in z.iter().zip(&self.basis) {
                x.iter_mut().zip(q).for_each(|(x, q)| *x += z * q);
            }
            x
        });
        Reduced {
            basis: basis.collect(),
            stiffness: of(&self.stiffness),
            mass: of(&self.mass),
            damping: of(&self.damping),
            friction: of(&self.friction),
            drag: of(&self.drag),
            approach: of(&self.approach),
            ..*self
        }
    }
}

fn approach(linear: &Linear) -> impl Iterator<Item = &Pair> {
    linear.drag.iter().filter(|pair| pair.approach)
}

/// `Σ left rightᵀ` in a basis.
fn projected<'a>(basis: &[Vec<f64>], pairs: impl IntoIterator<Item = &'a Pair>) -> Vec<f64> {
    let r = basis.len();
    let mut out = vec![0.0; r * r];
    for pair in pairs {
        let left: Vec<f64> = basis.iter().map(|x| product(&pair.left, x)).collect();
        let right: Vec<f64> = basis.iter().map(|x| product(&pair.right, x)).collect();
        for (row, l) in out.chunks_exact_mut(r).zip(left) {
            row.iter_mut().zip(&right).for_each(|(o, x)| *o += l * x);
        }
    }
    out
}
