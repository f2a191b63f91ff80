//! The Cholesky factor of all free dofs, with blocks of interfaces: faer's supernodal one.
//!
//! The multifrontal factor of this folder could do the same without kept dofs. Measured beside it (one thread, development build, best of 3 to 7):
//! 4 800 dofs in 2D 4.8 ms against 3.8 ms here, 100 000 in 2D 0.214 s against 0.205 s, 31 944 in 3D 0.57 s against 0.67 s, 81 000 in 3D 3.8 s against
//! 4.1 s; a solution takes 0.33 to 0.65 of the time. What it lacks is blocks between points that the matrix does not couple, and counts without the
//! zeros it stores, by which methods are chosen (up to 50 % of the entries in small 2D models): it would change choices, and the bits of every sparse run.

use std::sync::Arc;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{LltError, LltRegularization};
use faer::sparse::linalg::cholesky::supernodal::{self, SupernodalLltRef};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Spec};

use super::symbolic::{FIXED, Symbolic};
use super::{BlockCsr, LinearError};

/// A pivot counts as zero below this many roundings (2.2e-16) per free dof, relative to its diagonal \[1\].
///
/// Where the exact pivot is zero, rounding leaves up to one of these per dof, since on a regular mesh all cells round
/// the same way (measured on bodies that nothing holds: 0.1 to 0.6, at 264 to 59 049 dofs). A sound structure that
/// keeps less would be solved with hardly a correct digit; the softest, a cantilever one element thick, gets there
/// at about two thousand elements of length.
pub const SINGULAR_ROUNDINGS: f64 = 8.0;

/// The Cholesky factor `A = L Lᵀ` of a symmetric positive definite matrix without its fixed dofs.
///
/// The factorisation is faer's supernodal one, on one thread: its bits depend on nothing but the input.
#[derive(Debug)]
pub struct Factor {
    symbolic: Arc<Symbolic>,
    values: Vec<f64>,
    smallest_pivot: (usize, f64),
}

/// The lower triangle in the order of elimination, column by column; entries of a column may repeat.
struct Lower {
    starts: Vec<usize>,
    rows: Vec<usize>,
    values: Vec<f64>,
    diagonal: Vec<f64>,
}

impl Factor {
    /// Factors `matrix` plus dense symmetric blocks `extra`, each given by its dofs and its values row by row.
    /// Rows and columns of fixed dofs are left out. Only one triangle is read: the symmetry is taken for granted.
    ///
    /// # Errors
    /// [`LinearError::NotFinite`], [`LinearError::NotPositive`], [`LinearError::Singular`] with the dof to look at;
    /// [`LinearError::NotAnalysed`] if [`Symbolic::covers`] is false for a block; [`LinearError::OutOfMemory`].
    ///
    /// # Panics
    /// If `matrix` has not the points or block size analysed, or a block not the square of its dofs.
    pub fn new(
        symbolic: &Arc<Symbolic>,
        matrix: &BlockCsr,
        extra: &[(&[usize], &[f64])],
    ) -> Result<Factor, LinearError> {
        let shape = (matrix.points(), matrix.block_size());
        assert_eq!(shape, symbolic.shape, "not the matrix analysed");
        // The factor, and the lower triangle from which it is made.
        let all = symbolic.factor_nonzeros() + 2 * matrix.nnz();
        LinearError::unless_free(8 * all as u64)?;
        let lower = assemble_lower(symbolic, matrix, extra)?;

        let n = symbolic.free();
        let supernodes = &symbolic.supernodes;
        let mut values = zeros(supernodes.len_val())?;
        let scratch = supernodal::factorize_supernodal_numeric_llt_scratch::<usize, f64>(
            supernodes,
            Par::Seq,
            Spec::default(),
        );
        let mut memory = MemBuffer::try_new(scratch).map_err(|_| LinearError::OutOfMemory {
            bytes: scratch.size_bytes() as u64,
        })?;
        let pattern =
            SymbolicSparseColMatRef::new_unsorted_checked(n, n, &lower.starts, None, &lower.rows);
        let result = supernodal::factorize_supernodal_numeric_llt(
            &mut values,
            SparseColMatRef::new(pattern, &lower.values),
            LltRegularization::default(),
            supernodes,
            Par::Seq,
            MemStack::new(&mut memory),
            Spec::default(),
        );
        if let Err(LltError::NonPositivePivot { index }) = result {
            return Err(LinearError::NotPositive {
                dof: symbolic.order[index] as usize,
            });
        }
        let smallest_pivot = check_pivots(symbolic, &values, &lower.diagonal)?;
        Ok(Factor {
            symbolic: Arc::clone(symbolic),
            values,
            smallest_pivot,
        })
    }

    /// The analysis this factor was made with.
    pub fn symbolic(&self) -> &Arc<Symbolic> {
        &self.symbolic
    }

    /// The dof with the smallest pivot relative to its diagonal, and that ratio \[1\]. Near the limit of
    /// [`SINGULAR_ROUNDINGS`] the structure is almost a mechanism.
    pub fn smallest_pivot(&self) -> (usize, f64) {
        self.smallest_pivot
    }

    /// Solves `A x = rhs` in place, for a vector over all dofs: entries of fixed dofs are ignored and become zero.
    ///
    /// # Panics
    /// If `rhs` has not one entry a dof.
    pub fn solve(&self, rhs: &mut [f64]) {
        self.solve_columns(rhs, 1);
    }

    /// Solves for several right-hand sides over all dofs, one after the other in `rhs`; cheaper than one by one.
    ///
    /// # Panics
    /// If `rhs` has not `columns` entries a dof.
    pub fn solve_columns(&self, rhs: &mut [f64], columns: usize) {
        let dofs = self.symbolic.step_of.len();
        assert_eq!(rhs.len(), dofs * columns, "length of the right-hand side");
        let n = self.symbolic.free();
        if n == 0 || columns == 0 {
            rhs.fill(0.0);
            return;
        }
        let mut x = Vec::with_capacity(n * columns);
        for column in rhs.chunks_exact(dofs) {
            x.extend(self.symbolic.order.iter().map(|&dof| column[dof as usize]));
        }
        let supernodes = &self.symbolic.supernodes;
        let scratch = supernodes.solve_in_place_scratch::<f64>(columns, Par::Seq);
        SupernodalLltRef::new(supernodes, &self.values).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(&mut x, n, columns),
            Par::Seq,
            MemStack::new(&mut MemBuffer::new(scratch)),
        );
        rhs.fill(0.0);
        for (column, x) in rhs.chunks_exact_mut(dofs).zip(x.chunks_exact(n)) {
            for (&dof, &x) in self.symbolic.order.iter().zip(x) {
                column[dof as usize] = x;
            }
        }
    }
}

/// Zeros, or the news that they do not fit.
pub(super) fn zeros(length: usize) -> Result<Vec<f64>, LinearError> {
    bytemuck::try_zeroed_vec(length).map_err(|()| LinearError::OutOfMemory {
        bytes: 8 * length as u64,
    })
}

/// Collects the matrix and the extra blocks in the order of elimination.
fn assemble_lower(
    symbolic: &Symbolic,
    matrix: &BlockCsr,
    extra: &[(&[usize], &[f64])],
) -> Result<Lower, LinearError> {
    let blocks = lower_of_blocks(symbolic, extra)?;
    let mut blocks = blocks.into_iter().peekable();
    let b = matrix.block_size();
    let n = symbolic.free();
    let expected = matrix.nnz() / 2 + n + blocks.len();
    let mut lower = Lower {
        starts: Vec::with_capacity(n + 1),
        rows: Vec::with_capacity(expected),
        values: Vec::with_capacity(expected),
        diagonal: Vec::with_capacity(n),
    };
    lower.starts.push(0);
    for (column, &dof) in symbolic.order.iter().enumerate() {
        let (point, component) = (dof as usize / b, dof as usize % b);
        let mut diagonal = 0.0;
        let mut finite = true;
        let mut push = |row: usize, value: f64| {
            finite &= value.is_finite();
            if row == column {
                diagonal += value;
            }
            lower.rows.push(row);
            lower.values.push(value);
        };
        // By symmetry the column is read from the row of the same dof.
        let row_blocks = matrix.row_blocks(point).chunks_exact(b * b);
        for (&other, block) in matrix.neighbours(point).iter().zip(row_blocks) {
            let steps = &symbolic.step_of[other as usize * b..][..b];
            for (&row, &value) in steps.iter().zip(&block[component * b..]) {
                if row != FIXED && row as usize >= column {
                    push(row as usize, value);
                }
            }
        }
        while let Some((_, row, value)) = blocks.next_if(|entry| entry.0 as usize == column) {
            push(row as usize, value);
        }
        // A sum of finite values may still overflow.
        if !(finite && diagonal.is_finite()) {
            return Err(LinearError::NotFinite { dof: dof as usize });
        }
        lower.diagonal.push(diagonal);
        lower.starts.push(lower.rows.len());
    }
    Ok(lower)
}

/// The lower triangles of dense blocks as `(column, row, value)` by steps, sorted by column.
fn lower_of_blocks(
    symbolic: &Symbolic,
    extra: &[(&[usize], &[f64])],
) -> Result<Vec<(u32, u32, f64)>, LinearError> {
    let mut entries = Vec::new();
    for &(dofs, dense) in extra {
        assert_eq!(
            dense.len(),
            dofs.len() * dofs.len(),
            "size of a dense block"
        );
        if let Some(dofs) = symbolic.first_uncovered(dofs) {
            return Err(LinearError::NotAnalysed { dofs });
        }
        for (&i, values) in dofs.iter().zip(dense.chunks_exact(dofs.len())) {
            let row = symbolic.step_of[i];
            if row == FIXED {
                continue;
            }
            for (&j, &value) in dofs.iter().zip(values) {
                let column = symbolic.step_of[j];
                if column != FIXED && row >= column {
                    entries.push((column, row, value));
                }
            }
        }
    }
    // Stable: repeated entries are added in the order they came.
    entries.sort_by_key(|entry| (entry.0, entry.1));
    Ok(entries)
}

/// The smallest pivot relative to the diagonal and its dof, or an error if it counts as zero.
fn check_pivots(
    symbolic: &Symbolic,
    values: &[f64],
    diagonal: &[f64],
) -> Result<(usize, f64), LinearError> {
    let mut smallest = (0, f64::INFINITY);
    let factor = SupernodalLltRef::new(&symbolic.supernodes, values);
    for s in 0..symbolic.supernodes.n_supernodes() {
        let supernode = factor.supernode(s);
        let block = supernode.val();
        for i in 0..block.ncols() {
            let step = supernode.start() + i;
            let ratio = block[(i, i)] * block[(i, i)] / diagonal[step];
            let dof = symbolic.order[step] as usize;
            if ratio.is_nan() {
                return Err(LinearError::NotFinite { dof });
            }
            if ratio < smallest.1 {
                smallest = (dof, ratio);
            }
        }
    }
    let (dof, ratio) = smallest;
    if ratio < SINGULAR_ROUNDINGS * f64::EPSILON * symbolic.free() as f64 {
        return Err(LinearError::Singular { dof, ratio });
    }
    Ok(smallest)
}

#[cfg(test)]
mod tests {
    use super::super::testing::{self, dense_of, grid, noise};
    use super::*;

    fn analyze(matrix: &BlockCsr, fixed: &[bool], extra: &[Vec<usize>]) -> Arc<Symbolic> {
        Arc::new(Symbolic::analyze(matrix, fixed, extra).unwrap())
    }

    /// The solution with all dofs by dense elimination, fixed rows replaced by the identity.
    fn dense_solution(dense: &[f64], fixed: &[bool], rhs: &[f64]) -> Vec<f64> {
        let n = rhs.len();
        let mut dense = dense.to_vec();
        let mut x = rhs.to_vec();
        for i in (0..n).filter(|&i| fixed[i]) {
            for j in 0..n {
                dense[i * n + j] = 0.0;
                dense[j * n + i] = 0.0;
            }
            dense[i * n + i] = 1.0;
            x[i] = 0.0;
        }
        testing::dense_solution(&dense, &x)
    }

    fn assert_close(x: &[f64], y: &[f64], tolerance: f64) {
        let size = y.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
        for (i, (a, b)) in x.iter().zip(y).enumerate() {
            assert!((a - b).abs() < tolerance * size, "{i}: {a} instead of {b}");
        }
    }

    /// Holds a face, and single dofs elsewhere.
    fn supports(a: &BlockCsr, held_points: usize) -> Vec<bool> {
        let mut fixed = vec![false; a.rows()];
        fixed[..held_points * a.block_size()].fill(true);
        for dof in [a.rows() - 1, a.rows() / 2, a.rows() / 2 + 3] {
            fixed[dof] = true;
        }
        fixed
    }

    #[test]
    fn solves_as_dense_elimination_does() {
        // Below and above the size from which METIS orders.
        for (counts, block) in [
            ([4, 3, 1], 2),
            ([12, 11, 1], 2),
            ([3, 3, 2], 3),
            ([5, 4, 4], 3),
        ] {
            let a = grid(counts, block);
            let fixed = supports(&a, counts[0]);
            let symbolic = analyze(&a, &fixed, &[]);
            assert_eq!(symbolic.free(), fixed.iter().filter(|f| !**f).count());
            assert!(symbolic.factor_nonzeros() >= symbolic.free());
            let factor = Factor::new(&symbolic, &a, &[]).unwrap();
            let rhs = noise(&mut 5, a.rows());
            let mut x = rhs.clone();
            factor.solve(&mut x);
            assert_close(&x, &dense_solution(&dense_of(&a), &fixed, &rhs), 1e-12);
            assert!(fixed.iter().zip(&x).all(|(&f, &x)| !f || x == 0.0));

            let mut two = [rhs.clone(), noise(&mut 6, a.rows())].concat();
            let mut second = two[a.rows()..].to_vec();
            factor.solve_columns(&mut two, 2);
            factor.solve(&mut second);
            assert_close(&two[..a.rows()], &x, 1e-13);
            assert_close(&two[a.rows()..], &second, 1e-13);
        }
    }

    #[test]
    fn extra_blocks_are_added_where_analysed() {
        let a = grid([5, 4, 4], 3);
        let n = a.rows();
        let mut fixed = supports(&a, 5);
        // Couples far ends, one of them with a fixed dof, and repeats a pair the matrix has.
        let far: Vec<usize> = vec![20, 31, n - 2, n - 5, 100];
        let near: Vec<usize> = vec![100, 101, 103];
        fixed[31] = true;
        let block = |dofs: &[usize], seed: u64| {
            let m = dofs.len();
            let b = noise(&mut { seed }, m * m);
            let entry = |k: usize| (0..m).map(|q| b[k / m * m + q] * b[k % m * m + q]).sum();
            (0..m * m).map(entry).collect::<Vec<f64>>()
        };
        let (far_block, near_block) = (block(&far, 1), block(&near, 2));
        let extra: [(&[usize], &[f64]); 2] = [(&far, &far_block), (&near, &near_block)];

        let plain = analyze(&a, &fixed, &[]);
        assert!(!plain.covers(&far) && plain.covers(&near));
        match Factor::new(&plain, &a, &extra) {
            Err(LinearError::NotAnalysed { dofs: [i, j] }) => {
                assert!(!plain.covers(&[i, j]) && far.contains(&i) && far.contains(&j));
            }
            other => panic!("{other:?}"),
        }

        let symbolic = analyze(&a, &fixed, std::slice::from_ref(&far));
        assert!(symbolic.covers(&far) && symbolic.covers(&near));
        let factor = Factor::new(&symbolic, &a, &extra).unwrap();
        let mut dense = dense_of(&a);
        for (dofs, values) in extra {
            for (i, &row) in dofs.iter().enumerate() {
                for (j, &column) in dofs.iter().enumerate() {
                    dense[row * n + column] += values[i * dofs.len() + j];
                }
            }
        }
        let rhs = noise(&mut 5, n);
        let mut x = rhs.clone();
        factor.solve(&mut x);
        assert_close(&x, &dense_solution(&dense, &fixed, &rhs), 1e-12);
    }

    #[test]
    fn fill_takes_blocks_that_were_not_announced() {
        let a = grid([9, 9, 1], 2);
        let fixed = supports(&a, 9);
        let symbolic = analyze(&a, &fixed, &[]);
        // Some pair that the factor fills although the matrix does not couple it.
        let filled = (0..a.rows())
            .flat_map(|i| (0..i).map(move |j| [i, j]))
            .find(|&[i, j]| {
                !fixed[i]
                    && !fixed[j]
                    && symbolic.covers(&[i, j])
                    && !a.neighbours(i / 2).contains(&((j / 2) as u32))
            })
            .unwrap();
        let spring = [1.0, -1.0, -1.0, 1.0];
        let factor = Factor::new(&symbolic, &a, &[(&filled, &spring)]).unwrap();
        let n = a.rows();
        let mut dense = dense_of(&a);
        for (k, value) in spring.into_iter().enumerate() {
            dense[filled[k / 2] * n + filled[k % 2]] += value;
        }
        let rhs = noise(&mut 8, n);
        let mut x = rhs.clone();
        factor.solve(&mut x);
        assert_close(&x, &dense_solution(&dense, &fixed, &rhs), 1e-12);
    }

    #[test]
    fn what_nothing_holds_is_singular() {
        for (counts, block) in [([12, 11, 1], 2), ([9, 9, 9], 3), ([3, 2, 1], 2)] {
            let a = grid(counts, block);
            let mut fixed = vec![false; a.rows()];
            // Free along the last axis only: the culprit moves along it.
            for (dof, fixed) in fixed.iter_mut().enumerate().take(7 * block) {
                *fixed = dof % block != block - 1;
            }
            match Factor::new(&analyze(&a, &fixed, &[]), &a, &[]) {
                Err(LinearError::Singular { dof, ratio }) => {
                    assert!(dof % block == block - 1 && ratio < 1e-12, "{dof} {ratio}");
                }
                Err(LinearError::NotPositive { dof }) => assert_eq!(dof % block, block - 1),
                other => panic!("{other:?}"),
            }
            fixed[block - 1] = true;
            let factor = Factor::new(&analyze(&a, &fixed, &[]), &a, &[]).unwrap();
            assert!(factor.smallest_pivot().1 > 1e-6);
        }
    }

    #[test]
    fn the_dof_of_a_bad_pivot_is_named() {
        let mut a = grid([12, 11, 1], 2);
        let fixed = supports(&a, 12);
        let bad = 57;
        assert!(!fixed[bad]);
        a.add_diagonal(bad, -1000.0);
        let symbolic = analyze(&a, &fixed, &[]);
        let error = Factor::new(&symbolic, &a, &[]).unwrap_err();
        assert_eq!(error, LinearError::NotPositive { dof: bad });
        a.add_diagonal(bad, f64::INFINITY);
        let error = Factor::new(&symbolic, &a, &[]).unwrap_err();
        assert!(matches!(error, LinearError::NotFinite { .. }));
        // A point no cell touches, and a block with a NaN.
        let alone = BlockCsr::from_couplings(1, 2, &mut |_| ());
        let symbolic = analyze(&alone, &[false, true], &[]);
        let error = Factor::new(&symbolic, &alone, &[]).unwrap_err();
        assert_eq!(error.dof(), Some(0));
        let error = Factor::new(&symbolic, &alone, &[(&[0], &[f64::NAN])]).unwrap_err();
        assert_eq!(error, LinearError::NotFinite { dof: 0 });
    }

    #[test]
    fn everything_may_be_fixed() {
        let a = grid([3, 2, 1], 2);
        let factor = Factor::new(&analyze(&a, &[true; 12], &[]), &a, &[]).unwrap();
        let mut x = vec![1.0; 12];
        factor.solve(&mut x);
        assert_eq!(x, [0.0; 12]);
    }

    #[test]
    fn factors_repeat_bit_by_bit() {
        let a = grid([7, 6, 5], 3);
        let fixed = supports(&a, 7);
        let solution = || {
            let factor = Factor::new(&analyze(&a, &fixed, &[]), &a, &[]).unwrap();
            let mut x = noise(&mut 4, a.rows());
            factor.solve(&mut x);
            x.iter().map(|v| v.to_bits()).collect::<Vec<_>>()
        };
        assert_eq!(solution(), solution());
    }
}
