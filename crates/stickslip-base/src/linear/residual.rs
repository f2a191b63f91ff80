use super::BlockCsr;

/// The relative residual `‖b - A x‖ / (‖A‖ ‖x‖ + ‖b‖)` in the maximum norm, over the dofs that are not `fixed` \[1\].
///
/// A direct solution stays near the rounding of a number (1e-16 to 1e-13); more means that the solver failed,
/// whatever it said. Not a number if any of `a`, `x` and `b` is not; zero for a zero system.
///
/// # Panics
/// If the lengths differ.
pub fn relative_residual(a: &BlockCsr, fixed: &[bool], x: &[f64], b: &[f64]) -> f64 {
    let mut ax = vec![0.0; x.len()];
    a.mul(x, &mut ax);
    backward_error(a.norm_inf(), fixed, x, b, &ax)
}

/// The same from the norm of the matrix and the product `ax`, for matrices that exist as a product only.
///
/// # Panics
/// If the lengths differ.
pub fn backward_error(norm: f64, fixed: &[bool], x: &[f64], b: &[f64], ax: &[f64]) -> f64 {
    assert!(x.len() == b.len() && x.len() == ax.len() && x.len() == fixed.len());
    // `f64::max` would lose a NaN.
    let largest = |m: f64, v: f64| {
        if v.is_nan() || v.abs() > m {
            v.abs()
        } else {
            m
        }
    };
    let (mut residual, mut x_size, mut b_size) = (0.0, 0.0, 0.0);
    for i in 0..x.len() {
        x_size = largest(x_size, x[i]);
        if !fixed[i] {
            residual = largest(residual, b[i] - ax[i]);
            b_size = largest(b_size, b[i]);
        }
    }
    let size = norm * x_size + b_size;
    if residual == 0.0 && size == 0.0 {
        0.0
    } else {
        residual / size
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{grid, noise};
    use super::{backward_error, relative_residual};

    #[test]
    fn sees_wrong_entries_and_ignores_fixed_dofs() {
        let a = grid([4, 3, 1], 2);
        let x = noise(&mut 1, a.rows());
        let mut b = vec![0.0; a.rows()];
        a.mul(&x, &mut b);
        let mut fixed = vec![false; a.rows()];
        assert_eq!(relative_residual(&a, &fixed, &x, &b), 0.0);
        let size = b.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
        b[3] += 0.5;
        let error = relative_residual(&a, &fixed, &x, &b);
        let x_size = x.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
        let expected = 0.5 / (a.norm_inf() * x_size + size.max(b[3].abs()));
        assert!((error / expected - 1.0).abs() < 1e-12);
        fixed[3] = true;
        assert_eq!(relative_residual(&a, &fixed, &x, &b), 0.0);
    }

    #[test]
    fn passes_on_what_is_not_a_number() {
        assert!(
            backward_error(1.0, &[false; 2], &[1.0, 1.0], &[f64::NAN, 1.0], &[1.0; 2]).is_nan()
        );
        assert!(
            backward_error(1.0, &[false; 2], &[1.0, 1.0], &[1.0; 2], &[1.0, f64::NAN]).is_nan()
        );
        assert_eq!(backward_error(1.0, &[false], &[0.0], &[0.0], &[0.0]), 0.0);
    }
}
