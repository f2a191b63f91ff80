//! The linear systems of Newton's method in the forces: dense, and singular where `W` is.

use faer::linalg::solvers::Solve;
use faer::{Mat, MatRef};

/// The solution of `a x = b` by elimination with row exchanges.
pub(super) fn eliminate(a: &Mat<f64>, b: &[f64]) -> Vec<f64> {
    let right = Mat::from_fn(b.len(), 1, |i, _| b[i]);
    let x = a.partial_piv_lu().solve(&right);
    (0..b.len()).map(|i| x[(i, 0)]).collect()
}

/// The shortest `x` for which `|a x - b|` is least: by a complete orthogonal factorisation, `a P = Q [T 0; 0 0] Z`
/// ([Golub and Van Loan](stickslip_base::references::golub_van_loan_2013), 5.4.7).
pub(super) fn least_squares(a: &Mat<f64>, b: &[f64]) -> Vec<f64> {
    let n = b.len();
    if n == 0 {
        return Vec::new();
    }
    let factor = a.col_piv_qr();
    let upper = factor.R();
    let largest = upper[(0, 0)].abs();
    let rank = (0..n)
        // A direction with a pivot below this part of the largest is not determined.
        .take_while(|&i| upper[(i, i)].abs() > 1e-11 * largest)
        .count();
    let right = Mat::from_fn(n, 1, |i, _| b[i]);
    let turned = factor.compute_Q().transpose() * &right;
    let head = turned.subrows(0, rank);
    let y = match rank == n {
        true => solve_upper(upper, head),
        false => shortest(upper, head, rank),
    };
    let mut x = vec![0.0; n];
    let (order, _) = factor.P().arrays();
    for (k, &to) in order.iter().enumerate() {
        x[to] = y[(k, 0)];
    }
    x
}

/// The solution of an upper triangular system.
fn solve_upper(upper: MatRef<'_, f64>, right: MatRef<'_, f64>) -> Mat<f64> {
    let mut y = right.to_owned();
    upper.solve_upper_triangular_in_place(&mut y);
    y
}

/// The shortest solution of the first `rank` rows of an upper triangle.
fn shortest(upper: MatRef<'_, f64>, head: MatRef<'_, f64>, rank: usize) -> Mat<f64> {
    let rows = Mat::from_fn(upper.ncols(), rank, |i, j| {
        if j <= i { upper[(j, i)] } else { 0.0 }
    });
    let factor = rows.qr();
    let mut middle = head.to_owned();
    factor
        .thin_R()
        .transpose()
        .solve_lower_triangular_in_place(&mut middle);
    factor.compute_thin_Q() * &middle
}
