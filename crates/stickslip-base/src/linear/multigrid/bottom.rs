use super::blocks::{Block, Rows, convert};
use crate::math::vector::dot_in_fours;

/// The coarsest operator, factored. Directions without stiffness are left out: the solution is zero along them.
#[derive(Debug, Clone)]
pub(super) struct Bottom {
    n: usize,
    /// Factor of the right-hand sides over those of the matrix given.
    scale: f64,
    /// The operator without what [`factor`](Bottom::factor) adds, row by row.
    matrix: Vec<f64>,
    /// The Cholesky factor, lower triangle; a zero on the diagonal marks a direction left out.
    factor: Vec<f64>,
    /// Whether a direction with a diagonal of its own was left out.
    pub singular: bool,
}

impl Bottom {
    /// Writes the matrix out and factors it.
    pub fn new<const M: usize>(a: &impl Rows<M>, scale: f64) -> Bottom {
        let n = a.count() * M;
        let mut matrix = vec![0.0; n * n];
        for row in 0..a.count() {
            let (columns, blocks) = a.row(row);
            for (&column, block) in columns.iter().zip(blocks) {
                for (r, line) in block.iter().enumerate() {
                    let at = (row * M + r) * n + column as usize * M;
                    matrix[at..at + M].copy_from_slice(line);
                }
            }
        }
        let mut bottom = Bottom {
            n,
            scale,
            matrix,
            factor: Vec::new(),
            singular: false,
        };
        bottom.factor::<M>(&[]);
        bottom
    }

    /// Factors the matrix plus blocks on its diagonal.
    pub fn factor<const M: usize>(&mut self, added: &[(u32, Block<f64, M, M>)]) {
        let n = self.n;
        let mut l = self.matrix.clone();
        for (node, block) in added {
            for (r, line) in block.iter().enumerate() {
                for (c, v) in line.iter().enumerate() {
                    l[(*node as usize * M + r) * n + *node as usize * M + c] += v;
                }
            }
        }
        self.singular = false;
        for i in 0..n {
            let (done, rest) = l.split_at_mut(i * n);
            let row = &mut rest[..n];
            let before = row[i];
            for j in 0..i {
                let other = &done[j * n..j * n + j + 1];
                let diagonal = other[j];
                row[j] = if diagonal == 0.0 {
                    0.0
                } else {
                    (row[j] - dot_in_fours(&row[..j], other)) / diagonal
                };
            }
            let pivot = before - dot_in_fours(&row[..i], &row[..i]);
            // A pivot below this part of its diagonal counts as zero [1]: an unconstrained body.
            row[i] = if pivot > 1e-11 * before {
                pivot.sqrt()
            } else {
                self.singular |= before > 0.0;
                0.0
            };
        }
        self.factor = l;
    }

    /// Solves in place.
    pub fn solve<const M: usize>(&self, rhs: &mut [Block<f32, 1, M>]) {
        let n = self.n;
        let l = &self.factor;
        let mut x: Vec<f64> = rhs
            .as_flattened()
            .as_flattened()
            .iter()
            .map(|&v| v.into())
            .collect();
        for i in 0..n {
            let row = &l[i * n..i * n + i + 1];
            let left = x[i] - dot_in_fours(&row[..i], &x);
            x[i] = if row[i] == 0.0 { 0.0 } else { left / row[i] };
        }
        for i in (0..n).rev() {
            let row = &l[i * n..i * n + i + 1];
            x[i] = if row[i] == 0.0 { 0.0 } else { x[i] / row[i] };
            let value = x[i];
            for (x, l) in x[..i].iter_mut().zip(row) {
                *x -= l * value;
            }
        }
        for (r, x) in rhs.iter_mut().zip(x.as_chunks::<M>().0) {
            *r = convert(&[x.map(|x| x / self.scale)]);
        }
    }

    /// Bytes stored.
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.matrix) + size_of_val(&*self.factor)
    }
}
