//! The quadratic eigenvalue problem of steady sliding, by the method of Arnoldi on its companion form.

use std::f64::consts::TAU;

use super::linear::{Linear, Pair, add_pairs};
use super::shifted::{Root, Shifted};
use crate::linear::{Complex, Krylov, arnoldi};

/// Estimate of the residual at which a mode counts as found.
const TOLERANCE: f64 = 1e-11;

/// Growth relative to the size of the eigenvalue from which a mode counts as unstable.
pub(crate) const UNSTABLE: f64 = 1e-8;

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
        let drag = linear.drag.iter().map(|pair| match transposed {
            true => Pair {
                left: pair.right.clone(),
                right: pair.left.clone(),
                interface: pair.interface,
            },
            false => pair.clone(),
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

    /// `w₁ = -P⁻¹ (M z₂ + (C + σ M) z₁)`, `w₂ = z₁ + σ w₁`.
    fn apply(&self, z: &[f64]) -> Vec<f64> {
        let linear = self.shifted.linear;
        let sigma = self.shifted.sigma;
        let [x, v] = [0, 1].map(|k| self.unscaled(z, k));
        let both: Vec<f64> = v.iter().zip(&x).map(|(v, x)| v + sigma * x).collect();
        let mut w = linear.times(&linear.mass, &both);
        let damped = linear.damped(&x);
        w.iter_mut().zip(damped).for_each(|(w, c)| *w += c);
        add_pairs(&self.drag, 1.0, &x, &mut w);
        self.root.solve(self.shifted, &mut w);
        w.iter_mut().for_each(|w| *w = -*w);
        let second = x.iter().zip(&w).map(|(x, w)| x + sigma * w);
        let second = second.zip(&self.scales[1]).map(|(w, s)| w * s);
        let first = w.iter().zip(&self.scales[0]).map(|(w, s)| w * s);
        first.chain(second).collect()
    }
}

/// Eigenvalues of least size and their vectors, by frequency: so many, up to a frequency, with the friction that the root is set for; of the transposed problem where it is set
/// for that.
pub(crate) fn solve(
    shifted: &Shifted,
    root: &Root,
    (count, to): (usize, f64),
    transposed: bool,
    solves: &mut usize,
) -> Vec<Eigen> {
    let companion = Companion::new(shifted, root, transposed);
    let linear = shifted.linear;
    let mut applied = 0;
    let mut apply = |z: &[f64]| {
        applied += 1;
        companion.apply(z)
    };
    let mut krylov = Krylov {
        size: 2 * linear.size(),
        rank: 2 * linear.free(),
        apply: &mut apply,
    };
    let far = |value: &Complex| 1.0 / value[0].hypot(value[1]) > TAU * to + shifted.sigma;
    let good = |values: &[(Complex, f64)]| -> bool {
        let first = values.iter().take_while(|(_, r)| *r <= TOLERANCE).count();
        first >= count || values[..first].iter().any(|(v, _)| far(v))
    };
    let ritz = arnoldi(&mut krylov, 20 * count + 400, &good);
    // With friction a solution takes two sweeps.
    *solves += applied * if root.pairs.is_empty() { 1 } else { 2 };
    let size = |v: &Complex| v[0].hypot(v[1]);
    let largest = ritz.iter().fold(0.0, |m: f64, r| m.max(size(&r.value)));
    let kept = ritz.into_iter().filter(|r| r.residual <= 1e3 * TOLERANCE);
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
    all.sort_by(|a, b| {
        let by_frequency = a.value[1].total_cmp(&b.value[1]);
        by_frequency.then(a.value[0].total_cmp(&b.value[0]))
    });
    all
}

/// What is left of the equations of motion with all friction times `factor`, real and imaginary part, and that relative to the forces in them.
pub(crate) fn residual(linear: &Linear, eigen: &Eigen, factor: f64) -> ([Vec<f64>; 2], f64) {
    let [l, w] = eigen.value;
    let square = [l * l - w * w, 2.0 * l * w];
    let [x, y] = [0, 1].map(|k| linear.forces(&eigen.vector[k], factor));
    let mut open = [0, 1].map(|_| vec![0.0; linear.size()]);
    let (mut rest, mut sizes) = (0.0, [0.0; 3]);
    for i in 0..linear.size() {
        if linear.fixed[i] {
            continue;
        }
        let part = |q: usize, f: Complex| -> Complex {
            let (a, b) = (x[q][i], y[q][i]);
            [f[0] * a - f[1] * b, f[0] * b + f[1] * a]
        };
        let parts = [part(0, [1.0, 0.0]), part(1, [l, w]), part(2, square)];
        let sum = |c: usize| parts.iter().map(|p| p[c]).sum::<f64>();
        open[0][i] = sum(0);
        open[1][i] = sum(1);
        rest += sum(0).powi(2) + sum(1).powi(2);
        for (s, p) in sizes.iter_mut().zip(parts) {
            *s += p[0] * p[0] + p[1] * p[1];
        }
    }
    let scale: f64 = sizes.iter().map(|s| s.sqrt()).sum();
    (open, rest.sqrt() / scale.max(f64::MIN_POSITIVE))
}
