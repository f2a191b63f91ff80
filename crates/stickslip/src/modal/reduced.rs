//! The model in a space of few displacements: real modes, and what their friction causes at rest.

use super::bound::Sparse;
use super::linear::{Linear, Pair, add_pairs, product};
use super::shifted::Shifted;
use crate::linear::{products, sums};
use crate::math::vector::dot_in_fours as dot;
use crate::tolerance::SAME;

/// An image of a vector.
type Image<'a> = &'a dyn Fn(&[f64]) -> Vec<f64>;

/// The model in a space of few displacements, orthonormal in the product of the factored matrix.
pub(crate) struct Reduced {
    pub basis: Vec<Vec<f64>>,
    /// The factored matrix times the basis, while that grows.
    weighed: Vec<Vec<f64>>,
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

/// Displacements at rest under the friction of others, or under that of each contact point where these are fewer.
pub(super) fn images(shifted: &Shifted, block: &[Vec<f64>], solves: &mut usize) -> Vec<Vec<f64>> {
    let linear = shifted.linear;
    let mut columns = Vec::new();
    for pairs in [&linear.friction, &linear.drag] {
        let mut forces = |of: &mut dyn FnMut(&mut [f64])| {
            let mut column = vec![0.0; linear.size()];
            of(&mut column);
            columns.push(column);
        };
        if pairs.len() > block.len() {
            let each = block.iter();
            each.for_each(|x| forces(&mut |column| add_pairs(pairs, 1.0, x, column)));
            continue;
        }
        for pair in pairs {
            forces(&mut |column| pair.left.iter().for_each(|&(dof, v)| column[dof] += v));
        }
    }
    *solves += columns.len();
    shifted.solved(&columns)
}

impl Reduced {
    /// Without a displacement.
    pub fn new(shifted: &Shifted, pace: f64) -> Self {
        Reduced {
            basis: Vec::new(),
            weighed: Vec::new(),
            stiffness: Vec::new(),
            mass: Vec::new(),
            damping: Vec::new(),
            friction: Vec::new(),
            drag: Vec::new(),
            approach: Vec::new(),
            factors: [1.0; 2],
            sigma: shifted.sigma,
            pace,
        }
    }

    /// Adds displacements, `damped` by a symmetric matrix, and takes the friction of the state; returns those parts of them that are new.
    pub fn grow(&mut self, shifted: &Shifted, damped: Image, more: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
        let linear = shifted.linear;
        let first = self.basis.len();
        self.adopt(shifted, more);
        let new = &self.basis[first..];
        let images = |of: Image| -> Vec<Vec<f64>> { new.iter().map(|x| of(x)).collect() };
        let mass = images(&|x| linear.times(&linear.mass, x));
        let damping = images(damped);
        let stiffness = match self.sigma > 0.0 {
            true => images(&|x| linear.times(&linear.stiffness, x)),
            false => self.weighed[first..].to_vec(),
        };
        let basis = &self.basis;
        let bordered = |old: &[f64], images: &[Vec<f64>]| {
            bordered(old, [first, basis.len()], &products(basis, images))
        };
        self.stiffness = bordered(&self.stiffness, &stiffness);
        self.mass = bordered(&self.mass, &mass);
        self.damping = bordered(&self.damping, &damping);
        let new = new.to_vec();
        self.take(linear);
        new
    }

    /// Adds what is new in vectors to the basis.
    fn adopt(&mut self, shifted: &Shifted, mut more: Vec<Vec<f64>>) {
        let first = self.basis.len();
        let columns = more.len();
        let mut known = vec![0.0; columns];
        for _ in 0..2 {
            let parts = products(&self.weighed, &more);
            for (k, sum) in sums(&self.basis, &parts, columns).iter().enumerate() {
                more[k].iter_mut().zip(sum).for_each(|(x, s)| *x -= s);
                let own = parts.iter().skip(k).step_by(columns);
                known[k] += own.map(|p| p * p).sum::<f64>();
            }
        }
        for (mut x, mut known) in more.into_iter().zip(known) {
            for _ in 0..2 {
                let others = self.basis[first..].iter().zip(&self.weighed[first..]);
                for (q, weighed) in others {
                    let part = dot(weighed, &x);
                    known += part * part;
                    x.iter_mut().zip(q).for_each(|(x, q)| *x -= part * q);
                }
            }
            let mut weighed = shifted.times(&x);
            let left = dot(&x, &weighed).max(0.0);
            // Part of a vector that has to be left after orthogonalisation.
            let new = left > SAME * SAME * (known + left);
            if new && self.basis.len() < shifted.linear.free() {
                let size = left.sqrt();
                x.iter_mut().for_each(|v| *v /= size);
                weighed.iter_mut().for_each(|v| *v /= size);
                self.basis.push(x);
                self.weighed.push(weighed);
            }
        }
    }

    /// Takes other friction.
    pub fn take(&mut self, linear: &Linear) {
        let along = |pairs| projected(&self.basis, &self.basis, pairs);
        let approach = linear.drag.iter().filter(|p| p.approach);
        let [friction, drag, approach] = [
            along(linear.friction.iter().collect()),
            along(linear.drag.iter().collect()),
            along(approach.collect()),
        ];
        (self.friction, self.drag, self.approach) = (friction, drag, approach);
    }

    /// Whether nothing damps, nor drives what moves.
    pub fn undamped(&self) -> bool {
        let mut all = self.damping.iter().chain(&self.drag);
        all.all(|c| *c == 0.0)
    }
}

/// A symmetric matrix with further rows and columns, of which the last columns are given.
pub(super) fn bordered(old: &[f64], [first, all]: [usize; 2], columns: &[f64]) -> Vec<f64> {
    let new = all - first;
    let entry = |k: usize| match (k / all, k % all) {
        (i, j) if j >= first => columns[i * new + j - first],
        (i, j) if i >= first => columns[j * new + i - first],
        (i, j) => old[i * first + j],
    };
    (0..all * all).map(entry).collect()
}

/// `Σ left rightᵀ` between vectors and a basis.
pub(super) fn projected(x: &[Vec<f64>], basis: &[Vec<f64>], pairs: Vec<&Pair>) -> Vec<f64> {
    let along = |of: &[Vec<f64>], side: fn(&Pair) -> &Sparse| -> Vec<Vec<f64>> {
        let one = |x: &Vec<f64>| pairs.iter().map(|p| product(side(p), x)).collect();
        of.iter().map(one).collect()
    };
    products(&along(x, |p| &p.left), &along(basis, |p| &p.right))
}
