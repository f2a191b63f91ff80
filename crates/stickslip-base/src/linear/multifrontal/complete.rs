//! The factor of a whole matrix and of blocks that come and go, such as those of contact.

use std::sync::Arc;

use super::super::ordering::NONE;
use super::super::{BlockCsr, LinearError};
use super::graph::Nodes;
use super::numeric::{Entry, PartialFactor, Workspace};
use super::symbolic::Fronts;
use crate::linear::multifrontal::sweep;

/// Where the entries of a Cholesky factor are, for one pattern and one set of fixed dofs.
///
/// The points are ordered by nested dissection of their coupling graph
/// ([Karypis and Kumar 1998](crate::references::karypis_kumar_1998)), which in 3D leaves a third of the work of a
/// minimum-degree ordering of the dofs. The free dofs of a point follow each other.
#[derive(Debug)]
pub struct Symbolic {
    fronts: Arc<Fronts>,
    nonzeros: usize,
    flops: f64,
}

/// The Cholesky factor `A = L Lᵀ` of a symmetric positive definite matrix without its fixed dofs; its bits are the same on any number of threads.
#[derive(Debug)]
pub struct Factor {
    partial: PartialFactor,
}

impl Symbolic {
    /// Analyses `matrix` without the dofs marked in `fixed`, together with groups of dofs that are `extra` coupled,
    /// such as the candidates of a contact.
    ///
    /// # Errors
    /// [`LinearError::OutOfMemory`].
    ///
    /// # Panics
    /// If `fixed` has not one entry a dof or a group names a dof that does not exist.
    pub fn analyze(
        matrix: &BlockCsr,
        fixed: &[bool],
        extra: &[Vec<usize>],
    ) -> Result<Symbolic, LinearError> {
        assert_eq!(fixed.len(), matrix.rows(), "length of `fixed`");
        let points = matrix.points();
        let mut nodes = Nodes::new(matrix, 0..points, fixed, &vec![false; points])?;
        nodes.couple(extra);
        let elimination = nodes.elimination();
        let dofs = |node| nodes.free(node).count();
        let counts = nodes.column_counts(&elimination, dofs);
        // The columns of the dofs of a node: each one shorter by one than that before it.
        let columns = elimination.order.iter().zip(&counts);
        let columns = columns.flat_map(|(&node, &count)| (0..dofs(node)).map(move |k| count - k));
        Ok(Symbolic {
            nonzeros: columns.clone().sum(),
            flops: columns.map(|count| (count as f64).powi(2)).sum(),
            fronts: Arc::new(Fronts::of_nodes(&nodes, &elimination)?),
        })
    }

    /// Whether the free ones of these dofs may all be coupled to each other without a new analysis.
    ///
    /// What the factor stores counts, not what the matrix couples: fill can be used by any later block.
    pub fn covers(&self, dofs: &[usize]) -> bool {
        self.fronts.first_uncovered(dofs).is_none()
    }

    /// Entries of the factor, without the zeros stored to make its blocks larger.
    pub fn factor_nonzeros(&self) -> usize {
        self.nonzeros
    }

    /// Additions and multiplications of one factorisation.
    pub fn flops(&self) -> f64 {
        self.flops
    }

    /// Lower triangles of dense blocks, in the order of their columns.
    fn entries(&self, blocks: &[(&[usize], &[f64])]) -> Result<Vec<Entry>, LinearError> {
        let mut entries = Vec::new();
        for &(dofs, dense) in blocks {
            assert_eq!(dense.len(), dofs.len().pow(2), "size of a dense block");
            if let Some(dofs) = self.fronts.first_uncovered(dofs) {
                return Err(LinearError::NotAnalysed { dofs });
            }
            let position = |&dof: &usize| self.fronts.position_of[dof];
            let free = |at: &(u32, usize)| at.0 != NONE;
            let columns: Vec<_> = dofs.iter().map(position).zip(0..).filter(free).collect();
            for &(row, i) in &columns {
                let left = columns.iter().filter(|(column, _)| row >= *column);
                entries.extend(left.map(|&(column, j)| Entry {
                    row,
                    column,
                    value: dense[i * dofs.len() + j],
                }));
            }
        }
        // Stable: repeated entries are added in the order they came.
        entries.sort_by_key(|entry| (entry.column, entry.row));
        Ok(entries)
    }
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
        symbolic: &Symbolic,
        matrix: &BlockCsr,
        extra: &[(&[usize], &[f64])],
    ) -> Result<Factor, LinearError> {
        let fronts = &symbolic.fronts;
        LinearError::unless_free(fronts.peak_bytes())?;
        let entries = symbolic.entries(extra)?;
        let workspace = Workspace::of([fronts.longest()]);
        let (partial, _) = PartialFactor::with(fronts, matrix, &entries, &workspace)?;
        Ok(Factor { partial })
    }

    /// The dof with the smallest pivot relative to its diagonal, and that ratio \[1\]. Near the limit of
    /// [`SINGULAR_ROUNDINGS`](super::super::SINGULAR_ROUNDINGS) the structure is almost a mechanism.
    pub fn smallest_pivot(&self) -> (usize, f64) {
        self.partial.smallest_pivot()
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
        let fronts = self.partial.fronts();
        let (dofs, order) = (fronts.position_of.len(), fronts.interior());
        assert_eq!(rhs.len(), dofs * columns, "length of the right-hand side");
        let mut x = Vec::with_capacity(order.len() * columns);
        for column in rhs.chunks_exact(dofs.max(1)) {
            x.extend(order.iter().map(|&dof| column[dof as usize]));
        }
        sweep::forward(&self.partial, &mut x, &mut [], columns);
        sweep::backward(&self.partial, &mut x, &[], columns);
        rhs.fill(0.0);
        let solutions = x.chunks_exact(order.len().max(1));
        for (column, x) in rhs.chunks_exact_mut(dofs.max(1)).zip(solutions) {
            for (&dof, &x) in order.iter().zip(x) {
                column[dof as usize] = x;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::testing::{self, dense_of, grid, noise};
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
            assert!(symbolic.factor_nonzeros() >= fixed.iter().filter(|f| !**f).count());
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
