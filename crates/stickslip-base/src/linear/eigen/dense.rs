//! Dense eigenvalues and systems, by faer.

use faer::linalg::matmul::matmul;
use faer::linalg::solvers::{PartialPivLu, Solve};
use faer::{Accum, Mat, Par, Side, c64};

/// Entries of long vectors that are multiplied at once, so that they stay in the cache.
const ENTRIES_AT_ONCE: usize = 512;

/// Real and imaginary part.
pub type Complex = [f64; 2];

/// Eigenvalues, ascending, and vectors, one after the other, of a symmetric matrix given row by row; `None` where it is not finite.
///
/// # Panics
/// If `a` has not `n²` entries.
pub fn symmetric(n: usize, a: &[f64]) -> Option<(Vec<f64>, Vec<Vec<f64>>)> {
    assert_eq!(a.len(), n * n, "entries of a square matrix");
    if n == 0 {
        return Some((Vec::new(), Vec::new()));
    }
    if !a.iter().all(|x| x.is_finite()) {
        return None;
    }
    let matrix = Mat::from_fn(n, n, |i, j| 0.5 * (a[i * n + j] + a[j * n + i]));
    let both = matrix.self_adjoint_eigen(Side::Lower).ok()?;
    let values = (0..n).map(|k| both.S()[k]).collect();
    let vectors = (0..n).map(|k| (0..n).map(|i| both.U()[(i, k)]).collect());
    Some((values, vectors.collect()))
}

/// Eigenvalues and vectors of a matrix without symmetry, given row by row; `None` where it is not finite.
///
/// # Panics
/// If `a` has not `n²` entries.
pub fn general(n: usize, a: &[f64]) -> Option<(Vec<Complex>, Vec<Vec<Complex>>)> {
    assert_eq!(a.len(), n * n, "entries of a square matrix");
    if n == 0 {
        return Some((Vec::new(), Vec::new()));
    }
    if !a.iter().all(|x| x.is_finite()) {
        return None;
    }
    let both = Mat::from_fn(n, n, |i, j| a[i * n + j]).eigen().ok()?;
    let (values, vectors) = (both.S(), both.U());
    let values = (0..n).map(|k| [values[k].re, values[k].im]).collect();
    let column = |k: usize| (0..n).map(move |i| vectors[(i, k)]);
    let vectors = (0..n).map(|k| column(k).map(|z| [z.re, z.im]).collect());
    Some((values, vectors.collect()))
}

/// Eigenvalues alone of a matrix without symmetry, given row by row; `None` where it is not finite.
///
/// # Panics
/// If `a` has not `n²` entries.
pub fn eigenvalues(n: usize, a: &[f64]) -> Option<Vec<Complex>> {
    assert_eq!(a.len(), n * n, "entries of a square matrix");
    if n == 0 {
        return Some(Vec::new());
    }
    if !a.iter().all(|x| x.is_finite()) {
        return None;
    }
    let values = Mat::from_fn(n, n, |i, j| a[i * n + j]).eigenvalues().ok()?;
    Some(values.iter().map(|z| [z.re, z.im]).collect())
}

/// Eigenvalues of `A x = λ B x` with complex matrices, given row by row; `None` where `B` is singular or something is not finite.
///
/// # Panics
/// If one of them has not `n²` entries.
pub fn pencil(n: usize, a: &[Complex], b: &[Complex]) -> Option<Vec<Complex>> {
    assert_eq!([a.len(), b.len()], [n * n; 2], "entries of square matrices");
    if n == 0 {
        return Some(Vec::new());
    }
    let matrix = |of: &[Complex]| {
        Mat::from_fn(n, n, |i, j| {
            let [re, im] = of[i * n + j];
            c64::new(re, im)
        })
    };
    let quotient = matrix(b).partial_piv_lu().solve(matrix(a));
    let finite = |i: usize| {
        (0..n).all(|j| quotient[(i, j)].re.is_finite() && quotient[(i, j)].im.is_finite())
    };
    if !(0..n).all(finite) {
        return None;
    }
    let values = quotient.eigenvalues().ok()?;
    Some(values.iter().map(|z| [z.re, z.im]).collect())
}

/// These entries of several vectors as a matrix, a column for each.
fn part(vectors: &[Vec<f64>], rows: std::ops::Range<usize>) -> Mat<f64> {
    let entry = |i: usize, j: usize| vectors[j][rows.start + i];
    Mat::from_fn(rows.len(), vectors.len(), entry)
}

/// Parts of the length `n`.
fn parts(n: usize) -> impl Iterator<Item = std::ops::Range<usize>> {
    (0..n)
        .step_by(ENTRIES_AT_ONCE)
        .map(move |k| k..n.min(k + ENTRIES_AT_ONCE))
}

/// The scalar products of long vectors with others, `XᵀY` row by row.
///
/// # Panics
/// If they are not all of one length.
pub fn products(x: &[Vec<f64>], y: &[Vec<f64>]) -> Vec<f64> {
    let length = x.first().map_or(0, Vec::len);
    let mut all = Mat::zeros(x.len(), y.len());
    for rows in parts(length) {
        let [x, y] = [x, y].map(|of| part(of, rows.clone()));
        matmul(
            all.as_mut(),
            Accum::Add,
            x.transpose(),
            y.as_ref(),
            1.0,
            Par::Seq,
        );
    }
    let entries = (0..x.len() * y.len()).map(|k| all[(k / y.len(), k % y.len())]);
    entries.collect()
}

/// Sums of long vectors, `X F` with so many columns of factors `F`, row by row.
///
/// # Panics
/// If vectors are not all of one length, or factors are missing.
pub fn sums(x: &[Vec<f64>], factors: &[f64], columns: usize) -> Vec<Vec<f64>> {
    let length = x.first().map_or(0, Vec::len);
    let factors = Mat::from_fn(x.len(), columns, |i, j| factors[i * columns + j]);
    let mut out = vec![Vec::with_capacity(length); columns];
    for rows in parts(length) {
        let x = part(x, rows.clone());
        let mut all = Mat::zeros(rows.len(), columns);
        matmul(
            all.as_mut(),
            Accum::Replace,
            x.as_ref(),
            factors.as_ref(),
            1.0,
            Par::Seq,
        );
        for (j, out) in out.iter_mut().enumerate() {
            out.extend((0..rows.len()).map(|i| all[(i, j)]));
        }
    }
    out
}

/// A dense LU factor with row exchanges.
pub struct DenseLu {
    n: usize,
    lu: Option<PartialPivLu<f64>>,
}

impl DenseLu {
    /// Of a matrix given row by row.
    ///
    /// # Panics
    /// If `a` has not `n²` entries.
    pub fn new(n: usize, a: &[f64]) -> Self {
        assert_eq!(a.len(), n * n, "entries of a square matrix");
        let lu = (n > 0).then(|| Mat::from_fn(n, n, |i, j| a[i * n + j]).partial_piv_lu());
        DenseLu { n, lu }
    }

    /// Solves in place for right-hand sides one after the other; what is singular gives numbers that are not finite.
    ///
    /// # Panics
    /// If there is a part of a right-hand side.
    pub fn solve(&self, b: &mut [f64]) {
        let n = self.n;
        if let Some(lu) = &self.lu {
            assert_eq!(b.len() % n, 0, "length of right-hand sides");
            let x = lu.solve(Mat::from_fn(n, b.len() / n, |i, j| b[j * n + i]));
            let each = b.iter_mut().enumerate();
            each.for_each(|(k, b)| *b = x[(k % n, k / n)]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_of_a_pencil_are_roots_of_its_characteristic_equation() {
        // λ² - (2 + i) λ + (1 + i) = (λ - 1)(λ - 1 - i), times i on both sides.
        let a = [[0.0, 0.0], [1.0, 0.0], [1.0, -1.0], [-1.0, 2.0]];
        let b = [[1.0, 0.0], [0.0, 0.0], [0.0, 0.0], [0.0, 1.0]];
        let mut values = pencil(2, &a, &b).unwrap();
        values.sort_by(|a, b| a[1].total_cmp(&b[1]));
        for (z, exact) in values.iter().zip([[1.0, 0.0], [1.0, 1.0]]) {
            assert!(
                (z[0] - exact[0]).hypot(z[1] - exact[1]) < 1e-14,
                "{values:?}"
            );
        }
        assert_eq!(pencil(1, &[[1.0, 0.0]], &[[0.0, 0.0]]), None);
    }

    #[test]
    fn vectors_belong_to_their_values() {
        let n = 12;
        let mut seed = 3;
        let a: Vec<f64> = (0..n * n)
            .map(|_| super::super::vectors::noise(&mut seed))
            .collect();
        let (values, vectors) = general(n, &a).unwrap();
        for (l, x) in values.iter().zip(&vectors) {
            for i in 0..n {
                let mut off = [0.0; 2];
                for j in 0..n {
                    off[0] += a[i * n + j] * x[j][0];
                    off[1] += a[i * n + j] * x[j][1];
                }
                off[0] -= l[0] * x[i][0] - l[1] * x[i][1];
                off[1] -= l[0] * x[i][1] + l[1] * x[i][0];
                assert!(off[0].hypot(off[1]) < 1e-12, "{off:?}");
            }
        }
        assert!(general(1, &[f64::NAN]).is_none());
    }

    #[test]
    fn long_vectors_are_multiplied_as_one_by_one() {
        let n = 2 * super::ENTRIES_AT_ONCE + 3;
        let mut seed = 11;
        let mut some = |count: usize| -> Vec<Vec<f64>> {
            let mut one = |_| {
                (0..n)
                    .map(|_| super::super::vectors::noise(&mut seed))
                    .collect()
            };
            (0..count).map(&mut one).collect()
        };
        let (x, y) = (some(3), some(2));
        let all = products(&x, &y);
        for (k, found) in all.iter().enumerate() {
            let one: f64 = x[k / 2].iter().zip(&y[k % 2]).map(|(x, y)| x * y).sum();
            assert!((found - one).abs() < 1e-12 * n as f64, "{found} {one}");
        }
        let sums = sums(&x, &all, 2);
        for (j, sum) in sums.iter().enumerate() {
            for i in 0..n {
                let one: f64 = (0..3).map(|k| x[k][i] * all[2 * k + j]).sum();
                assert!((sum[i] - one).abs() < 1e-12, "{} {one}", sum[i]);
            }
        }
        assert!(products(&x, &[]).is_empty() && products(&[], &y).is_empty());
    }

    #[test]
    fn a_dense_system_is_solved() {
        let lu = DenseLu::new(2, &[0.0, 2.0, 4.0, 1.0]);
        let mut b = [2.0, 9.0];
        lu.solve(&mut b);
        assert_eq!(b, [2.0, 1.0]);
        DenseLu::new(0, &[]).solve(&mut []);
    }
}
