//! Eigenvalues of an operator without symmetry, the largest in size, by the method of Arnoldi.

use super::dense::{Complex, general};
use super::vectors::{axpy, noise};
use crate::math::vector::dot_in_fours as dot;

/// What an operator makes of vectors.
type Apply<'a> = dyn FnMut(&[Vec<f64>]) -> Vec<Vec<f64>> + 'a;

/// An operator, and how long its vectors are.
pub struct Krylov<'a> {
    /// Entries of a vector.
    pub size: usize,
    /// Dimension beyond which there is nothing more.
    pub rank: usize,
    /// The operator, for several vectors at once.
    pub apply: &'a mut Apply<'a>,
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

/// Vectors of a block: eigenvalues that come as often as that are all found, of equal bodies and of what is symmetric.
const BLOCK_VECTORS: usize = 4;

/// Blocks between two looks at what has converged.
const BLOCKS_A_LOOK: usize = 4;

/// Eigenvalues of largest size, until `enough` says so of their values and residuals, largest first, or the space has `most` dimensions. Of a complex pair the one with
/// a positive imaginary part is returned.
///
/// By blocks, as from a single start the method sees of an eigenvalue that comes several times one vector alone. Full orthogonalisation, twice, and no restart: of some
/// hundred vectors the dense problem is cheap beside the solutions with a factor.
pub fn arnoldi(
    krylov: &mut Krylov,
    most: usize,
    enough: &dyn Fn(&[Found]) -> bool,
) -> Vec<Nearest> {
    let mut seed = 0xa5eed;
    let mut start = || (0..krylov.size).map(|_| noise(&mut seed)).collect();
    let start: Vec<Vec<f64>> = (0..BLOCK_VECTORS).map(|_| start()).collect();
    // What the operator never reaches must not be in the start.
    let start = (krylov.apply)(&start);
    let start = (krylov.apply)(&start);
    let most = most.min(krylov.rank);
    let mut q: Vec<Vec<f64>> = Vec::new();
    let mut h: Vec<Vec<f64>> = Vec::new();
    extend(&mut q, start);
    let mut blocks = 0;
    while q.len() > h.len() {
        let images = (krylov.apply)(&q[h.len()..]);
        let known = q.len();
        h.extend(extend(&mut q, images));
        blocks += 1;
        let done = q.len() == known || known >= most;
        if done || blocks % BLOCKS_A_LOOK == 0 {
            let ritz = ritz(&h, q.len());
            let values: Vec<Found> = ritz.iter().map(|r| (r.0, r.1)).collect();
            if done || enough(&values) {
                return ritz.into_iter().map(|r| expand(r, &q)).collect();
            }
        }
    }
    Vec::new()
}

/// Adds what is new in vectors to an orthonormal basis; returns the parts of each along the basis.
fn extend(q: &mut Vec<Vec<f64>>, vectors: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    let mut columns = Vec::new();
    for mut w in vectors {
        let size = dot(&w, &w).sqrt();
        let mut column = vec![0.0; q.len()];
        for _ in 0..2 {
            let parts: Vec<f64> = q.iter().map(|q| dot(q, &w)).collect();
            for ((part, c), q) in parts.iter().zip(&mut column).zip(q.iter()) {
                *c += part;
                axpy(-part, q, &mut w);
            }
        }
        let left = dot(&w, &w).sqrt();
        // Part of a vector that has to be left after orthogonalisation to count as a new direction.
        if left.is_finite() && left > 1e-13 * size && left > f64::MIN_POSITIVE {
            column.push(left);
            w.iter_mut().for_each(|v| *v /= left);
            q.push(w);
        }
        columns.push(column);
    }
    columns
}

/// Value, relative residual and vector in the basis.
type Ritz = (Complex, f64, Vec<Complex>);

/// Ritz values, largest first, one of each complex pair, of a basis of `all` vectors of which the images of the first are known.
fn ritz(h: &[Vec<f64>], all: usize) -> Vec<Ritz> {
    let n = h.len();
    let entry = |i: usize, j: usize| h[j].get(i).copied().unwrap_or(0.0);
    let dense: Vec<f64> = (0..n * n).map(|k| entry(k / n, k % n)).collect();
    let Some((values, vectors)) = general(n, &dense) else {
        return Vec::new();
    };
    let size = |z: &Complex| z[0].hypot(z[1]);
    // The images of the last vectors alone leave what is known.
    let left = |s: &[Complex], i: usize, k: usize| -> f64 {
        let last = n.saturating_sub(2 * BLOCK_VECTORS)..n;
        last.map(|j| entry(i, j) * s[j][k]).sum()
    };
    let pairs = values.into_iter().zip(vectors);
    let upper = pairs.filter(|(z, _)| z[1] >= 0.0);
    let mut all: Vec<Ritz> = upper
        .map(|(z, s)| {
            let length: f64 = s.iter().map(size).map(|s| s * s).sum();
            let parts = (n..all).map(|i| size(&[left(&s, i, 0), left(&s, i, 1)]));
            let rest: f64 = parts.map(|p| p * p).sum();
            let residual = (rest / length).sqrt() / size(&z).max(f64::MIN_POSITIVE);
            (z, residual, s)
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
        let mut apply = |x: &[Vec<f64>]| x.iter().map(|x| times(x)).collect();
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
        let one = |x: &Vec<f64>| vec![2.0 * x[0], 0.0, 0.0];
        let mut apply = |x: &[Vec<f64>]| x.iter().map(one).collect();
        let mut krylov = Krylov {
            size: 3,
            rank: 3,
            apply: &mut apply,
        };
        let all = arnoldi(&mut krylov, 3, &|_| false);
        assert_eq!(all.len(), 1);
        assert_eq!(all[0].value, [2.0, 0.0]);
    }

    #[test]
    fn eigenvalues_that_come_several_times_are_found_as_often() {
        // Three equal pairs of turning planes, and others that are smaller.
        let n = 40;
        let one = |x: &Vec<f64>| -> Vec<f64> {
            let planes = (0..n / 2).flat_map(|k| {
                let (a, b) = if k < 3 {
                    (1.0, 2.0)
                } else {
                    (0.1, 1.0 / k as f64)
                };
                let (x, y) = (x[2 * k], x[2 * k + 1]);
                [a * x - b * y, b * x + a * y]
            });
            planes.collect()
        };
        let mut apply = |x: &[Vec<f64>]| x.iter().map(one).collect();
        let mut krylov = Krylov {
            size: n,
            rank: n,
            apply: &mut apply,
        };
        let good = |values: &[Found]| values.iter().take(5).all(|v| v.1 < 1e-10);
        let all = arnoldi(&mut krylov, n, &good);
        for (k, found) in all.iter().take(5).enumerate() {
            let exact = [
                [1.0, 2.0],
                [1.0, 2.0],
                [1.0, 2.0],
                [0.1, 1.0 / 3.0],
                [0.1, 0.25],
            ][k];
            let [a, b] = [0, 1].map(|i| found.value[i] - exact[i]);
            assert!(a.hypot(b) < 1e-9, "{:?}", found.value);
        }
    }
}
