//! The matrix of the preconditioner: one row for every gap, slip and artificial spring.

use rayon::prelude::*;

use super::active::NONE;
use super::lu::Entry;
use super::rows::{Rows, at_active};
use super::tangent::Tangent;
use crate::math::vector::dot;

/// Columns that one task makes, so that it can use its memory again.
const COLUMNS: usize = 16;

/// What the matrix is made of: `[[I + C W Bᵀ, -C Z], [σ Zᵀ Bᵀ, I - σ Rᵀ Z]]`.
pub(super) struct SmallMatrix<'a> {
    pub tangent: &'a Tangent<'a>,
    /// `B` and `C`.
    pub rows: &'a [Rows],
    /// Rows of all points.
    pub count: usize,
    /// `σ` and `Z` at the active dofs of each spring.
    pub springs: &'a [(f64, Vec<f64>)],
}

/// Work space of a task.
struct Scratch<T> {
    /// `W Bᵀ e` at the active dofs of the parts met.
    product: Vec<T>,
    /// The parts met.
    met: Vec<usize>,
    local: Vec<T>,
}

impl SmallMatrix<'_> {
    /// The matrix, column by column, and the size of `C W Bᵀ`.
    pub fn assemble<T: Entry>(&self) -> (Vec<T>, f64) {
        let size = self.count + self.springs.len();
        // `Bᵀ` column by column: the points' rows spread over the active dofs
        let columns: Vec<(&Rows, usize)> = self
            .rows
            .iter()
            .flat_map(|rows| (0..rows.count()).map(move |q| (rows, q)))
            .collect();
        let springs = self.springs.len();
        let mut matrix = Vec::with_capacity(size * size);
        matrix.resize(size * self.count, T::of(0.0));
        matrix
            .par_chunks_mut(COLUMNS * size.max(1))
            .zip(columns.par_chunks(COLUMNS))
            .for_each(|(out, columns)| {
                let mut scratch = Scratch {
                    product: vec![T::of(0.0); self.tangent.active.len()],
                    met: Vec::new(),
                    local: Vec::new(),
                };
                for (out, &(rows, q)) in out.chunks_exact_mut(size.max(1)).zip(columns) {
                    self.column(rows, q, &mut scratch, out.split_at_mut(size - springs));
                }
            });
        let mut amplification = 0.0_f64;
        for k in 0..self.count {
            let diagonal = &mut matrix[k * size + k];
            amplification = amplification.max(diagonal.to().abs());
            *diagonal += T::of(1.0);
        }
        self.spring_columns(&mut matrix);
        (matrix, amplification)
    }

    /// The column of row `q` of a point: `C W Bᵀ e` and `σ Zᵀ Bᵀ e`.
    fn column<T: Entry>(
        &self,
        rows: &Rows,
        q: usize,
        scratch: &mut Scratch<T>,
        (out, of_springs): (&mut [T], &mut [T]),
    ) {
        self.compliance_product(rows, q, scratch);
        let Scratch {
            product,
            met,
            local,
        } = scratch;
        let active = self.tangent.active;
        let in_part = |i: usize| {
            met.iter()
                .any(|&part| (active.starts[part]..active.starts[part + 1]).contains(&i))
        };
        let all = met.len() == self.tangent.condensation.parts.len();
        let mut out = out.iter_mut();
        for other in self.rows {
            local.clear();
            local.resize(other.at.len(), T::of(0.0));
            for (l, &at) in local.iter_mut().zip(&other.at) {
                if at != NONE && (all || in_part(at as usize)) {
                    *l = product[at as usize];
                }
            }
            for (changes, out) in other.changes().zip(&mut out) {
                for (c, l) in changes.iter().zip(&*local) {
                    *out += T::of(*c) * *l;
                }
            }
        }
        for ((sigma, z), out) in self.springs.iter().zip(of_springs) {
            let mut sum = 0.0;
            for (at, b) in rows.gradient(q) {
                sum += b * z[at];
            }
            *out = T::of(sigma * sum);
        }
    }

    /// `W Bᵀ e` for row `q` of a point, in the parts that it touches.
    fn compliance_product<T: Entry>(&self, rows: &Rows, q: usize, scratch: &mut Scratch<T>) {
        let Tangent {
            condensation,
            active,
            ..
        } = self.tangent;
        scratch.met.clear();
        for (at, b) in rows.gradient(q).filter(|(_, b)| *b != 0.0) {
            let part = active.part_of(at);
            let start = active.starts[part];
            let column = T::column(active.compliance(condensation, part), at - start);
            let target = &mut scratch.product[start..start + column.len()];
            if scratch.met.contains(&part) {
                T::add_scaled(target, T::of(b), column);
            } else {
                scratch.met.push(part);
                T::set_scaled(target, T::of(b), column);
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
