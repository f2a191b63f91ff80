//! The matrix of the preconditioner: one row for every gap, slip and artificial spring.

use std::collections::BTreeMap;

use faer::linalg::matmul::matmul;
use faer::{Accum, MatMut, MatRef, Par};
use rayon::prelude::*;

use super::gap_matrix::Placed;
use super::lu::Entry;
use super::rows::{Rows, at_active};
use super::tangent::Tangent;
use crate::linear::Compliance;
use crate::math::vector::dot;

/// Columns that are made together. Points beside each other share most of their nodes: a product of matrices takes each column of the compliance once for all
/// of them, and rows of it serve as many columns with one instruction.
const COLUMNS_TOGETHER: usize = 16;

/// What the matrix is made of: `[[I + C W Bᵀ, -C Z], [σ Zᵀ Bᵀ, I - σ Rᵀ Z]]`.
pub(super) struct SmallMatrix<'a> {
    pub tangent: &'a Tangent<'a>,
    /// `B` and `C`.
    pub rows: &'a [Rows],
    /// Rows of all points.
    pub count: usize,
    /// `σ` and `Z` at the active dofs of each spring.
    pub springs: &'a [(f64, Vec<f64>)],
    /// `B W Bᵀ` where it is known; without springs.
    pub kept: Option<Placed<'a>>,
}

/// Some columns of `Bᵀ`, and what the compliance makes of them.
struct Block<'a> {
    /// Row `q` of a point each.
    columns: &'a [(&'a Rows, usize)],
}

impl Block<'_> {
    /// `W Bᵀ` at all active dofs, by dof. Zero columns fill it up.
    fn compliance_product<T: Entry>(&self, tangent: &Tangent) -> Vec<[T; COLUMNS_TOGETHER]> {
        let Tangent {
            condensation,
            active,
            ..
        } = tangent;
        let mut out = vec![[T::of(0.0); COLUMNS_TOGETHER]; active.len()];
        let entries = self.entries::<T>();
        let mut wide = Vec::new();
        for part in 0..condensation.parts.len() {
            let (start, end) = (active.starts[part], active.starts[part + 1]);
            let own = entries.range(start..end);
            let coefficients: Vec<[T; COLUMNS_TOGETHER]> = own.clone().map(|(_, b)| *b).collect();
            if coefficients.is_empty() {
                continue;
            }
            let w = active.compliance(condensation, part);
            if !w.is_here() {
                elsewhere(w, own.map(|(at, b)| (at - start, b)), &mut out[start..end]);
                continue;
            }
            wide.clear();
            own.for_each(|(at, _)| wide.extend_from_slice(T::column(w, at - start)));
            matmul(
                MatMut::from_row_major_slice_mut(
                    out[start..end].as_flattened_mut(),
                    end - start,
                    COLUMNS_TOGETHER,
                ),
                Accum::Replace,
                MatRef::from_column_major_slice(&wide, end - start, coefficients.len()),
                MatRef::from_row_major_slice(
                    coefficients.as_flattened(),
                    coefficients.len(),
                    COLUMNS_TOGETHER,
                ),
                T::of(1.0),
                Par::Seq,
            );
        }
        out
    }

    /// Entries of the columns by active dof.
    fn entries<T: Entry>(&self) -> BTreeMap<usize, [T; COLUMNS_TOGETHER]> {
        let mut entries = BTreeMap::new();
        for (k, &(rows, q)) in self.columns.iter().enumerate() {
            for (at, b) in rows.gradient(q).filter(|(_, b)| *b != 0.0) {
                let row = entries.entry(at).or_insert([T::of(0.0); COLUMNS_TOGETHER]);
                row[k] += T::of(b);
            }
        }
        entries
    }
}

/// The same with a compliance that an engine has: all columns go there at once.
fn elsewhere<'a, T: Entry + 'a>(
    w: &Compliance,
    entries: impl Iterator<Item = (usize, &'a [T; COLUMNS_TOGETHER])>,
    out: &mut [[T; COLUMNS_TOGETHER]],
) {
    let n = out.len();
    let mut x = vec![0.0; n * COLUMNS_TOGETHER];
    for (at, row) in entries {
        for (k, b) in row.iter().enumerate() {
            x[k * n + at] = b.to();
        }
    }
    let mut y = vec![0.0; x.len()];
    w.mul_all(&x, &mut y);
    for (k, column) in y.chunks_exact(n).enumerate() {
        for (row, &value) in out.iter_mut().zip(column) {
            row[k] = T::of(value);
        }
    }
}

impl SmallMatrix<'_> {
    /// The matrix, column by column, and the size of `C W Bᵀ`.
    pub fn assemble<T: Entry>(&self) -> (Vec<T>, f64) {
        if let Some(kept) = &self.kept {
            return kept.assemble();
        }
        let size = self.count + self.springs.len();
        // `Bᵀ` column by column: the points' rows spread over the active dofs
        let columns: Vec<(&Rows, usize)> = self
            .rows
            .iter()
            .flat_map(|rows| (0..rows.count()).map(move |q| (rows, q)))
            .collect();
        let mut matrix = Vec::with_capacity(size * size);
        matrix.resize(size * self.count, T::of(0.0));
        matrix
            .par_chunks_mut(COLUMNS_TOGETHER * size.max(1))
            .zip(columns.par_chunks(COLUMNS_TOGETHER))
            .for_each(|(out, columns)| self.columns(&Block { columns }, out));
        let mut amplification = 0.0_f64;
        for k in 0..self.count {
            let diagonal = &mut matrix[k * size + k];
            amplification = amplification.max(diagonal.to().abs());
            *diagonal += T::of(1.0);
        }
        self.spring_columns(&mut matrix);
        (matrix, amplification)
    }

    /// Columns of the matrix: `C W Bᵀ` and `σ Zᵀ Bᵀ`.
    fn columns<T: Entry>(&self, block: &Block, out: &mut [T]) {
        let product = block.compliance_product::<T>(self.tangent);
        let size = self.count + self.springs.len();
        let changes = self.rows.iter().flat_map(|rows| {
            let of_point = rows.changes();
            of_point.map(|changes| (&rows.at, changes))
        });
        for (row, (at, changes)) in changes.enumerate() {
            let mut sums = [T::of(0.0); COLUMNS_TOGETHER];
            for (at, c) in at_active(at, changes) {
                let c = T::of(c);
                for (sum, p) in sums.iter_mut().zip(&product[at]) {
                    *sum += c * *p;
                }
            }
            for (column, sum) in out.chunks_exact_mut(size).zip(sums) {
                column[row] = sum;
            }
        }
        for (column, &(rows, q)) in out.chunks_exact_mut(size).zip(block.columns) {
            for (out, (sigma, z)) in column[self.count..].iter_mut().zip(self.springs) {
                let sum: f64 = rows.gradient(q).map(|(at, b)| b * z[at]).sum();
                *out = T::of(sigma * sum);
            }
        }
    }

    /// Appends the columns of the springs: `-C Z` and `I - σ Rᵀ Z`.
    fn spring_columns<T: Entry>(&self, matrix: &mut Vec<T>) {
        let springs = self.tangent.springs;
        for (k, (spring, (_, z))) in springs.iter().zip(self.springs).enumerate() {
            for rows in self.rows {
                for changes in rows.changes() {
                    let mut sum = 0.0;
                    for (at, c) in at_active(&rows.at, changes) {
                        sum += c * z[at];
                    }
                    matrix.push(T::of(-sum));
                }
            }
            for (j, other) in springs.iter().enumerate() {
                let unit = if j == k { 1.0 } else { 0.0 };
                let shared = if other.start == spring.start {
                    other.sigma * dot(other.mode, spring.product)
                } else {
                    0.0
                };
                matrix.push(T::of(unit - shared));
            }
        }
    }
}
