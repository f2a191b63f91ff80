use rayon::prelude::*;

use crate::math::vector::{ENTRIES_PER_TASK, par_dot as dot, par_norm as norm};

/// When [`gmres`] stops.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GmresSettings {
    /// Residual to reach, relative to the right-hand side \[1\].
    pub tolerance: f64,
    /// Products with the matrix before the basis is dropped; two vectors a step are kept.
    pub restart: usize,
    /// Products with the matrix in all, without those of the residual checks.
    pub max_iterations: usize,
}

impl Default for GmresSettings {
    fn default() -> Self {
        GmresSettings {
            tolerance: 1e-10,
            restart: 60,
            max_iterations: 300,
        }
    }
}

/// Part of the tolerance that all errors of inexact products may take together. The iteration has the rest: what it has to gain more is less than
/// a step of it gains.
const INEXACT_PRODUCTS: f64 = 0.1;

/// `product(v, out, error)` makes `out = A v` with an error that is not above `error` times the product.
pub type Product<'a> = dyn FnMut(&[f64], &mut [f64], f64) + 'a;

/// How [`gmres`] ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GmresReport {
    /// Products with the matrix, without those of the residual checks.
    pub iterations: usize,
    /// `‖b - A x‖ / ‖b‖`, computed from the solution and not from the recurrence \[1\].
    pub relative_residual: f64,
    /// Whether the residual is below the tolerance.
    pub converged: bool,
}

/// Solves `A x = b` for a matrix known by its product, by flexible restarted GMRES, preconditioned from the right.
///
/// `apply(v, out)` computes `out = A v`; `precondition(v)` replaces `v` by an approximation of `A⁻¹ v`. `x` holds the
/// first guess and receives the solution: the best one found if the tolerance is not reached, and the guess if
/// anything in the way is not a finite number. Dofs left out of the system are to be zero in `b`, in the guess and
/// after both closures. The result does not depend on the number of threads if those of the closures do not.
///
/// See [Saad and Schultz 1986](crate::references::saad_schultz_1986), and [Saad 1993](crate::references::saad_1993) for
/// the flexible form, which allows a different preconditioner at every step.
///
/// # Panics
/// If `b` and `x` differ in length.
pub fn gmres(
    apply: &mut dyn FnMut(&[f64], &mut [f64]),
    precondition: &mut dyn FnMut(&mut [f64]),
    b: &[f64],
    x: &mut [f64],
    settings: GmresSettings,
) -> GmresReport {
    gmres_inexact(&mut |v, out, _| apply(v, out), precondition, b, x, settings)
}

/// [`gmres`] with products that may be inexact: `apply(v, out, error)` makes `out = A v` with an error that is not above `error` times the product.
///
/// A product may be the coarser the smaller the residual already is: errors `ηᵢ` move the solution by `Σ ηᵢ yᵢ`, and the part `yᵢ` of a later direction is
/// as small as the residual that it is to take away ([Simoncini and Szyld 2003](crate::references::simoncini_szyld_2003), section 5). Errors that are as large as they
/// may be and all of one direction would take more than a tenth of the tolerance; the residual checks, of a tenth each, would see it.
///
/// # Panics
/// If `b` and `x` differ in length.
pub fn gmres_inexact(
    apply: &mut Product,
    precondition: &mut dyn FnMut(&mut [f64]),
    b: &[f64],
    x: &mut [f64],
    settings: GmresSettings,
) -> GmresReport {
    let n = b.len();
    let exact = INEXACT_PRODUCTS * settings.tolerance;
    assert_eq!(x.len(), n, "length of the guess");
    let b_norm = norm(b);
    let mut report = GmresReport {
        iterations: 0,
        relative_residual: 0.0,
        converged: true,
    };
    if b_norm == 0.0 {
        x.fill(0.0);
        return report;
    }
    let mut residual = vec![0.0; n];
    let mut size = b_norm;
    if x.iter().all(|x| *x == 0.0) {
        residual.copy_from_slice(b);
    } else {
        size = residual_into(apply, exact, b, x, &mut residual);
    }
    loop {
        report.relative_residual = size / b_norm;
        report.converged = report.relative_residual <= settings.tolerance;
        let left = settings.max_iterations - report.iterations;
        if report.converged || left == 0 || !report.relative_residual.is_finite() {
            return report;
        }
        let steps = settings.restart.max(1).min(left);
        let target = settings.tolerance * b_norm;
        let (update, taken) = cycle(apply, precondition, &residual, size, target, steps);
        report.iterations += taken;
        let trial: Vec<f64> = x.iter().zip(&update).map(|(x, d)| x + d).collect();
        let trial_size = residual_into(apply, exact, b, &trial, &mut residual);
        // A cycle that gains nothing will not gain more next time: rounding or a singular matrix.
        // `is_nan` apart, since a NaN compares false.
        if trial_size.is_nan() || trial_size >= size {
            return report;
        }
        let stalled = trial_size > 0.99 * size;
        x.copy_from_slice(&trial);
        size = trial_size;
        if stalled {
            report.relative_residual = size / b_norm;
            report.converged = report.relative_residual <= settings.tolerance;
            return report;
        }
    }
}

/// One cycle from a residual `r` of length `size`: the update of the solution and the steps taken.
fn cycle(
    apply: &mut Product,
    precondition: &mut dyn FnMut(&mut [f64]),
    r: &[f64],
    size: f64,
    target: f64,
    steps: usize,
) -> (Vec<f64>, usize) {
    let n = r.len();
    let mut basis: Vec<Vec<f64>> = vec![r.iter().map(|v| v / size).collect()];
    let mut directions: Vec<Vec<f64>> = Vec::new();
    // Columns of the triangle that rotations make of the Hessenberg matrix, and the rotated right-hand side.
    let mut triangle: Vec<Vec<f64>> = Vec::new();
    let mut rotations: Vec<(f64, f64)> = Vec::new();
    let mut rhs = vec![size];
    let mut taken = 0;
    while taken < steps {
        let mut z = basis[taken].clone();
        precondition(&mut z);
        let mut w = vec![0.0; n];
        let left = rhs[taken].abs();
        apply(&z, &mut w, INEXACT_PRODUCTS * target / left);
        taken += 1;

        let before = norm(&w);
        let mut column = orthogonalize(&basis, &mut w, before);
        let after = norm(&w);
        if !after.is_finite() || column.iter().any(|h| !h.is_finite()) {
            break;
        }
        for (i, &(c, s)) in rotations.iter().enumerate() {
            let (a, b) = (column[i], column[i + 1]);
            column[i] = c * a + s * b;
            column[i + 1] = c * b - s * a;
        }
        let last = column.len() - 1;
        let diagonal = column[last].hypot(after);
        // Neither old nor new directions: the matrix loses this one, and it is left out.
        if diagonal <= f64::EPSILON * before || diagonal == 0.0 {
            break;
        }
        let (c, s) = (column[last] / diagonal, after / diagonal);
        column[last] = diagonal;
        rotations.push((c, s));
        triangle.push(column);
        directions.push(z);
        let top = rhs[last];
        rhs[last] = c * top;
        rhs.push(-s * top);
        // Nothing new: the solution lies in the basis.
        if (s * top).abs() <= target || after <= f64::EPSILON * before {
            break;
        }
        w.iter_mut().for_each(|v| *v /= after);
        basis.push(w);
    }

    let k = triangle.len();
    let mut y = rhs;
    for i in (0..k).rev() {
        let sum: f64 = (i + 1..k).map(|j| triangle[j][i] * y[j]).sum();
        y[i] = (y[i] - sum) / triangle[i][i];
    }
    let mut update = vec![0.0; n];
    for (y, z) in y.iter().zip(&directions) {
        add_scaled(&mut update, *y, z);
    }
    (update, taken)
}

/// Removes the basis from `w` (modified Gram-Schmidt) and returns the components, one more than needed as room for
/// the rotations. A second pass follows where the first cancelled digits: two are enough.
fn orthogonalize(basis: &[Vec<f64>], w: &mut [f64], before: f64) -> Vec<f64> {
    let mut column = vec![0.0; basis.len()];
    for pass in 0..2 {
        for (h, v) in column.iter_mut().zip(basis) {
            let component = dot(w, v);
            *h += component;
            add_scaled(w, -component, v);
        }
        if pass == 0 && norm(w) > 0.7 * before {
            break;
        }
    }
    column
}

fn residual_into(
    apply: &mut Product,
    error: f64,
    b: &[f64],
    x: &[f64],
    residual: &mut [f64],
) -> f64 {
    apply(x, residual, error);
    for (r, b) in residual.iter_mut().zip(b) {
        *r = b - *r;
    }
    norm(residual)
}

/// `a += s b`
fn add_scaled(a: &mut [f64], s: f64, b: &[f64]) {
    a.par_chunks_mut(ENTRIES_PER_TASK)
        .zip(b.par_chunks(ENTRIES_PER_TASK))
        .for_each(|(a, b)| {
            for (a, b) in a.iter_mut().zip(b) {
                *a += s * b;
            }
        });
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::super::testing::{dense_solution, grid, noise};
    use super::super::{BlockCsr, Factor, Symbolic};
    use super::*;

    fn product(n: usize, a: &[f64]) -> impl FnMut(&[f64], &mut [f64]) {
        move |x, y| {
            for (y, row) in y.iter_mut().zip(a.chunks(n)) {
                *y = row.iter().zip(x).map(|(a, x)| a * x).sum();
            }
        }
    }

    /// An unsymmetric, diagonally heavy matrix.
    fn unsymmetric(n: usize) -> Vec<f64> {
        let mut a = noise(&mut 11, n * n);
        for i in 0..n {
            a[i * n + i] += 6.0 + i as f64 / 10.0;
        }
        a
    }

    #[test]
    fn solves_unsymmetric_systems_with_and_without_restarts() {
        let n = 60;
        let a = unsymmetric(n);
        let b = noise(&mut 12, n);
        let expected = dense_solution(&a, &b);
        for restart in [60, 25] {
            let settings = GmresSettings {
                tolerance: 1e-12,
                restart,
                max_iterations: 600,
            };
            let mut x = vec![0.0; n];
            let mut diagonal = |v: &mut [f64]| (0..n).for_each(|i| v[i] /= a[i * n + i]);
            let report = gmres(&mut product(n, &a), &mut diagonal, &b, &mut x, settings);
            assert!(
                report.converged && report.relative_residual <= 1e-12,
                "{report:?}"
            );
            assert!(report.iterations <= if restart == 60 { 60 } else { 200 });
            for (x, e) in x.iter().zip(&expected) {
                assert!((x - e).abs() < 1e-10);
            }
            // From the solution nothing is left to do.
            let again = gmres(&mut product(n, &a), &mut diagonal, &b, &mut x, settings);
            assert_eq!((again.iterations, again.converged), (0, true));
        }
    }

    #[test]
    fn products_may_become_coarser_as_the_residual_falls() {
        let n = 60;
        let a = unsymmetric(n);
        let b = noise(&mut 12, n);
        let settings = GmresSettings {
            tolerance: 1e-10,
            restart: 60,
            max_iterations: 60,
        };
        let mut diagonal = |v: &mut [f64]| (0..n).for_each(|i| v[i] /= a[i * n + i]);
        let mut x = vec![0.0; n];
        let exact = gmres(&mut product(n, &a), &mut diagonal, &b, &mut x, settings);
        // Every product is as wrong as it may be, in another direction each.
        let (mut seed, mut coarsest, mut product) = (7, 0.0_f64, product(n, &a));
        let mut wrong = |v: &[f64], out: &mut [f64], error: f64| {
            product(v, out);
            let (size, noise) = (norm(out), noise(&mut seed, n));
            coarsest = coarsest.max(error);
            let share = error * size / norm(&noise);
            out.iter_mut()
                .zip(&noise)
                .for_each(|(o, d)| *o += share * d);
        };
        let mut x = vec![0.0; n];
        let settings = GmresSettings {
            max_iterations: 120,
            ..settings
        };
        let inexact = gmres_inexact(&mut wrong, &mut diagonal, &b, &mut x, settings);
        assert!(coarsest > 0.01, "{coarsest}");
        assert!(
            inexact.iterations <= exact.iterations + 2,
            "{inexact:?} {exact:?}"
        );
        let mut ax = vec![0.0; n];
        self::product(n, &a)(&x, &mut ax);
        let left: Vec<f64> = b.iter().zip(&ax).map(|(b, a)| b - a).collect();
        assert!(
            norm(&left) < 1.1e-10 * norm(&b),
            "{}",
            norm(&left) / norm(&b)
        );
    }

    #[test]
    fn the_symmetric_factor_leaves_few_iterations() {
        let a = grid([8, 7, 6], 3);
        let mut fixed = vec![false; a.rows()];
        fixed[..3 * 56].fill(true);
        let symbolic = Arc::new(Symbolic::analyze(&a, &fixed, &[]).unwrap());
        let factor = Factor::new(&symbolic, &a, &[]).unwrap();
        // Friction-like couplings of a few dofs: tangential rows driven by normal columns.
        let first = 3 * 7 * 40;
        let skewed = |a: &BlockCsr, x: &[f64], y: &mut [f64]| {
            a.mul(x, y);
            for k in 0..10 {
                y[first + 3 * k] += 0.3 * x[first + 3 * k + 2];
            }
            y.iter_mut()
                .zip(&fixed)
                .for_each(|(y, &f)| *y = if f { 0.0 } else { *y });
        };
        let mut b = noise(&mut 2, a.rows());
        b[..3 * 56].fill(0.0);
        let solve = |threads| {
            let mut x = vec![0.0; a.rows()];
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
            let report = pool.build().unwrap().install(|| {
                gmres(
                    &mut |x, y| skewed(&a, x, y),
                    &mut |v| factor.solve(v),
                    &b,
                    &mut x,
                    GmresSettings::default(),
                )
            });
            (report, x.iter().map(|v| v.to_bits()).collect::<Vec<_>>())
        };
        let (report, bits) = solve(1);
        assert!(report.converged && report.iterations <= 12, "{report:?}");
        assert_eq!((report, bits), solve(3));
    }

    #[test]
    fn reports_what_it_cannot_solve() {
        // Singular, with a right-hand side outside its range.
        let a = [1.0, 0.0, 0.0, 0.0];
        let mut x = [0.0; 2];
        let mut nothing = |_: &mut [f64]| ();
        let settings = GmresSettings::default();
        let report = gmres(
            &mut product(2, &a),
            &mut nothing,
            &[1.0, 1.0],
            &mut x,
            settings,
        );
        assert!(
            !report.converged && (x[0] - 1.0).abs() < 1e-15,
            "{report:?} {x:?}"
        );
        assert!((report.relative_residual - 0.5f64.sqrt()).abs() < 1e-15);
        // Inside its range it is solved.
        let report = gmres(
            &mut product(2, &a),
            &mut nothing,
            &[3.0, 0.0],
            &mut x,
            settings,
        );
        assert!(report.converged && x[0] == 3.0, "{report:?} {x:?}");
        // Too few iterations.
        let n = 60;
        let a = unsymmetric(n);
        let b = noise(&mut 12, n);
        let few = GmresSettings {
            max_iterations: 3,
            ..settings
        };
        let mut x = vec![0.0; n];
        let report = gmres(&mut product(n, &a), &mut nothing, &b, &mut x, few);
        assert!(!report.converged && report.iterations == 3);
        let mut ax = vec![0.0; n];
        product(n, &a)(&x, &mut ax);
        let left: Vec<f64> = b.iter().zip(&ax).map(|(b, a)| b - a).collect();
        assert!((report.relative_residual - norm(&left) / norm(&b)).abs() < 1e-14);
        assert!(report.relative_residual < 1.0);
    }

    #[test]
    fn zero_and_nan_are_no_trouble() {
        let a = [2.0, 0.0, 0.0, 2.0];
        let settings = GmresSettings::default();
        let mut x = [5.0, 5.0];
        let mut nothing = |_: &mut [f64]| ();
        let report = gmres(
            &mut product(2, &a),
            &mut nothing,
            &[0.0; 2],
            &mut x,
            settings,
        );
        assert!(report.converged && x == [0.0; 2]);
        let mut spoil = |v: &mut [f64]| v[0] = f64::NAN;
        let mut x = [0.5, 0.5];
        let report = gmres(
            &mut product(2, &a),
            &mut spoil,
            &[1.0, 3.0],
            &mut x,
            settings,
        );
        assert!(!report.converged && x == [0.5; 2] && report.relative_residual.is_finite());
        let report = gmres(
            &mut product(2, &a),
            &mut nothing,
            &[f64::NAN; 2],
            &mut x,
            settings,
        );
        assert!(!report.converged && x == [0.5; 2]);
    }
}
