//! Modes in the space of few states: those at some factors of a map, in which all others are found.
//!
//! A state is a displacement with its rate. In the product of energy, `xᵀ A x' + vᵀ M v'`, the inverse of what moves an undamped system is skew, and damping adds what is
//! negative: projected in that product it stays so, whatever the states, and what the space has beside the modes that it is made of is of higher frequency. A mode
//! costs two states. Displacements alone, with all of their rates, would take up to twice as many unknowns, and eight times the work. Where nothing damps they take no
//! more, and squares of eigenvalues are those of a real matrix: what does not grow has no growth but by rounding.

use super::companion::{Asked, lifted, modes, nearest};
use super::quadratic::Eigen;
use super::reduced::Reduced;
use crate::linear::{Complex, DenseLu, eigenvalues, general, products};
use crate::math::vector::dot_in_fours as dot;

/// Displacements, and their rates.
type State = (Vec<f64>, Vec<f64>);

/// `θ B z = N z` with `θ = 1/(λ - σ)`, as `Reduced` has it, in states that are orthonormal in energy.
#[derive(Default)]
pub(super) struct Few {
    /// Displacements, in the coordinates of the larger space.
    x: Vec<Vec<f64>>,
    /// Rates.
    v: Vec<Vec<f64>>,
    /// The mass times those.
    weighed: Vec<Vec<f64>>,
    /// `B` and `N` without friction.
    still: [Vec<f64>; 2],
    friction: Vec<f64>,
    drag: Vec<f64>,
    approach: Vec<f64>,
}

impl Few {
    /// How many states there are.
    pub fn len(&self) -> usize {
        self.x.len()
    }

    /// Adds the states of modes, but for what is smaller than a part of them beside what there is.
    pub fn add(&mut self, whole: &Reduced, modes: &[Eigen], new: f64) {
        let undamped = whole.undamped();
        for mode in modes {
            let states = states(mode, undamped);
            let energy = |(x, v): &State| dot(x, x) + dot(v, &times(&whole.mass, v));
            let all: f64 = states.iter().map(energy).sum();
            for state in states {
                let (x, v) = self.beside(state);
                let weighed = times(&whole.mass, &v);
                let left = dot(&x, &x) + dot(&v, &weighed);
                if left > new * new * all {
                    let unit = |y: Vec<f64>| y.into_iter().map(|y| y / left.sqrt()).collect();
                    self.x.push(unit(x));
                    self.v.push(unit(v));
                    self.weighed.push(unit(weighed));
                }
            }
        }
        self.project(whole);
    }

    /// What is new in a state.
    fn beside(&self, (mut x, mut v): State) -> State {
        for _ in 0..2 {
            for ((sx, sv), weighed) in self.x.iter().zip(&self.v).zip(&self.weighed) {
                let part = dot(sx, &x) + dot(weighed, &v);
                x.iter_mut().zip(sx).for_each(|(x, s)| *x -= part * s);
                v.iter_mut().zip(sv).for_each(|(v, s)| *v -= part * s);
            }
        }
        (x, v)
    }

    /// Takes the matrices of the larger space.
    pub fn project(&mut self, whole: &Reduced) {
        let images =
            |matrix: &[f64]| -> Vec<Vec<f64>> { self.x.iter().map(|x| times(matrix, x)).collect() };
        let [k, c, m] = [&whole.stiffness, &whole.damping, &whole.mass].map(|a| images(a));
        let s = whole.sigma;
        let (mut held, mut moved) = (k, Vec::new());
        for (j, held) in held.iter_mut().enumerate() {
            let both = c[j].iter().zip(&m[j]);
            let both: Vec<f64> = both.map(|(c, m)| c + s * m).collect();
            held.iter_mut().zip(&both).for_each(|(h, b)| *h += s * b);
            let all = both.iter().zip(&self.weighed[j]);
            moved.push(all.map(|(b, w)| -b - w).collect::<Vec<f64>>());
        }
        let across = products(&self.v, &m);
        let rest = products(&self.v, &self.weighed);
        let rest = rest.iter().zip(&across).map(|(r, a)| r - s * a);
        let held = products(&self.x, &held);
        let moved = products(&self.x, &moved);
        self.still = [
            held.iter().zip(rest).map(|(h, r)| h + r).collect(),
            moved.iter().zip(&across).map(|(m, a)| m + a).collect(),
        ];
        self.take(whole);
    }

    /// Takes the friction of the larger space.
    pub fn take(&mut self, whole: &Reduced) {
        let of = |matrix: &[f64]| -> Vec<f64> {
            let images: Vec<Vec<f64>> = self.x.iter().map(|x| times(matrix, x)).collect();
            products(&self.x, &images)
        };
        let all = [&whole.friction, &whole.drag, &whole.approach].map(|a| of(a));
        [self.friction, self.drag, self.approach] = all;
    }

    /// `B⁻¹ N` with the friction of the larger space, row by row.
    fn dense(&self, whole: &Reduced) -> Vec<f64> {
        let n = self.len();
        let [f, g] = whole.factors;
        let drag = |k: usize| g * self.drag[k] + (f - g) * self.approach[k];
        let [held, moved] = &self.still;
        let held: Vec<f64> = (0..n * n)
            .map(|k| held[k] + f * self.friction[k] + whole.sigma * drag(k))
            .collect();
        // By columns.
        let mut out: Vec<f64> = (0..n * n)
            .map(|k| k % n * n + k / n)
            .map(|k| moved[k] - drag(k))
            .collect();
        DenseLu::new(n, &held).solve(&mut out);
        (0..n * n).map(|k| out[k % n * n + k / n]).collect()
    }

    /// Eigenvalues of least size, by frequency.
    pub fn values(&self, whole: &Reduced, asked: Asked) -> Vec<Complex> {
        let found = eigenvalues(self.len(), &self.dense(whole)).unwrap_or_default();
        let all = found.into_iter().map(|z| (z, ())).collect();
        let all = nearest(whole.sigma, all, asked).into_iter();
        all.map(|(value, ())| value).collect()
    }

    /// The same with displacements in the coordinates of the larger space.
    pub fn eigen(&self, whole: &Reduced, asked: Asked) -> Vec<Eigen> {
        let (values, vectors) = general(self.len(), &self.dense(whole)).unwrap_or_default();
        let all = values.into_iter().zip(vectors).collect();
        lifted(&self.x, modes(nearest(whole.sigma, all, asked), self.len()))
    }
}

/// The states of a mode, real and imaginary part; displacements and rates apart where nothing damps.
fn states(mode: &Eigen, undamped: bool) -> Vec<State> {
    let [l, w] = mode.value;
    let sum = |p: f64, x: &[f64], q: f64, y: &[f64]| -> Vec<f64> {
        x.iter().zip(y).map(|(x, y)| p * x + q * y).collect()
    };
    let [a, b] = &mode.vector;
    let rates = [sum(l, a, -w, b), sum(l, b, w, a)];
    let both = [a.clone(), b.clone()].into_iter().zip(rates);
    if !undamped {
        return both.collect();
    }
    let apart = both.flat_map(|(x, v)| {
        let none = vec![0.0; x.len()];
        [(x, none.clone()), (none, v)]
    });
    apart.collect()
}

/// A square matrix, row by row, times a vector.
fn times(matrix: &[f64], x: &[f64]) -> Vec<f64> {
    let rows = matrix.chunks_exact(x.len());
    rows.map(|row| dot(row, x)).collect()
}
