//! The quadratic eigenvalue problem of steady sliding, by the method of Arnoldi on its companion form.

use std::cmp::Ordering;
use std::f64::consts::TAU;

use super::linear::{FrictionTerms, Linear, Pair, add_pairs};
use super::shifted::{Root, Shifted};
use crate::linear::{Complex, Krylov, arnoldi};
use crate::modal::shifted;

/// Estimate of the residual at which a mode counts as found: a few digits above rounding, so that the method of Arnoldi reaches it. Between
/// 1e-12 and 1e-9 the tests of modes pass.
pub(super) const MODE_RESIDUAL: f64 = 1e-11;

/// The estimate up to which a mode is kept where the method ends before.
pub(super) const KEPT_RESIDUAL: f64 = 1e3 * MODE_RESIDUAL;

/// Growth relative to the size of the eigenvalue from which a mode counts as unstable: more than what may be left open. With
/// 3e-10 the tests of modes pass; with 3e-7 three of them find the limit of stability too late.
pub(crate) const UNSTABLE_GROWTH: f64 = KEPT_RESIDUAL;

/// An eigenvalue with its vector.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Eigen {
    /// `[1/s]`.
    pub value: Complex,
    pub vector: [Vec<f64>; 2],
}

/// The companion form about the shift, `z = (x, λ x)`, as an operator with the eigenvalues `1/(λ - σ)`.
struct Companion<'a> {
    shifted: &'a Shifted<'a>,
    root: &'a Root,
    /// The friction with its sides exchanged where the transposed problem is meant.
    drag: Vec<Pair>,
    /// By what displacements and velocities are multiplied: roots of stiffness and mass.
    scales: [Vec<f64>; 2],
}

impl<'a> Companion<'a> {
    fn new(shifted: &'a Shifted, root: &'a Root, transposed: bool) -> Self {
        let linear = shifted.linear;
        let mut stiffness = linear.stiffness.diagonal();
        let mass = linear.mass.diagonal();
        let sigma = shifted.shift();
        stiffness
            .iter_mut()
            .zip(&mass)
            .for_each(|(k, m)| *k += sigma * m);
        let roots = |diagonal: Vec<f64>| -> Vec<f64> {
            let all = diagonal.iter().zip(&linear.fixed);
            let root = |(d, fixed): (&f64, &bool)| if *fixed { 0.0 } else { d.max(0.0).sqrt() };
            all.map(root).collect()
        };
        let drag = linear.drag.iter().map(|pair| {
            let (left, right) = pair.sides(transposed);
            Pair {
                left: left.clone(),
                right: right.clone(),
                ..*pair
            }
        });
        Companion {
            shifted,
            root,
            drag: drag.collect(),
            scales: [roots(stiffness), roots(mass)],
        }
    }

    fn unscaled(&self, z: &[f64], k: usize) -> Vec<f64> {
        let n = self.shifted.linear.size();
        let part = z[k * n..(k + 1) * n].iter().zip(&self.scales[k]);
        part.map(|(z, s)| if *s > 0.0 { z / s } else { 0.0 })
            .collect()
    }

    /// `w₁ = -P⁻¹ (M z₂ + (C + σ M) z₁)`, `w₂ = z₁ + σ w₁`, of several at once.
    fn apply(&self, all: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let linear = self.shifted.linear;
        let sigma = self.shifted.sigma;
        let positions: Vec<Vec<f64>> = all.iter().map(|z| self.unscaled(z, 0)).collect();
        let forces = all.iter().zip(&positions).flat_map(|(z, x)| {
            let v = self.unscaled(z, 1);
            let both: Vec<f64> = v.iter().zip(x).map(|(v, x)| v + sigma * x).collect();
            let mut w = linear.times(&linear.mass, &both);
            let damped = linear.damped(x);
            w.iter_mut().zip(damped).for_each(|(w, c)| *w += c);
            add_pairs(&self.drag, 1.0, x, &mut w);
            w
        });
        let mut w: Vec<f64> = forces.map(|w| -w).collect();
        self.root.solve(self.shifted, &mut w, all.len());
        let each = w.chunks_exact(linear.size()).zip(&positions);
        each.map(|(w, x)| {
            let second = x.iter().zip(w).map(|(x, w)| x + sigma * w);
            let second = second.zip(&self.scales[1]).map(|(w, s)| w * s);
            let first = w.iter().zip(&self.scales[0]).map(|(w, s)| w * s);
            first.chain(second).collect()
        })
        .collect()
    }
}

/// Eigenvalues of least size and their vectors, by frequency: so many, up to a frequency, with the friction that the root is set for; of the transposed problem where it is set
/// for that.
pub(crate) fn solve(
    shifted: &Shifted,
    root: &Root,
    count: usize,
    to: f64,
    transposed: bool,
    solves: &mut usize,
) -> Vec<Eigen> {
    let companion = Companion::new(shifted, root, transposed);
    let linear = shifted.linear;
    let mut applied = 0;
    let mut apply = |z: &[Vec<f64>]| {
        applied += z.len();
        companion.apply(z)
    };
    let mut krylov = Krylov {
        size: 2 * linear.size(),
        rank: 2 * linear.free(),
        apply: &mut apply,
    };
    let far = |value: &Complex| 1.0 / value[0].hypot(value[1]) > TAU * to + shifted.sigma;
    let good = |values: &[(Complex, f64)]| -> bool {
        let first = values
            .iter()
            .take_while(|(_, r)| *r <= MODE_RESIDUAL)
            .count();
        first >= count || values[..first].iter().any(|(v, _)| far(v))
    };
    let ritz = arnoldi(&mut krylov, 20 * count + 400, &good);
    // With friction a solution takes two sweeps.
    *solves += applied * if root.pairs.is_empty() { 1 } else { 2 };
    let size = |v: &Complex| v[0].hypot(v[1]);
    let largest = ritz.iter().fold(0.0, |m: f64, r| m.max(size(&r.value)));
    let kept = ritz.into_iter().filter(|r| r.residual <= KEPT_RESIDUAL);
    // What has no mass has infinite eigenvalues.
    let finite = kept
        .filter(|r| size(&r.value) > 1e-12 * largest)
        .take(count);
    let mut all: Vec<Eigen> = finite
        .map(|r| {
            let [a, b] = r.value;
            let square = a * a + b * b;
            // The inverse lies on the other side of the real axis.
            let value = [shifted.sigma + a / square, b / square];
            let [x, mut y] = [0, 1].map(|k| companion.unscaled(&r.vector[k], 0));
            y.iter_mut().for_each(|y| *y = -*y);
            Eigen {
                value,
                vector: [x, y],
            }
        })
        .filter(|e| e.value[1] <= TAU * to)
        .collect();
    all.sort_by(|a, b| order(&a.value, &b.value));
    all
}

/// The order of eigenvalues: by frequency, then by growth.
pub(super) fn order(a: &Complex, b: &Complex) -> Ordering {
    let by_frequency = a[1].total_cmp(&b[1]);
    by_frequency.then(a[0].total_cmp(&b[0]))
}

/// What is left of the equations of motion with such friction, real and imaginary part.
pub(crate) fn open(linear: &Linear, eigen: &Eigen, rub: FrictionTerms) -> [Vec<f64>; 2] {
    let [l, w] = eigen.value;
    let powers = [[1.0, 0.0], [l, w], [l * l - w * w, 2.0 * l * w]];
    let [x, y] = [0, 1].map(|k| shifted::forces(linear, &eigen.vector[k], rub));
    let mut open = [0, 1].map(|_| vec![0.0; linear.size()]);
    for (q, [a, b]) in powers.into_iter().enumerate() {
        for i in (0..linear.size()).filter(|&i| !linear.fixed[i]) {
            open[0][i] += a * x[q][i] - b * y[q][i];
            open[1][i] += a * y[q][i] + b * x[q][i];
        }
    }
    open
}

/// The same relative to what is in the modes, of each, and the displacements at rest under it.
pub(crate) fn residuals(
    shifted: &Shifted,
    modes: &[Eigen],
    rub: FrictionTerms,
    solves: &mut usize,
) -> (Vec<f64>, Vec<Vec<f64>>) {
    let open = modes.iter().flat_map(|e| open(shifted.linear, e, rub));
    let open: Vec<Vec<f64>> = open.collect();
    let solved = shifted.solved(&open);
    *solves += solved.len();
    let each = modes.iter().enumerate();
    let relative = each.map(|(k, e)| {
        let own = 2 * k..2 * k + 2;
        shifted.relative(&open[own.clone()], &solved[own], &e.vector)
    });
    (relative.collect(), solved)
}
