use std::ops::Range;
use std::sync::Arc;

use rayon::prelude::*;

use super::Digest;
use super::pattern::{Couplings, Pattern};

/// Block rows that one task multiplies or makes; fixed, so that results never depend on the number of threads.
pub(super) const ROWS_PER_TASK: usize = 1024;

/// A sparse matrix of `block × block` blocks over the points of a mesh, in compressed rows.
///
/// Its pattern is symmetric and both triangles are stored; the values need not be symmetric. A dof is
/// `point * block + component`. Matrices made by [`zeros_like`](BlockCsr::zeros_like) share the pattern.
#[derive(Debug, Clone)]
pub struct BlockCsr {
    pattern: Arc<Pattern>,
    block: usize,
    /// Blocks in the order of the pattern, each row by row.
    values: Vec<f64>,
}

impl BlockCsr {
    /// What its values take `[bytes]`; the pattern is shared.
    pub fn bytes(&self) -> u64 {
        size_of_val(self.values.as_slice()) as u64
    }

    /// A zero matrix in which every group of points that `visit` hands out is coupled, and every point to itself.
    ///
    /// # Panics
    /// If `block` is neither 2 nor 3, or a group names a point that does not exist: meshes are checked earlier.
    pub fn from_couplings(points: usize, block: usize, visit: &mut Couplings) -> BlockCsr {
        assert!(block == 2 || block == 3, "block size {block}");
        let pattern = Pattern::from_cliques(points, visit);
        let values = vec![0.0; pattern.columns.len() * block * block];
        BlockCsr {
            pattern: Arc::new(pattern),
            block,
            values,
        }
    }

    /// The matrix of a pattern and its blocks, each row by row.
    pub(super) fn from_parts(pattern: Pattern, block: usize, values: Vec<f64>) -> BlockCsr {
        assert_eq!(values.len(), pattern.columns.len() * block * block);
        BlockCsr {
            pattern: Arc::new(pattern),
            block,
            values,
        }
    }

    /// The matrix plus dense symmetric groups as for [`add_group`](BlockCsr::add_group), which may couple points that it does not.
    ///
    /// # Panics
    /// If a group names a point that does not exist, or has not the size of its points.
    pub fn with_groups(&self, groups: &[(Vec<usize>, Vec<f64>)]) -> BlockCsr {
        let size = self.block * self.block;
        let mut new: Vec<(u32, u32)> = Vec::new();
        for (points, _) in groups {
            for &row in points {
                let others = points.iter().filter(|&&c| self.find(row, c).is_none());
                new.extend(others.map(|&column| (row as u32, column as u32)));
            }
        }
        new.sort_unstable();
        new.dedup();
        let mut pattern = Pattern {
            starts: Vec::with_capacity(self.points() + 1),
            columns: Vec::with_capacity(self.pattern.columns.len() + new.len()),
        };
        let mut values = Vec::with_capacity(self.values.len() + new.len() * size);
        pattern.starts.push(0);
        let mut new = new.into_iter().peekable();
        for row in 0..self.points() {
            let blocks = self.row_blocks(row).chunks_exact(size);
            let mut old = self.neighbours(row).iter().zip(blocks).peekable();
            loop {
                let ahead = new.peek().filter(|(r, _)| *r as usize == row).map(|n| n.1);
                match (old.peek(), ahead) {
                    (Some((column, _)), Some(added)) if added < **column => {
                        pattern.columns.push(added);
                        values.resize(values.len() + size, 0.0);
                        new.next();
                    }
                    (Some((column, block)), _) => {
                        pattern.columns.push(**column);
                        values.extend_from_slice(block);
                        old.next();
                    }
                    (None, Some(added)) => {
                        pattern.columns.push(added);
                        values.resize(values.len() + size, 0.0);
                        new.next();
                    }
                    (None, None) => break,
                }
            }
            pattern.starts.push(pattern.columns.len());
        }
        let mut out = BlockCsr::from_parts(pattern, self.block, values);
        for (points, dense) in groups {
            out.add_group(points, dense);
        }
        out
    }

    /// A matrix without points.
    pub fn empty(block: usize) -> BlockCsr {
        BlockCsr::from_couplings(0, block, &mut |_| ())
    }

    /// A zero matrix with the same pattern.
    pub fn zeros_like(&self) -> BlockCsr {
        BlockCsr {
            pattern: Arc::clone(&self.pattern),
            block: self.block,
            values: vec![0.0; self.values.len()],
        }
    }

    /// The pattern, for matrices that share it.
    pub(super) fn shared_pattern(&self) -> Arc<Pattern> {
        Arc::clone(&self.pattern)
    }

    /// Number of points.
    pub fn points(&self) -> usize {
        self.pattern.points()
    }

    /// Number of scalar rows, `points * block`.
    pub fn rows(&self) -> usize {
        self.points() * self.block
    }

    /// Dofs a point: 2 or 3.
    pub fn block_size(&self) -> usize {
        self.block
    }

    /// Number of stored scalars.
    pub fn nnz(&self) -> usize {
        self.values.len()
    }

    /// The points coupled to `point`, ascending.
    pub fn neighbours(&self, point: usize) -> &[u32] {
        self.pattern.row(point)
    }

    /// The blocks of a point's row, in the order of [`neighbours`](BlockCsr::neighbours), each row by row.
    pub fn row_blocks(&self, point: usize) -> &[f64] {
        let size = self.block * self.block;
        &self.values[self.pattern.starts[point] * size..self.pattern.starts[point + 1] * size]
    }

    /// Mixes which points are coupled to these points.
    pub fn mix_pattern(&self, points: Range<usize>, digest: &mut Digest) {
        let starts = &self.pattern.starts[points.start..=points.end];
        let lengths: Vec<u32> = starts.windows(2).map(|w| (w[1] - w[0]) as u32).collect();
        digest.indices(&lengths);
        digest.indices(&self.pattern.columns[starts[0]..starts[points.len()]]);
    }

    /// Mixes the values in the rows of these points, by their bits.
    pub fn mix_values(&self, points: Range<usize>, digest: &mut Digest) {
        let size = self.block * self.block;
        let starts = &self.pattern.starts;
        digest.floats(&self.values[starts[points.start] * size..starts[points.end] * size]);
    }

    /// The entry at two dofs; zero outside the pattern.
    pub fn entry(&self, row: usize, column: usize) -> f64 {
        let b = self.block;
        self.find(row / b, column / b)
            .map_or(0.0, |at| self.values[at + (row % b) * b + column % b])
    }

    /// Where the block of two points starts in `values`.
    #[inline]
    fn find(&self, row: usize, column: usize) -> Option<usize> {
        self.pattern
            .row(row)
            .binary_search(&(column as u32))
            .ok()
            .map(|at| (self.pattern.starts[row] + at) * self.block * self.block)
    }

    /// Sets all values to zero.
    pub fn clear(&mut self) {
        self.values.fill(0.0);
    }

    /// Adds a dense matrix of shape `(n block, n block)`, row by row, that couples `n` points.
    ///
    /// # Panics
    /// If the points were not coupled by [`from_couplings`](BlockCsr::from_couplings).
    pub fn add_group(&mut self, points: &[usize], dense: &[f64]) {
        let b = self.block;
        let width = points.len() * b;
        assert_eq!(dense.len(), width * width, "size of a dense group");
        for (i, &row) in points.iter().enumerate() {
            for (j, &column) in points.iter().enumerate() {
                let Some(at) = self.find(row, column) else {
                    panic!("points {row} and {column} are not coupled");
                };
                for (r, target) in self.values[at..at + b * b].chunks_exact_mut(b).enumerate() {
                    let source = &dense[(i * b + r) * width + j * b..][..b];
                    for (t, s) in target.iter_mut().zip(source) {
                        *t += s;
                    }
                }
            }
        }
    }

    /// Adds `value` to the diagonal at `dof`.
    pub fn add_diagonal(&mut self, dof: usize, value: f64) {
        let at = self.diagonal_position(dof);
        self.values[at] += value;
    }

    /// Adds `factor` times `other`.
    ///
    /// # Panics
    /// If the patterns differ.
    pub fn add_scaled(&mut self, factor: f64, other: &BlockCsr) {
        assert!(
            self.block == other.block
                && (Arc::ptr_eq(&self.pattern, &other.pattern) || self.pattern == other.pattern),
            "matrices with different patterns"
        );
        for (v, o) in self.values.iter_mut().zip(&other.values) {
            *v += factor * o;
        }
    }

    /// Adds `factor` times the rows of these points of `other`, a matrix with the same pattern.
    pub fn add_scaled_rows(&mut self, factor: f64, other: &BlockCsr, points: Range<usize>) {
        let size = self.block * self.block;
        let rows = self.pattern.starts[points.start] * size..self.pattern.starts[points.end] * size;
        for (v, o) in self.values[rows.clone()]
            .iter_mut()
            .zip(&other.values[rows])
        {
            *v += factor * o;
        }
    }

    /// The diagonal, by dof.
    pub fn diagonal(&self) -> Vec<f64> {
        (0..self.rows())
            .map(|dof| self.values[self.diagonal_position(dof)])
            .collect()
    }

    fn diagonal_position(&self, dof: usize) -> usize {
        let (point, component) = (dof / self.block, dof % self.block);
        match self.find(point, point) {
            Some(at) => at + component * (self.block + 1),
            // The constructor couples every point to itself.
            None => unreachable!("point {point} has no diagonal block"),
        }
    }

    /// The first dof in whose row a value is not finite.
    pub fn first_not_finite(&self) -> Option<usize> {
        (0..self.points()).find_map(|point| {
            let at = self.row_blocks(point).iter().position(|v| !v.is_finite())?;
            Some(point * self.block + at % (self.block * self.block) / self.block)
        })
    }

    /// The largest sum of absolute values in a row.
    pub fn norm_inf(&self) -> f64 {
        let b = self.block;
        let mut largest: f64 = 0.0;
        for point in 0..self.points() {
            let mut sums = [0.0; 3];
            for block in self.row_blocks(point).chunks_exact(b * b) {
                for (sum, row) in sums.iter_mut().zip(block.chunks_exact(b)) {
                    *sum += row.iter().map(|v| v.abs()).sum::<f64>();
                }
            }
            largest = sums.into_iter().fold(largest, f64::max);
        }
        largest
    }

    /// `y = A x`. The bits of `y` do not depend on the number of threads.
    ///
    /// # Panics
    /// If `x` or `y` is not of length [`rows`](BlockCsr::rows).
    pub fn mul(&self, x: &[f64], y: &mut [f64]) {
        assert_eq!(x.len(), self.rows(), "length of x");
        assert_eq!(y.len(), self.rows(), "length of y");
        match self.block {
            2 => self.mul_blocks::<2>(x, y),
            _ => self.mul_blocks::<3>(x, y),
        }
    }

    /// The same of several vectors: each product has the bits that [`mul`](BlockCsr::mul) gives, and the matrix is read once for `VECTORS_TOGETHER` of them.
    pub fn mul_all(&self, all: &[&[f64]]) -> Vec<Vec<f64>> {
        let groups = all.chunks(VECTORS_TOGETHER);
        groups
            .flat_map(|group| match (group, self.block) {
                (&[x], _) => {
                    let mut y = vec![0.0; x.len()];
                    self.mul(x, &mut y);
                    vec![y]
                }
                (_, 2) => self.mul_group::<2>(group),
                _ => self.mul_group::<3>(group),
            })
            .collect()
    }

    fn mul_group<const B: usize>(&self, group: &[&[f64]]) -> Vec<Vec<f64>> {
        let rows = self.rows();
        assert!(group.iter().all(|x| x.len() == rows), "length of x");
        let mut x = vec![[0.0; VECTORS_TOGETHER]; rows];
        for (k, vector) in group.iter().enumerate() {
            x.iter_mut().zip(*vector).for_each(|(x, v)| x[k] = *v);
        }
        let mut y = vec![[0.0; VECTORS_TOGETHER]; rows];
        y.par_chunks_mut(ROWS_PER_TASK * B)
            .enumerate()
            .for_each(|(task, part)| {
                for (i, target) in part.chunks_exact_mut(B).enumerate() {
                    let row = task * ROWS_PER_TASK + i;
                    let mut sum = [[0.0; VECTORS_TOGETHER]; B];
                    let columns = self.pattern.row(row);
                    let blocks = self.row_blocks(row).chunks_exact(B * B);
                    for (&column, block) in columns.iter().zip(blocks) {
                        let x = &x[column as usize * B..][..B];
                        for (r, sum) in sum.iter_mut().enumerate() {
                            for (c, x) in x.iter().enumerate() {
                                for (s, x) in sum.iter_mut().zip(x) {
                                    *s += block[r * B + c] * x;
                                }
                            }
                        }
                    }
                    target.copy_from_slice(&sum);
                }
            });
        let of = |k: usize| y.iter().map(|y| y[k]).collect();
        (0..group.len()).map(of).collect()
    }

    fn mul_blocks<const B: usize>(&self, x: &[f64], y: &mut [f64]) {
        y.par_chunks_mut(ROWS_PER_TASK * B)
            .enumerate()
            .for_each(|(task, part)| {
                for (i, target) in part.chunks_exact_mut(B).enumerate() {
                    let row = task * ROWS_PER_TASK + i;
                    let mut sum = [0.0; B];
                    let columns = self.pattern.row(row);
                    let blocks = self.row_blocks(row).chunks_exact(B * B);
                    for (&column, block) in columns.iter().zip(blocks) {
                        let x = &x[column as usize * B..][..B];
                        for (r, s) in sum.iter_mut().enumerate() {
                            for (c, x) in x.iter().enumerate() {
                                *s += block[r * B + c] * x;
                            }
                        }
                    }
                    target.copy_from_slice(&sum);
                }
            });
    }
}

/// Vectors that are multiplied together.
const VECTORS_TOGETHER: usize = 8;

#[cfg(test)]
mod tests {
    use super::super::testing::{dense_of, grid, noise};
    use super::{BlockCsr, VECTORS_TOGETHER};

    #[test]
    fn groups_add_up_and_the_product_matches_dense() {
        for block in [2, 3] {
            let groups: [&[usize]; 3] = [&[0, 1, 3], &[3, 2], &[1, 2, 0]];
            let mut a = BlockCsr::from_couplings(5, block, &mut |add| {
                groups.iter().for_each(|g| add(g));
            });
            let n = 5 * block;
            let mut dense = vec![0.0; n * n];
            let mut seed = 7;
            for group in groups {
                let width = group.len() * block;
                let local = noise(&mut seed, width * width);
                a.add_group(group, &local);
                for i in 0..width {
                    for j in 0..width {
                        let row = group[i / block] * block + i % block;
                        let column = group[j / block] * block + j % block;
                        dense[row * n + column] += local[i * width + j];
                    }
                }
            }
            a.add_diagonal(n - 1, 2.5);
            dense[n * n - 1] += 2.5;
            assert_eq!(dense_of(&a), dense);
            assert_eq!(a.diagonal()[n - 1], 2.5);
            let norm = dense
                .chunks(n)
                .map(|row| row.iter().map(|v| v.abs()).sum::<f64>())
                .fold(0.0, f64::max);
            assert!((a.norm_inf() - norm).abs() < 1e-14);

            let x = noise(&mut seed, n);
            let mut y = vec![f64::NAN; n];
            a.mul(&x, &mut y);
            for i in 0..n {
                let expected: f64 = (0..n).map(|j| dense[i * n + j] * x[j]).sum();
                assert!((y[i] - expected).abs() < 1e-14);
            }
            // Several at a time have the bits of one.
            let many: Vec<Vec<f64>> = (0..VECTORS_TOGETHER + 3)
                .map(|_| noise(&mut seed, n))
                .collect();
            for count in [
                1,
                2,
                VECTORS_TOGETHER,
                VECTORS_TOGETHER + 1,
                VECTORS_TOGETHER + 3,
            ] {
                let some: Vec<&[f64]> = many[..count].iter().map(Vec::as_slice).collect();
                let products = a.mul_all(&some);
                assert_eq!(products.len(), count);
                for (x, product) in some.iter().zip(products) {
                    a.mul(x, &mut y);
                    assert!(
                        y.iter()
                            .map(|y| y.to_bits())
                            .eq(product.iter().map(|p| p.to_bits()))
                    );
                }
            }

            let mut b = a.zeros_like();
            b.add_scaled(-2.0, &a);
            assert_eq!(b.entry(0, 1), -2.0 * a.entry(0, 1));
        }
    }

    #[test]
    fn groups_may_couple_points_that_were_not() {
        for block in [2, 3] {
            let a = grid([5, 3, 1], block);
            let groups: Vec<(Vec<usize>, Vec<f64>)> = [vec![0, 14, 7], vec![7, 8], vec![14, 1]]
                .into_iter()
                .map(|points| {
                    let width = points.len() * block;
                    let dense = noise(&mut 9, width * width);
                    (points, dense)
                })
                .collect();
            let mut expected = BlockCsr::from_couplings(15, block, &mut |add| {
                (0..15).for_each(|i| {
                    let near = a.neighbours(i);
                    near.iter().for_each(|&j| add(&[i, j as usize]));
                });
                groups.iter().for_each(|(points, _)| add(points));
            });
            let sum = a.with_groups(&groups);
            assert_eq!(sum.pattern, expected.pattern);
            for (points, dense) in &groups {
                expected.add_group(points, dense);
            }
            let n = a.rows();
            for (k, value) in dense_of(&sum).into_iter().enumerate() {
                let right = a.entry(k / n, k % n) + expected.entry(k / n, k % n);
                assert!((value - right).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn product_does_not_depend_on_threads() {
        let a = grid([13, 13, 13], 3);
        let x = noise(&mut 3, a.rows());
        let product = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
            let mut y = vec![0.0; a.rows()];
            pool.build().unwrap().install(|| a.mul(&x, &mut y));
            y.iter().map(|v| v.to_bits()).collect::<Vec<_>>()
        };
        assert_eq!(product(1), product(4));
    }

    #[test]
    fn finds_the_row_that_is_not_finite() {
        let mut a = grid([3, 2, 1], 2);
        assert_eq!(a.first_not_finite(), None);
        a.add_diagonal(7, f64::NAN);
        assert_eq!(a.first_not_finite(), Some(7));
    }

    #[test]
    #[should_panic(expected = "not coupled")]
    fn refuses_points_outside_the_pattern() {
        grid([5, 1, 1], 2).add_group(&[0, 4], &[1.0; 16]);
    }
}
