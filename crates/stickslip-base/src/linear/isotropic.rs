use std::sync::Arc;

use rayon::prelude::*;

use super::BlockCsr;
use super::block_csr::ROWS_PER_TASK;
use super::pattern::Pattern;

/// A sparse matrix whose blocks are multiples of the unit matrix, as masses are: a ninth of the numbers in space.
#[derive(Debug, Clone)]
pub struct Isotropic {
    pattern: Arc<Pattern>,
    block: usize,
    values: Vec<f64>,
}

impl Isotropic {
    /// The same matrix; `None` if a block is no multiple of the unit matrix.
    pub fn of(matrix: &BlockCsr) -> Option<Isotropic> {
        let b = matrix.block_size();
        let mut values = Vec::with_capacity(matrix.nnz() / (b * b));
        for point in 0..matrix.points() {
            for block in matrix.row_blocks(point).chunks_exact(b * b) {
                let unit =
                    |(k, v): (usize, &f64)| *v == if k % (b + 1) == 0 { block[0] } else { 0.0 };
                if !block.iter().enumerate().all(unit) {
                    return None;
                }
                values.push(block[0]);
            }
        }
        Some(Isotropic {
            pattern: matrix.shared_pattern(),
            block: b,
            values,
        })
    }

    /// `y = A x`. The bits of `y` do not depend on the number of threads.
    ///
    /// # Panics
    /// If `x` or `y` has not one entry a row.
    pub fn mul(&self, x: &[f64], y: &mut [f64]) {
        let rows = self.pattern.points() * self.block;
        assert!(x.len() == rows && y.len() == rows, "length of a vector");
        match self.block {
            2 => self.mul_blocks::<2>(x, y),
            _ => self.mul_blocks::<3>(x, y),
        }
    }

    fn mul_blocks<const B: usize>(&self, x: &[f64], y: &mut [f64]) {
        y.par_chunks_mut(ROWS_PER_TASK * B)
            .enumerate()
            .for_each(|(task, part)| {
                for (i, target) in part.chunks_exact_mut(B).enumerate() {
                    let row = task * ROWS_PER_TASK + i;
                    let range = self.pattern.starts[row]..self.pattern.starts[row + 1];
                    let mut sum = [0.0; B];
                    let columns = &self.pattern.columns[range.clone()];
                    for (&column, &value) in columns.iter().zip(&self.values[range]) {
                        let x = &x[column as usize * B..][..B];
                        for (s, x) in sum.iter_mut().zip(x) {
                            *s += value * x;
                        }
                    }
                    target.copy_from_slice(&sum);
                }
            });
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{grid, noise};
    use super::*;

    #[test]
    fn products_are_those_of_the_blocks() {
        for (counts, block) in [([5, 4, 1], 2), ([4, 3, 3], 3)] {
            let mut a = grid(counts, block);
            assert!(Isotropic::of(&a).is_none());
            a.clear();
            for p in 0..a.points() {
                for c in 0..block {
                    a.add_diagonal(p * block + c, 1.0 + p as f64);
                }
            }
            let pair: Vec<f64> = (0..4 * block * block)
                .map(|k| {
                    if (k / (2 * block)) % block == k % block {
                        0.5
                    } else {
                        0.0
                    }
                })
                .collect();
            a.add_group(&[0, 1], &pair);
            let same = Isotropic::of(&a).unwrap();
            let x = noise(&mut 7, a.rows());
            let (mut y, mut z) = (vec![0.0; a.rows()], vec![0.0; a.rows()]);
            a.mul(&x, &mut y);
            same.mul(&x, &mut z);
            assert!(y.iter().zip(&z).all(|(y, z)| (y - z).abs() < 1e-14));
        }
    }
}
