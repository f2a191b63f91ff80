//! The block diagonal of a level: its inverse, and how far it is from the matrix.

use rayon::prelude::*;

use super::super::block_csr::ROWS_PER_TASK;
use super::blocks::{Block, Rows, zero};
use super::spectrum;

/// Steps of the Lanczos method for the spectral radius.
const LANCZOS_STEPS: usize = 12;

/// The inverse block diagonal of a matrix without contact.
pub(super) struct BlockJacobi<const B: usize> {
    /// Inverse blocks, zero at fixed dofs and those without stiffness.
    pub inverse: Vec<Block<f64, B, B>>,
    /// A bound of the eigenvalues of `D⁻¹ A`. It also holds with any semidefinite stiffness added to blocks of `D`
    /// and of `A`.
    pub spectral_radius: f64,
}

impl<const B: usize> BlockJacobi<B> {
    pub fn new(a: &impl Rows<B>, fixed: &[bool]) -> Self {
        let inverse = inverse_diagonal(a, fixed);
        BlockJacobi {
            spectral_radius: spectral_radius(a, &inverse),
            inverse,
        }
    }
}

/// The inverse diagonal blocks of a level without contact, zero at fixed dofs and those without stiffness.
fn inverse_diagonal<const B: usize>(a: &impl Rows<B>, fixed: &[bool]) -> Vec<Block<f64, B, B>> {
    let blocks = (0..a.count()).map(|node| {
        let block = a.diagonal(node);
        invert(&block, &active(&block, fixed, node))
    });
    blocks.collect()
}

/// Dofs of a block that are neither fixed nor without stiffness.
pub(super) fn active<const B: usize>(
    block: &Block<f64, B, B>,
    fixed: &[bool],
    node: usize,
) -> [bool; B] {
    std::array::from_fn(|c| block[c][c] > 0.0 && !fixed.get(node * B + c).copied().unwrap_or(false))
}

/// A bound of the spectrum of `D⁻¹ A`.
fn spectral_radius<const B: usize>(a: &impl Rows<B>, inverse: &[Block<f64, B, B>]) -> f64 {
    let mut product = |x: &[[f64; B]], y: &mut [[f64; B]]| {
        y.par_chunks_mut(ROWS_PER_TASK)
            .enumerate()
            .for_each(|(task, part)| {
                for (i, y) in part.iter_mut().enumerate() {
                    let (columns, blocks) = a.row(task * ROWS_PER_TASK + i);
                    *y = [0.0; B];
                    for (&j, block) in columns.iter().zip(blocks) {
                        for (y, line) in y.iter_mut().zip(block) {
                            let x = &x[j as usize];
                            *y += line.iter().zip(x).map(|(a, x)| a * x).sum::<f64>();
                        }
                    }
                }
            });
    };
    spectrum::largest(&mut product, inverse, LANCZOS_STEPS)
}

/// The inverse of a symmetric positive semidefinite block over its active dofs; zero at the others and along
/// directions without stiffness.
pub(super) fn invert<const B: usize>(
    block: &Block<f64, B, B>,
    active: &[bool; B],
) -> Block<f64, B, B> {
    // A = L Lᵀ, with a zero on the diagonal for what is left out.
    let mut l: Block<f64, B, B> = zero();
    for i in 0..B {
        if !active[i] {
            continue;
        }
        for j in 0..=i {
            let sum: f64 = (0..j).map(|k| l[i][k] * l[j][k]).sum();
            let left = block[i][j] - sum;
            l[i][j] = if i != j {
                if l[j][j] == 0.0 { 0.0 } else { left / l[j][j] }
            } else if left > 1e-12 * block[i][i] {
                left.sqrt()
            } else {
                0.0
            };
        }
    }
    let mut inverse = zero();
    for column in 0..B {
        let mut x = [0.0; B];
        x[column] = 1.0;
        for i in 0..B {
            let sum: f64 = (0..i).map(|k| l[i][k] * x[k]).sum();
            x[i] = if l[i][i] == 0.0 {
                0.0
            } else {
                (x[i] - sum) / l[i][i]
            };
        }
        for i in (0..B).rev() {
            let sum: f64 = (i + 1..B).map(|k| l[k][i] * x[k]).sum();
            x[i] = if l[i][i] == 0.0 {
                0.0
            } else {
                (x[i] - sum) / l[i][i]
            };
        }
        for i in 0..B {
            inverse[i][column] = x[i];
        }
    }
    inverse
}
