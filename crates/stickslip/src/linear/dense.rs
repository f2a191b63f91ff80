/// An LU factorisation with row exchanges of a small dense matrix (up to about fifty rows).
#[derive(Debug, Clone)]
pub struct DenseLu {
    n: usize,
    /// `U` on and above the diagonal, `L` without its unit diagonal below it, row by row.
    lu: Vec<f64>,
    /// The row that stands at each place.
    rows: Vec<usize>,
}

impl DenseLu {
    /// Factors a matrix of shape `(n, n)`, row by row. `None` if it is singular (a pivot below `n` roundings of the
    /// largest entry of its row) or not finite.
    ///
    /// # Panics
    /// If `matrix` has not `n²` entries.
    pub fn new(n: usize, matrix: &[f64]) -> Option<DenseLu> {
        assert_eq!(matrix.len(), n * n, "size of a dense matrix");
        if matrix.iter().any(|v| !v.is_finite()) {
            return None;
        }
        let mut lu = matrix.to_vec();
        let mut rows: Vec<usize> = (0..n).collect();
        // Rows are compared by what is left of them, whatever their units.
        let mut sizes: Vec<f64> = (0..n)
            .map(|i| {
                lu[i * n..(i + 1) * n]
                    .iter()
                    .fold(0.0, |m, v| f64::max(m, v.abs()))
            })
            .collect();
        for k in 0..n {
            let relative = |i: usize| lu[i * n + k].abs() / sizes[i];
            let mut best = k;
            for i in k + 1..n {
                // The first of equals, also past a zero row, whose relative size is NaN.
                if relative(i) > relative(best) || relative(best).is_nan() {
                    best = i;
                }
            }
            let size = relative(best);
            if size.is_nan() || size <= n as f64 * f64::EPSILON {
                return None;
            }
            if best != k {
                rows.swap(k, best);
                sizes.swap(k, best);
                for j in 0..n {
                    lu.swap(k * n + j, best * n + j);
                }
            }
            let (upper, below) = lu.split_at_mut((k + 1) * n);
            let pivot = &upper[k * n..];
            for row in below.chunks_exact_mut(n) {
                let factor = row[k] / pivot[k];
                row[k] = factor;
                for (r, p) in row[k + 1..].iter_mut().zip(&pivot[k + 1..]) {
                    *r -= factor * p;
                }
            }
        }
        Some(DenseLu { n, lu, rows })
    }

    /// Solves `A x = rhs` in place.
    ///
    /// # Panics
    /// If `rhs` has not `n` entries.
    pub fn solve(&self, rhs: &mut [f64]) {
        let n = self.n;
        assert_eq!(rhs.len(), n, "length of the right-hand side");
        let mut x: Vec<f64> = self.rows.iter().map(|&row| rhs[row]).collect();
        for i in 0..n {
            let row = &self.lu[i * n..i * n + i];
            x[i] -= row.iter().zip(&x).map(|(l, x)| l * x).sum::<f64>();
        }
        for i in (0..n).rev() {
            let row = &self.lu[i * n..(i + 1) * n];
            let sum: f64 = (i + 1..n).map(|j| row[j] * x[j]).sum();
            x[i] = (x[i] - sum) / row[i];
        }
        rhs.copy_from_slice(&x);
    }

    /// The inverse, of shape `(n, n)`, row by row.
    pub fn inverse(&self) -> Vec<f64> {
        let n = self.n;
        let mut inverse = vec![0.0; n * n];
        let mut column = vec![0.0; n];
        for j in 0..n {
            column.fill(0.0);
            column[j] = 1.0;
            self.solve(&mut column);
            for i in 0..n {
                inverse[i * n + j] = column[i];
            }
        }
        inverse
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::noise;
    use super::DenseLu;

    #[test]
    fn inverse_and_solution_reproduce_the_matrix() {
        for n in [1, 2, 5, 24] {
            let mut a = noise(&mut (n as u64), n * n);
            a[0] = if n > 1 { 0.0 } else { 2.0 };
            // Rows of different units.
            for v in &mut a[(n - 1) * n..] {
                *v *= 1e-12;
            }
            let lu = DenseLu::new(n, &a).unwrap();
            let inverse = lu.inverse();
            let expected = noise(&mut 99, n);
            let mut x: Vec<f64> = (0..n)
                .map(|i| (0..n).map(|j| a[i * n + j] * expected[j]).sum())
                .collect();
            lu.solve(&mut x);
            for i in 0..n {
                assert!((x[i] - expected[i]).abs() < 1e-11, "{n}: {x:?}");
                for j in 0..n {
                    let unit: f64 = (0..n).map(|k| a[i * n + k] * inverse[k * n + j]).sum();
                    let wanted = if i == j { 1.0 } else { 0.0 };
                    // The inverse carries the inverse units of the rows.
                    let size = |row: usize| if row == n - 1 { 1e-12 } else { 1.0 };
                    assert!((unit - wanted).abs() * size(j) < 1e-11 * size(i));
                }
            }
        }
    }

    #[test]
    fn singular_and_not_finite_matrices_are_refused() {
        let third = 1.0 / 3.0;
        assert!(DenseLu::new(2, &[1.0, third, 3.0, 3.0 * third]).is_none());
        assert!(DenseLu::new(2, &[0.0, 0.0, 1.0, 1.0]).is_none());
        assert!(DenseLu::new(2, &[1.0, 0.0, 1.0, f64::NAN]).is_none());
        assert!(DenseLu::new(2, &[1.0, 1.0, 0.0, 0.0]).is_none());
        assert!(DenseLu::new(0, &[]).is_some());
    }
}
