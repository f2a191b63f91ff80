use std::fmt::Debug;
use std::ops::Range;

use super::BlockCsr;

/// A symmetric matrix over the points of a mesh, whether its entries are kept or made whenever they are asked for.
pub trait Matrix: Debug + Send + Sync {
    /// Number of points.
    fn points(&self) -> usize;

    /// Dofs a point: 2 or 3.
    fn block_size(&self) -> usize;

    /// Products with several vectors, whose bits do not depend on the number of threads.
    ///
    /// # Panics
    /// If a vector has not one entry a dof.
    fn mul_all(&self, all: &[&[f64]]) -> Vec<Vec<f64>>;

    /// The diagonal, by dof.
    fn diagonal(&self) -> Vec<f64>;

    /// Hands out what the matrix is a sum of, row, column and value, in the rows of these points at least, in an order that does not depend on the number of threads.
    fn summands(&self, points: Range<usize>, visit: &mut Summands);

    /// The matrix with its entries, or, if it is not kept, what tells it from others.
    fn kept(&self) -> Result<&BlockCsr, [u64; 2]>;

    /// The cells whose matrices are summands in the rows of these points, where whoever factors the matrix may compute them.
    fn cells(&self, _points: Range<usize>) -> Option<Box<dyn Cells + '_>> {
        None
    }

    /// Makes all entries.
    fn make(&self) -> BlockCsr;

    /// The product with a vector.
    ///
    /// # Panics
    /// If the vector has not one entry a dof.
    fn times(&self, x: &[f64]) -> Vec<f64> {
        self.mul_all(&[x]).swap_remove(0)
    }

    /// The entry at two dofs.
    fn at(&self, row: usize, column: usize) -> f64 {
        match self.kept() {
            Ok(kept) => kept.entry(row, column),
            Err(_) => {
                let mut unit = vec![0.0; self.points() * self.block_size()];
                unit[column] = 1.0;
                self.times(&unit)[row]
            }
        }
    }
}

/// Cells that a matrix is a sum over, which may be computed elsewhere.
pub trait Cells {
    /// Hands out the points of each cell, in the order of their numbers.
    fn couplings(&self, visit: &mut dyn FnMut(&[usize]));

    /// What makes the matrices of some cells, given by ascending numbers: body by body the points that they couple, ascending, and bytes, which this room cannot read.
    fn portions(&self, cells: &[u32]) -> Vec<(Vec<usize>, Vec<u8>)>;

    /// Hands out the summands that are not of cells: row, column and value.
    fn others(&self, visit: &mut Summands);
}

/// Takes row, column and value.
pub type Summands<'a> = dyn FnMut(usize, usize, f64) + Send + 'a;

impl Matrix for BlockCsr {
    fn points(&self) -> usize {
        self.points()
    }

    fn block_size(&self) -> usize {
        self.block_size()
    }

    fn mul_all(&self, all: &[&[f64]]) -> Vec<Vec<f64>> {
        self.mul_all(all)
    }

    fn diagonal(&self) -> Vec<f64> {
        self.diagonal()
    }

    fn summands(&self, points: Range<usize>, visit: &mut Summands) {
        let b = self.block_size();
        for point in points {
            let blocks = self.row_blocks(point).chunks_exact(b * b);
            for (&other, block) in self.neighbours(point).iter().zip(blocks) {
                for (k, &value) in block.iter().enumerate() {
                    visit(point * b + k / b, other as usize * b + k % b, value);
                }
            }
        }
    }

    fn kept(&self) -> Result<&BlockCsr, [u64; 2]> {
        Ok(self)
    }

    fn make(&self) -> BlockCsr {
        self.clone()
    }
}
