//! Eigenvalues of an operator without symmetry, the largest in size, by the method of Arnoldi.

use super::dense::{Complex, general};
use super::vectors::{axpy, noise};
use crate::math::vector::dot_in_fours as dot;

/// An operator, and how long its vectors are.
pub struct Krylov<'a> {
    /// Entries of a vector.
    pub size: usize,
    /// Dimension beyond which there is nothing more.
    pub rank: usize,
    /// The operator.
    pub apply: &'a mut dyn FnMut(&[f64]) -> Vec<f64>,
}

/// An eigenvalue of largest size and its vector, real and imaginary parts.
#[derive(Debug, Clone, PartialEq)]
pub struct Nearest {
    /// The eigenvalue of the operator.
    pub value: Complex,
    /// Estimate of the residual, relative to the eigenvalue.
    pub residual: f64,
    /// The vector, real and imaginary part.
    pub vector: [Vec<f64>; 2],
}

/// An eigenvalue and its relative residual.
pub type Found = (Complex, f64);

/// Steps between two looks at what has converged.
const LOOK: usize = 10;

/// Eigenvalues of largest size, until `enough` says so of their values and residuals, largest first, or the space has `most` dimensions. Of a complex pair the one with
/// a positive imaginary part is returned.
///
/// Full orthogonalisation, twice, and no restart: of some hundred vectors the dense problem is cheap beside the solutions with a factor.
pub fn arnoldi(
    krylov: &mut Krylov,
    most: usize,
    enough: &dyn Fn(&[Found]) -> bool,
) -> Vec<Nearest> {
    let mut seed = 0xa5eed;
    let start: Vec<f64> = (0..krylov.size).map(|_| noise(&mut seed)).collect();
    // What the operator never reaches must not be in the start.
    let start = (krylov.apply)(&start);
    let start = (krylov.apply)(&start);
    let most = most.min(krylov.rank);
    let mut q: Vec<Vec<f64>> = Vec::new();
    let mut h: Vec<Vec<f64>> = Vec::new();
    let Some(first) = normalised(start, 0.0).0 else {
        return Vec::new();
    };
    q.push(first);
    loop {
        let mut w = (krylov.apply)(&q[q.len() - 1]);
        let size = dot(&w, &w).sqrt();
        let mut column = vec![0.0; q.len()];
        for _ in 0..2 {
            let parts: Vec<f64> = q.iter().map(|q| dot(q, &w)).collect();
            for ((part, c), q) in parts.iter().zip(&mut column).zip(&q) {
                *c += part;
                axpy(-part, q, &mut w);
            }
        }
        let (next, left) = normalised(w, size);
        column.push(left);
        h.push(column);
        let done = next.is_none() || h.len() >= most;
        if done || h.len().is_multiple_of(LOOK) {
            let left = if next.is_none() { 0.0 } else { left };
            let ritz = ritz(&h, left);
            let values: Vec<(Complex, f64)> = ritz.iter().map(|r| (r.0, r.1)).collect();
            if done || enough(&values) {
                return ritz.into_iter().map(|r| expand(r, &q)).collect();
            }
        }
        match next {
            Some(next) => q.push(next),
            None => unreachable!("an exhausted space is done"),
        }
    }
}

/// A vector of length one, `None` if next to nothing is left of one that was of this size; and its length.
fn normalised(mut w: Vec<f64>, size: f64) -> (Option<Vec<f64>>, f64) {
    let norm = dot(&w, &w).sqrt();
    if !norm.is_finite() || norm <= 1e-13 * size || norm <= f64::MIN_POSITIVE {
        return (None, 0.0);
    }
    w.iter_mut().for_each(|v| *v /= norm);
    (Some(w), norm)
}

/// Value, relative residual and vector in the basis.
type Ritz = (Complex, f64, Vec<Complex>);

/// Ritz values, largest first, one of each complex pair.
fn ritz(h: &[Vec<f64>], left: f64) -> Vec<Ritz> {
    let n = h.len();
    let mut dense = vec![0.0; n * n];
    for (j, column) in h.iter().enumerate() {
        for (i, v) in column.iter().enumerate().take(n) {
            dense[i * n + j] = *v;
        }
    }
    let Some((values, vectors)) = general(n, &dense) else {
        return Vec::new();
    };
    let size = |z: &Complex| z[0].hypot(z[1]);
    let pairs = values.into_iter().zip(vectors);
    let upper = pairs.filter(|(z, _)| z[1] >= 0.0);
    let mut all: Vec<Ritz> = upper
        .map(|(z, s)| {
            let length = s.iter().map(|s| s[0] * s[0] + s[1] * s[1]).sum::<f64>();
            let last = s.last().map_or(0.0, size) / length.sqrt();
            (z, left * last / size(&z).max(f64::MIN_POSITIVE), s)
        })
        .collect();
    all.sort_by(|a, b| size(&b.0).total_cmp(&size(&a.0)));
    all
}

fn expand((value, residual, s): Ritz, q: &[Vec<f64>]) -> Nearest {
    let part = |k: usize| {
        let mut out = vec![0.0; q[0].len()];
        for (s, q) in s.iter().zip(q) {
            axpy(s[k], q, &mut out);
        }
        out
    };
    Nearest {
        value,
        residual,
        vector: [part(0), part(1)],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_eigenvalues_are_found() {
        let n = 60;
        let mut seed = 9;
        let a: Vec<f64> = (0..n * n)
            .map(|k| {
                noise(&mut seed)
                    + if k / n == k % n {
                        40.0 / (1 + k / n) as f64
                    } else {
                        0.0
                    }
            })
            .collect();
        let times = |x: &[f64]| -> Vec<f64> { a.chunks(n).map(|row| dot(row, x)).collect() };
        let good = |values: &[(Complex, f64)]| values[..6].iter().all(|v| v.1 < 1e-10);
        let mut apply = |x: &[f64]| times(x);
        let mut krylov = Krylov {
            size: n,
            rank: n,
            apply: &mut apply,
        };
        let ours = arnoldi(&mut krylov, n, &good);
        let mut dense = general(n, &a).unwrap().0;
        dense.retain(|z| z[1] >= 0.0);
        dense.sort_by(|a, b| b[0].hypot(b[1]).total_cmp(&a[0].hypot(a[1])));
        for (ours, dense) in ours[..6].iter().zip(&dense) {
            let [a, b] = ours.value;
            assert!(
                (a - dense[0]).hypot(b - dense[1]) < 1e-9,
                "{:?} {dense:?}",
                ours.value
            );
            let [x, y] = &ours.vector;
            for (i, (ax, ay)) in times(x).iter().zip(times(y)).enumerate() {
                assert!((ax - a * x[i] + b * y[i]).abs() < 1e-8);
                assert!((ay - a * y[i] - b * x[i]).abs() < 1e-8);
            }
        }
    }

    #[test]
    fn an_exhausted_space_ends() {
        let mut apply = |x: &[f64]| vec![2.0 * x[0], 0.0, 0.0];
        let mut krylov = Krylov {
            size: 3,
            rank: 3,
            apply: &mut apply,
        };
        let all = arnoldi(&mut krylov, 3, &|_| false);
        assert_eq!(all.len(), 1);
        assert_eq!(all[0].value, [2.0, 0.0]);
    }
}
