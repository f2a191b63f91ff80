//! The lowest eigenvalues of `K x = λ M x` by the block Lanczos method.

use super::dense::symmetric;
use super::vectors::{axpy, noise};
use crate::math::vector::dot_in_fours as dot;

/// Vectors of a block: modes that come as often as that are found together.
const BLOCK_VECTORS: usize = 4;

/// Most passes, each from a start that is orthogonal to what is known.
const LANCZOS_PASSES: usize = 40;

/// `K x = λ M x` with `K` symmetric, `M` symmetric and not negative, and a factor of `K + shift M`, which is positive.
pub struct Pencil<'a> {
    /// Entries of a vector; those of fixed dofs are zero.
    pub size: usize,
    /// How many are unknown.
    pub free: usize,
    /// `y = M x`, zero in fixed dofs.
    pub mass: &'a dyn Fn(&[f64], &mut [f64]),
    /// Solves with `K + shift M` for several right-hand sides, one after the other.
    pub solve: &'a dyn Fn(&mut [f64], usize),
    /// The shift `[1/s²]`.
    pub shift: f64,
}

/// What is wanted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wanted {
    /// At most so many.
    pub count: usize,
    /// Eigenvalues up to this one.
    pub below: f64,
    /// Residual of the inverse problem relative to its eigenvalue.
    pub tolerance: f64,
}

/// The lowest modes, ascending.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct RealModes {
    /// Eigenvalues `[1/s²]`.
    pub values: Vec<f64>,
    /// Vectors with `xᵀ M x = 1`.
    pub vectors: Vec<Vec<f64>>,
    /// Right-hand sides that were solved for.
    pub solves: usize,
    /// Whether another pass, orthogonal to what was found, has found nothing more.
    pub complete: bool,
}

/// A mode of the inverse problem `(K + shift M)⁻¹ M x = θ x`, with `M x`.
struct Mode {
    theta: f64,
    x: Vec<f64>,
    mx: Vec<f64>,
}

/// An orthonormal basis, its images under the mass, and the projected operator.
#[derive(Default)]
struct Basis {
    q: Vec<Vec<f64>>,
    mq: Vec<Vec<f64>>,
    /// Column by column, above the diagonal and on it.
    t: Vec<Vec<f64>>,
}

/// The lowest eigenvalues and their vectors, those that come several times as often as they do.
///
/// The basis stays orthogonal to itself in the product of the mass to rounding, so that none is found twice. A pass ends when all that is wanted of what
/// it can see has converged; the next starts anew orthogonal to that. When one sees nothing more that belongs into the range, nothing is missing but by
/// the chance that a random start has no part of it.
pub fn lanczos(pencil: &Pencil, wanted: Wanted) -> RealModes {
    let mut found: Vec<Mode> = Vec::new();
    let mut out = RealModes::default();
    let mut seed = 0x5eed;
    let mut start: Vec<Vec<f64>> = Vec::new();
    let mut no_progress = 0;
    for _ in 0..LANCZOS_PASSES {
        while start.len() < BLOCK_VECTORS {
            let fresh: Vec<f64> = (0..pencil.size).map(|_| noise(&mut seed)).collect();
            // What the mass does not see must not be in it.
            let mut image = vec![0.0; pencil.size];
            (pencil.mass)(&fresh, &mut image);
            (pencil.solve)(&mut image, 1);
            out.solves += 1;
            start.push(image);
        }
        let edge = edge(&found, &wanted, pencil.shift);
        let before = found.len();
        let pass = pass(pencil, &wanted, &found, edge, start, &mut out.solves);
        found.extend(pass.converged);
        found.sort_by(|a, b| b.theta.total_cmp(&a.theta));
        start = pass.next;
        if pass.nothing_left && found.len() == before {
            out.complete = true;
            break;
        }
        no_progress = if found.len() == before {
            no_progress + 1
        } else {
            0
        };
        if no_progress == 6 {
            break;
        }
    }
    let limit = 1.0 / (wanted.below + pencil.shift).max(f64::MIN_POSITIVE);
    found.retain(|m| m.theta >= limit * (1.0 - 1e-9));
    found.truncate(wanted.count);
    for mode in found {
        out.values.push(1.0 / mode.theta - pencil.shift);
        out.vectors.push(purified(pencil, mode, &mut out.solves));
    }
    out
}

/// The smallest `θ` that is still wanted.
fn edge(found: &[Mode], wanted: &Wanted, shift: f64) -> f64 {
    let limit = 1.0 / (wanted.below + shift).max(f64::MIN_POSITIVE);
    match wanted.count.checked_sub(1).and_then(|i| found.get(i)) {
        Some(last) => limit.max(last.theta * (1.0 + 1e-9)),
        None => limit,
    }
}

/// The vector once more through the operator: rounding leaves parts in it that the mass does not see.
fn purified(pencil: &Pencil, mode: Mode, solves: &mut usize) -> Vec<f64> {
    let mut x = mode.mx;
    (pencil.solve)(&mut x, 1);
    *solves += 1;
    let mut mx = vec![0.0; x.len()];
    (pencil.mass)(&x, &mut mx);
    let norm = dot(&x, &mx).max(0.0).sqrt();
    let largest = x
        .iter()
        .fold(0.0_f64, |m, v| if v.abs() > m.abs() { *v } else { m });
    // The largest entry is positive: a mode has no sign of its own.
    let factor = largest.signum() / norm.max(f64::MIN_POSITIVE);
    x.iter_mut().for_each(|v| *v *= factor);
    x
}

/// What a pass has come to.
struct Pass {
    converged: Vec<Mode>,
    /// Where the next goes on, if it is to go on from here.
    next: Vec<Vec<f64>>,
    /// Nothing that is wanted is left in what it can see.
    nothing_left: bool,
}

fn pass(
    pencil: &Pencil,
    wanted: &Wanted,
    found: &[Mode],
    edge: f64,
    start: Vec<Vec<f64>>,
    solves: &mut usize,
) -> Pass {
    let missing = wanted.count.saturating_sub(found.len());
    let most = (2 * missing + 12 * BLOCK_VECTORS).max(60).min(pencil.free);
    let mut basis = Basis::default();
    let mut block = orthonormal(pencil, &basis, found, start).0;
    let room = |basis: &Basis| pencil.free.saturating_sub(found.len() + basis.q.len());
    block.truncate(room(&basis));
    if block.is_empty() {
        return Pass {
            converged: Vec::new(),
            next: Vec::new(),
            nothing_left: true,
        };
    }
    loop {
        let first = basis.q.len();
        let width = block.len();
        for (q, mq) in block {
            basis.q.push(q);
            basis.mq.push(mq);
        }
        let mut images = basis.mq[first..].concat();
        (pencil.solve)(&mut images, width);
        *solves += width;
        let images: Vec<Vec<f64>> = images
            .chunks_exact(pencil.size)
            .map(<[f64]>::to_vec)
            .collect();
        basis.project(&images, first);
        let (next, rest) = orthonormal(pencil, &basis, found, images);
        block = next;
        block.truncate(room(&basis));
        let exhausted = block.is_empty();
        let full = basis.q.len() + block.len() > most;
        let ritz = basis.ritz(&rest, exhausted);
        let good = |r: &Ritz| r.residual <= wanted.tolerance * r.theta;
        let leading = ritz.iter().take_while(|r| good(r) && r.theta > 0.0).count();
        let below = ritz
            .iter()
            .position(|r| r.residual <= 1e-2 * r.theta && r.theta + r.residual < edge);
        let nothing_left = exhausted || below.is_some_and(|k| k <= leading);
        let enough = leading >= missing.max(1);
        if nothing_left || enough || full {
            let wanted = ritz[..leading]
                .iter()
                .filter(|r| r.theta >= edge * (1.0 - 1e-9));
            let converged = wanted.map(|r| basis.mode(r)).collect();
            let go_on = full && !nothing_left && !enough;
            let ahead = ritz[leading..]
                .iter()
                .take(if go_on { BLOCK_VECTORS } else { 0 });
            return Pass {
                converged,
                next: ahead.map(|r| basis.mode(r).x).collect(),
                nothing_left,
            };
        }
    }
}

/// A Ritz value, its residual and its vector in the basis.
struct Ritz {
    theta: f64,
    residual: f64,
    s: Vec<f64>,
}

impl Basis {
    /// Adds the columns of the projected operator for the vectors from `first` on.
    fn project(&mut self, images: &[Vec<f64>], first: usize) {
        for (k, image) in images.iter().enumerate() {
            let column = self.mq[..=first + k].iter().map(|mq| dot(mq, image));
            self.t.push(column.collect());
        }
    }

    /// Ritz values, the largest first. `rest`: the part of the last images that is outside the basis, by its columns.
    fn ritz(&self, rest: &[Vec<f64>], exhausted: bool) -> Vec<Ritz> {
        let n = self.q.len();
        let mut t = vec![0.0; n * n];
        for (j, column) in self.t.iter().enumerate() {
            for (i, &v) in column.iter().enumerate() {
                t[i * n + j] = v;
                t[j * n + i] = v;
            }
        }
        let Some((values, vectors)) = symmetric(n, &t) else {
            return Vec::new();
        };
        let last = n - rest.len();
        let pairs = values.into_iter().zip(vectors).rev();
        pairs
            .map(|(theta, s)| {
                let rows = rest.first().map_or(0, Vec::len);
                let row = |r: usize| -> f64 {
                    let parts = rest.iter().zip(&s[last..]);
                    parts.map(|(column, s)| column[r] * s).sum()
                };
                let residual = (0..rows).map(|r| row(r) * row(r)).sum::<f64>().sqrt();
                Ritz {
                    theta,
                    residual: if exhausted { 0.0 } else { residual },
                    s,
                }
            })
            .collect()
    }

    /// The mode of a Ritz vector.
    fn mode(&self, ritz: &Ritz) -> Mode {
        let sum = |all: &[Vec<f64>]| {
            let mut out = vec![0.0; all[0].len()];
            for (s, q) in ritz.s.iter().zip(all) {
                axpy(*s, q, &mut out);
            }
            out
        };
        Mode {
            theta: ritz.theta,
            x: sum(&self.q),
            mx: sum(&self.mq),
        }
    }
}

/// Vectors and their images under the mass, and the columns of the triangle by which they were made.
type Orthonormal = (Vec<(Vec<f64>, Vec<f64>)>, Vec<Vec<f64>>);

/// Makes columns orthonormal in the product of the mass, to the basis and to what was found as well; columns that depend on others are left out.
fn orthonormal(
    pencil: &Pencil,
    basis: &Basis,
    found: &[Mode],
    columns: Vec<Vec<f64>>,
) -> Orthonormal {
    let mut out: Vec<(Vec<f64>, Vec<f64>)> = Vec::new();
    let mut triangle = Vec::new();
    for mut x in columns {
        let mut mx = vec![0.0; x.len()];
        (pencil.mass)(&x, &mut mx);
        let before = dot(&x, &mx).max(0.0).sqrt();
        let mut column = vec![0.0; out.len()];
        // Twice is enough (Kahan and Parlett), of a column that is left almost without anything a third time.
        for _ in 0..3 {
            for mode in found {
                axpy(-dot(&mode.mx, &x), &mode.x, &mut x);
            }
            let parts: Vec<f64> = basis.mq.iter().map(|mq| dot(mq, &x)).collect();
            for (part, q) in parts.iter().zip(&basis.q) {
                axpy(-part, q, &mut x);
            }
            for (c, (q, mq)) in column.iter_mut().zip(&out) {
                let part = dot(mq, &x);
                *c += part;
                axpy(-part, q, &mut x);
            }
        }
        (pencil.mass)(&x, &mut mx);
        let norm = dot(&x, &mx).max(0.0).sqrt();
        // Part of a column that has to be left after orthogonalisation to count as a new direction.
        if norm > 1e-10 * before && norm > f64::MIN_POSITIVE {
            x.iter_mut().for_each(|v| *v /= norm);
            mx.iter_mut().for_each(|v| *v /= norm);
            column.push(norm);
            out.push((x, mx));
        }
        triangle.push(column);
    }
    let rows = out.len();
    triangle.iter_mut().for_each(|c| c.resize(rows, 0.0));
    (out, triangle)
}

#[cfg(test)]
mod tests {
    use super::super::super::testing::{dense_of, grid};
    use super::super::super::{BlockCsr, Factor, Symbolic};
    use super::*;
    use std::sync::Arc;

    /// Lowest eigenvalues of a grid with a diagonal mass, and those of the dense matrix scaled by its roots.
    fn both(
        a: &BlockCsr,
        mass: &[f64],
        fixed: &[bool],
        wanted: Wanted,
        shift: f64,
    ) -> [Vec<f64>; 2] {
        let n = a.rows();
        let mut shifted = a.clone();
        for (i, m) in mass.iter().enumerate() {
            shifted.add_diagonal(i, shift * m);
        }
        let symbolic = Arc::new(Symbolic::analyze(&shifted, fixed, &[]).unwrap());
        let factor = Factor::new(&symbolic, &shifted, &[]).unwrap();
        let free: Vec<usize> = (0..n).filter(|&i| !fixed[i]).collect();
        let apply = |x: &[f64], y: &mut [f64]| {
            for i in 0..n {
                y[i] = if fixed[i] { 0.0 } else { mass[i] * x[i] };
            }
        };
        let pencil = Pencil {
            size: n,
            free: free.len(),
            mass: &apply,
            solve: &|b, columns| factor.solve_columns(b, columns),
            shift,
        };
        let modes = lanczos(&pencil, wanted);
        assert!(modes.complete);
        for (l, x) in modes.values.iter().zip(&modes.vectors) {
            let (mut kx, mut mx) = (vec![0.0; n], vec![0.0; n]);
            a.mul(x, &mut kx);
            apply(x, &mut mx);
            assert!((dot(x, &mx) - 1.0).abs() < 1e-12);
            let off = free.iter().map(|&i| (kx[i] - l * mx[i]).abs());
            let worst = off.fold(0.0, f64::max);
            assert!(worst < 1e-7 * (1.0 + l.abs()), "{l}: {worst:e}");
        }
        let dense = dense_of(a);
        let m = free.len();
        let scaled: Vec<f64> = (0..m * m)
            .map(|k| {
                let (i, j) = (free[k / m], free[k % m]);
                dense[i * n + j] / (mass[i] * mass[j]).sqrt()
            })
            .collect();
        let mut values = symmetric(m, &scaled).unwrap().0;
        values.retain(|l| *l <= wanted.below);
        values.truncate(wanted.count);
        [modes.values, values]
    }

    #[test]
    fn lowest_modes_are_those_of_the_dense_matrix() {
        for (counts, block, shift) in [
            ([9, 4, 1], 2, 0.0),
            ([5, 4, 3], 3, 0.0),
            ([4, 4, 4], 3, 0.5),
        ] {
            let a = grid(counts, block);
            let mass: Vec<f64> = (0..a.rows())
                .map(|i| 1.0 + (i / block % 3) as f64)
                .collect();
            let mut fixed = vec![false; a.rows()];
            if shift == 0.0 {
                fixed[..counts[0] * block].fill(true);
            }
            for (count, below) in [
                (1, f64::INFINITY),
                (12, f64::INFINITY),
                (1000, 1.0),
                (1000, f64::INFINITY),
            ] {
                let wanted = Wanted {
                    count,
                    below,
                    tolerance: 1e-10,
                };
                let [ours, dense] = both(&a, &mass, &fixed, wanted, shift);
                assert_eq!(ours.len(), dense.len(), "{counts:?} {count} {below}");
                for (a, b) in ours.iter().zip(&dense) {
                    assert!((a - b).abs() < 1e-9 * (1.0 + b.abs()), "{a} {b}");
                }
            }
        }
    }

    #[test]
    fn modes_that_come_many_times_are_all_found() {
        // Nine equal masses on equal springs, and three others.
        let mut a = BlockCsr::from_couplings(6, 2, &mut |_| ());
        for i in 0..12 {
            a.add_diagonal(i, if i < 9 { 2.0 } else { i as f64 });
        }
        let wanted = Wanted {
            count: 10,
            below: f64::INFINITY,
            tolerance: 1e-10,
        };
        let [ours, dense] = both(&a, &[1.0; 12], &[false; 12], wanted, 0.0);
        assert_eq!(ours.len(), 10);
        for (a, b) in ours.iter().zip(&dense) {
            assert!((a - b).abs() < 1e-12, "{ours:?}");
        }
    }
}
