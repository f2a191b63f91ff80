//! Modes in the space of few displacements: eigenvalues of its companion form, dense where it is small, by the method of Arnoldi where it is not.

use std::f64::consts::TAU;

use super::quadratic::{Eigen, KEPT_RESIDUAL, MODE_RESIDUAL, order};
use super::reduced::Reduced;
use crate::linear::{Complex, DenseLu, Krylov, arnoldi, eigenvalues, general, sums};
use crate::math::vector::dot_in_fours as dot;

/// Companion forms above this size are looked at by the method of Arnoldi.
const LARGE_COMPANION: usize = 240;

/// How many modes, up to which frequency.
pub(crate) type Asked = (usize, f64);

/// Sums of the matrices, each multiplied.
fn sum(reduced: &Reduced, k: usize, parts: [f64; 5]) -> f64 {
    parts[0] * reduced.stiffness[k]
        + parts[1] * reduced.damping[k]
        + parts[2] * reduced.mass[k]
        + parts[3] * reduced.factors[0] * reduced.friction[k]
        + parts[4] * reduced.factors[1] * reduced.drag[k]
        + parts[4] * (reduced.factors[0] - reduced.factors[1]) * reduced.approach[k]
}

/// The companion form about the shift, velocities over the pace.
fn companion(reduced: &Reduced) -> Companion<'_> {
    let r = reduced.basis.len();
    let s = reduced.sigma;
    let of = |parts: [f64; 5]| -> Vec<f64> { (0..r * r).map(|k| sum(reduced, k, parts)).collect() };
    Companion {
        factor: DenseLu::new(r, &of([1.0, s, s * s, 1.0, s])),
        damping: of([0.0, 1.0, s, 0.0, 1.0]),
        of: reduced,
    }
}

/// The operator as a matrix, row by row.
fn dense(reduced: &Reduced) -> Vec<f64> {
    let n = 2 * reduced.basis.len();
    let unit = |j: usize| (0..n).map(|i| f64::from(u8::from(i == j))).collect();
    let columns: Vec<Vec<f64>> = (0..n).map(unit).collect();
    let images = companion(reduced).apply(&columns);
    (0..n * n).map(|k| images[k % n][k / n]).collect()
}

/// Eigenvalues of the companion form of largest size with their vectors.
fn largest(reduced: &Reduced, (count, to): Asked) -> Vec<(Complex, Vec<Complex>)> {
    let n = 2 * reduced.basis.len();
    if n == 0 {
        return Vec::new();
    }
    if n <= LARGE_COMPANION {
        let (values, vectors) = general(n, &dense(reduced)).unwrap_or_default();
        return values.into_iter().zip(vectors).collect();
    }
    let companion = companion(reduced);
    let far = |z: &Complex| 1.0 / size(z) > TAU * to + reduced.sigma;
    let enough = |values: &[(Complex, f64)]| -> bool {
        let first = values
            .iter()
            .take_while(|(_, r)| *r <= MODE_RESIDUAL)
            .count();
        first >= count || values[..first].iter().any(|(z, _)| far(z))
    };
    let mut apply = |all: &[Vec<f64>]| companion.apply(all);
    let mut krylov = Krylov {
        size: n,
        rank: n,
        apply: &mut apply,
    };
    let found = arnoldi(&mut krylov, n, &enough).into_iter();
    let found = found.filter(|f| f.residual <= KEPT_RESIDUAL).map(|found| {
        let [re, im] = found.vector;
        let vector = re.into_iter().zip(im).map(|(re, im)| [re, im]);
        (found.value, vector.collect())
    });
    found.collect()
}

/// Modes of least size by frequency, with displacements in the coordinates of the space.
pub fn eigen(reduced: &Reduced, asked: Asked) -> Vec<Eigen> {
    let found = nearest(reduced.sigma, largest(reduced, asked), asked);
    modes(found, reduced.basis.len())
}

/// Their eigenvalues alone.
pub fn values(reduced: &Reduced, asked: Asked) -> Vec<Complex> {
    let n = 2 * reduced.basis.len();
    if n == 0 {
        return Vec::new();
    }
    let all: Vec<(Complex, ())> = match n <= LARGE_COMPANION {
        true => {
            let values = eigenvalues(n, &dense(reduced)).unwrap_or_default();
            values.into_iter().map(|z| (z, ())).collect()
        }
        false => {
            let found = largest(reduced, asked).into_iter();
            found.map(|(z, _)| (z, ())).collect()
        }
    };
    let found = nearest(reduced.sigma, all, asked).into_iter();
    found.map(|(z, ())| z).collect()
}

/// The mode that grows fastest, relative to its size.
pub fn fastest_of(reduced: &Reduced, asked: Asked) -> Complex {
    fastest(&values(reduced, asked))
}

/// What modes in the coordinates of the space leave open in its equations, relative to what is in them.
pub fn open(reduced: &Reduced, modes: &[Eigen]) -> Vec<f64> {
    let r = reduced.basis.len();
    let of = |parts: [f64; 5]| -> Vec<f64> { (0..r * r).map(|k| sum(reduced, k, parts)).collect() };
    let matrices = [[1.0, 0.0, 0.0, 1.0, 0.0], [0.0, 1.0, 0.0, 0.0, 1.0]].map(of);
    let [stiffness, damping] = &matrices;
    let one = |mode: &Eigen| {
        let [l, w] = mode.value;
        let powers = [[1.0, 0.0], [l, w], [l * l - w * w, 2.0 * l * w]];
        let mut open = 0.0;
        for i in 0..r {
            let rows = [stiffness, damping, &reduced.mass].map(|m| &m[i * r..(i + 1) * r]);
            let mut left = [0.0; 2];
            for (row, [a, b]) in rows.into_iter().zip(powers) {
                let [x, y] = [0, 1].map(|q| dot(row, &mode.vector[q]));
                left[0] += a * x - b * y;
                left[1] += a * y + b * x;
            }
            open += left[0] * left[0] + left[1] * left[1];
        }
        let whole: f64 = mode.vector.iter().map(|x| dot(x, x)).sum();
        (open / whole.max(f64::MIN_POSITIVE)).sqrt()
    };
    modes.iter().map(one).collect()
}

/// Of the eigenvalues `1/(λ - σ)` those that belong to modes of least size, as such of modes, by frequency.
pub(super) fn nearest<T>(
    sigma: f64,
    mut all: Vec<(Complex, T)>,
    (count, to): Asked,
) -> Vec<(Complex, T)> {
    let largest = all.iter().map(|(z, _)| size(z)).fold(0.0, f64::max);
    all.retain(|(z, _)| z[1] >= 0.0 && size(z) > 1e-13 * largest);
    all.sort_by(|a, b| size(&b.0).total_cmp(&size(&a.0)));
    all.truncate(count);
    for (z, _) in &mut all {
        let square = z[0] * z[0] + z[1] * z[1];
        // The inverse lies on the other side of the real axis.
        *z = [sigma + z[0] / square, z[1] / square];
    }
    all.retain(|(z, _)| z[1] <= TAU * to);
    all.sort_by(|a, b| order(&a.0, &b.0));
    all
}

/// Modes from their values and what the inverse has as vectors, of which the first entries are displacements.
pub(super) fn modes(found: Vec<(Complex, Vec<Complex>)>, displacements: usize) -> Vec<Eigen> {
    let all = found.into_iter().map(|(value, y)| Eigen {
        value,
        vector: [(0, 1.0), (1, -1.0)].map(|(q, sign)| {
            let parts = y[..displacements].iter();
            parts.map(|z| sign * z[q]).collect()
        }),
    });
    all.collect()
}

/// The value that grows fastest, relative to its size.
pub(super) fn fastest(values: &[Complex]) -> Complex {
    let rate = |v: &Complex| v[0] / size(v).max(f64::MIN_POSITIVE);
    let fastest = values.iter().max_by(|a, b| rate(a).total_cmp(&rate(b)));
    fastest.copied().unwrap_or_default()
}

/// Modes in the coordinates of a basis as vectors of what it is of.
pub(super) fn lifted(basis: &[Vec<f64>], modes: Vec<Eigen>) -> Vec<Eigen> {
    let columns = 2 * modes.len();
    let entry = |k: usize| modes[k % columns / 2].vector[k % 2][k / columns];
    let factors: Vec<f64> = (0..basis.len() * columns).map(entry).collect();
    let mut vectors = sums(basis, &factors, columns).into_iter();
    let mut next = || vectors.next().unwrap_or_default();
    let all = modes.iter().map(|mode| Eigen {
        value: mode.value,
        vector: [next(), next()],
    });
    all.collect()
}

fn size(z: &Complex) -> f64 {
    z[0].hypot(z[1])
}

/// `z = (x, v)` with velocities over the pace, of which the operator has the eigenvalues `1/(λ - σ)`.
struct Companion<'a> {
    /// `σ² M + σ C + K`.
    factor: DenseLu,
    /// `C + σ M`.
    damping: Vec<f64>,
    of: &'a Reduced,
}

impl Companion<'_> {
    /// `w₁ = -P⁻¹ (M v + (C + σ M) x)`, `w₂ = x + σ w₁`, of several.
    fn apply(&self, all: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let Reduced {
            mass, sigma, pace, ..
        } = self.of;
        let r = self.of.basis.len();
        let forces = all.iter().flat_map(|z| {
            let (x, v) = z.split_at(r);
            let rows = self.damping.chunks_exact(r).zip(mass.chunks_exact(r));
            rows.map(move |(c, m)| -(dot(c, x) + pace * dot(m, v)))
        });
        let mut w: Vec<f64> = forces.collect();
        self.factor.solve(&mut w);
        let each = w.chunks_exact(r).zip(all);
        each.map(|(w, z)| {
            let second = w.iter().zip(z).map(|(w, x)| (x + sigma * w) / pace);
            w.iter().copied().chain(second).collect()
        })
        .collect()
    }
}
