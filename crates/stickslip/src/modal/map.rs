//! Growth over friction: many coefficients at the price of few solutions.
//!
//! The space is that of the lowest real modes and of the displacements that their friction causes at rest, `A⁻¹ L Rᵀ φ`, which is all that first-order
//! perturbation of a mode needs; modes alone would leave the local give of the surfaces out, by which normal motion and friction meet. What modes leave open in the
//! equations of all dofs follows, while it is too much. In that space a coefficient of friction costs a dense eigenvalue problem.

use std::f64::consts::TAU;

use super::outcome::{FrictionMap, MapRow};
use super::quadratic::{Eigen, UNSTABLE, by_frequency, residuals};
use super::real::lowest;
use super::reduced::{Reduced, extend, images};
use super::shifted::Shifted;
use crate::linear::{Complex, DenseLu, eigenvalues, general};
use crate::math::vector::norm;
use crate::model::modal::MapPlan;

/// Rounds in which what modes leave open is added, at most.
pub(super) const ROUNDS: usize = 5;

/// Residual of modes in the equations of all dofs that is good enough: eigenvalues are better by about its size again.
pub(super) const GOOD: f64 = 1e-5;

/// The residual of unstable modes above which a note says so.
const DOUBTFUL: f64 = 1e-4;

/// How far from a critical factor its slope is looked for, relative to the largest.
const NEAR: f64 = 1e-6;

/// Width to which a critical factor is known, relative to the largest.
const WIDTH: f64 = 1e-13;

/// The space in which modes of least frequency are found with so much friction and less.
pub(crate) fn space(
    shifted: &Shifted,
    (count, to): (usize, f64),
    largest: f64,
    solves: &mut usize,
) -> Reduced {
    let linear = shifted.linear;
    let asked = (2 * count + 8).min(linear.free());
    let modes = lowest(shifted, asked, f64::INFINITY);
    *solves += modes.solves;
    let pace = modes.values.get(count / 2).map_or(1.0, |v| v.abs().sqrt());
    let pace = if pace > 0.0 { pace } else { 1.0 };
    let mut basis: Vec<Vec<f64>> = Vec::new();
    let block = extend(shifted, &mut basis, modes.vectors);
    let images = images(shifted, &block, solves);
    extend(shifted, &mut basis, images);
    let mut reduced = Reduced::new(shifted, basis, pace);
    for _ in 0..ROUNDS {
        let modes = reduced.modes(largest, (count, to), true);
        let (open, solved) = residuals(shifted, &modes, largest, solves);
        let worse = |k: &usize| open[k / 2] > GOOD;
        let rests: Vec<Vec<f64>> = (0..solved.len())
            .filter(worse)
            .map(|k| solved[k].clone())
            .collect();
        if rests.is_empty() {
            break;
        }
        let mut basis = std::mem::take(&mut reduced.basis);
        extend(shifted, &mut basis, rests);
        reduced = Reduced::new(shifted, basis, pace);
    }
    reduced
}

/// A map over friction of the modes of least frequency.
pub(crate) fn friction(
    shifted: &Shifted,
    reduced: &mut Reduced,
    plan: &MapPlan,
    (count, to): (usize, f64),
    solves: &mut usize,
) -> FrictionMap {
    let linear = shifted.linear;
    let mut map = FrictionMap {
        mu: linear.mu,
        dimension: reduced.basis.len(),
        ..FrictionMap::default()
    };
    let [from, last] = plan.range;
    let step = (last - from) / (plan.points.max(2) - 1) as f64;
    for k in 0..plan.points.max(2) {
        let factor = match k + 1 == plan.points {
            true => last,
            false => from + step * k as f64,
        };
        let modes = reduced.modes(factor, (count, to), true);
        let row = modes
            .iter()
            .map(|e| [e.value[1] / TAU, e.value[0]])
            .collect();
        let grows = |e: &Eigen| e.value[0] > UNSTABLE * e.value[0].hypot(e.value[1]);
        let unstable: Vec<Eigen> = modes.into_iter().filter(grows).collect();
        let (open, _) = residuals(shifted, &unstable, factor, solves);
        map.residual = open.into_iter().fold(map.residual, f64::max);
        map.rows.push(MapRow { factor, modes: row });
    }
    map.critical = reduced.critical(&map.rows, (count, to));
    if linear.damping.is_some() && !map.critical.is_empty() {
        reduced.damping.fill(0.0);
        let rows = map.rows.iter().map(|row| MapRow {
            factor: row.factor,
            modes: Vec::new(),
        });
        let undamped = reduced.critical(&rows.collect::<Vec<_>>(), (count, to));
        map.undamped = undamped.first().map(|c| c[0]);
    }
    map
}

/// What there is to be said of a map.
pub(crate) fn notes(map: &FrictionMap) -> Vec<String> {
    let mut notes = Vec::new();
    match map.critical.first() {
        Some([factor, frequency]) => notes.push(format!(
            "sliding becomes unstable at {factor:.6} times the friction of the step (mu {:.6}), with the frequency {frequency:.6e}",
            factor * map.mu
        )),
        None => notes.push("no change of stability in the range of the map".into()),
    }
    if let (Some(undamped), Some([factor, _])) = (map.undamped, map.critical.first())
        && *factor < undamped * (1.0 - 1e-6)
    {
        notes.push(format!(
            "damping makes it unstable earlier: without it the factor is {undamped:.6}. Where two modes couple, unequal damping of them does that"
        ));
    }
    if map.residual > DOUBTFUL {
        notes.push(format!(
            "unstable modes of the map leave the equations of all dofs open by {:.1e}: ask for more modes",
            map.residual
        ));
    }
    notes
}

impl Reduced {
    /// The companion form about the shift, velocities over the pace.
    fn companion(&self, factor: f64) -> Vec<f64> {
        let r = self.basis.len();
        let s = self.sigma;
        let sum = |k: usize, parts: [f64; 5]| {
            parts[0] * self.stiffness[k]
                + parts[1] * self.damping[k]
                + parts[2] * self.mass[k]
                + parts[3] * self.friction[k]
                + parts[4] * self.drag[k]
        };
        let p: Vec<f64> = (0..r * r)
            .map(|k| sum(k, [1.0, s, s * s, factor, s * factor]))
            .collect();
        let n = 2 * r;
        let images = (0..n * r).map(|k| {
            let (i, column) = (k % r, k / r % r);
            match k >= r * r {
                true => -self.pace * self.mass[i * r + column],
                false => -sum(i * r + column, [0.0, 1.0, s, 0.0, factor]),
            }
        });
        let mut w: Vec<f64> = images.collect();
        DenseLu::new(r, &p).solve(&mut w);
        let mut out = vec![0.0; n * n];
        for (k, w) in w.into_iter().enumerate() {
            let (i, j) = (k % r, k / r);
            let own = if i == j { 1.0 } else { 0.0 };
            out[i * n + j] = w;
            out[(r + i) * n + j] = (own + s * w) / self.pace;
        }
        out
    }

    /// Modes of least size, by frequency; with their displacements where `shapes` are wanted.
    fn modes(&self, factor: f64, (count, to): (usize, f64), shapes: bool) -> Vec<Eigen> {
        let n = 2 * self.basis.len();
        let companion = self.companion(factor);
        let found = match shapes {
            true => general(n, &companion),
            // Values alone cost a fraction.
            false => eigenvalues(n, &companion).map(|values| {
                let none = vec![Vec::new(); values.len()];
                (values, none)
            }),
        };
        let Some((values, vectors)) = found else {
            return Vec::new();
        };
        let size = |z: &Complex| z[0].hypot(z[1]);
        let largest = values.iter().map(size).fold(0.0, f64::max);
        let mut all: Vec<(Complex, Vec<Complex>)> = values
            .into_iter()
            .zip(vectors)
            .filter(|(z, _)| z[1] >= 0.0 && size(z) > 1e-13 * largest)
            .collect();
        all.sort_by(|a, b| size(&b.0).total_cmp(&size(&a.0)));
        all.truncate(count);
        let mut out: Vec<Eigen> = all
            .into_iter()
            .map(|(z, y)| {
                let square = z[0] * z[0] + z[1] * z[1];
                let value = [self.sigma + z[0] / square, z[1] / square];
                let part = |k: usize, sign: f64| {
                    let mut x = vec![0.0; self.basis[0].len()];
                    for (q, y) in self.basis.iter().zip(&y).take(if shapes { n } else { 0 }) {
                        x.iter_mut().zip(q).for_each(|(x, q)| *x += sign * y[k] * q);
                    }
                    x
                };
                let vector = [part(0, 1.0), part(1, -1.0)];
                Eigen { value, vector }
            })
            .filter(|e| e.value[1] <= TAU * to)
            .collect();
        by_frequency(&mut out);
        out
    }

    /// The mode that grows fastest, relative to its size.
    pub(super) fn fastest(&self, factor: f64, asked: (usize, f64)) -> Complex {
        let modes = self.modes(factor, asked, false);
        let rate = |v: &Complex| v[0] / v[0].hypot(v[1]).max(f64::MIN_POSITIVE);
        let values = modes.into_iter().map(|e| e.value);
        let fastest = values.max_by(|a, b| rate(a).total_cmp(&rate(b)));
        fastest.unwrap_or_default()
    }

    /// Factors at which stability is lost between rows that are stable and rows that are not, with the frequency there.
    fn critical(&self, rows: &[MapRow], asked: (usize, f64)) -> Vec<[f64; 2]> {
        let grows = |v: &Complex, limit: f64| v[0] > limit * v[0].hypot(v[1]);
        let fastest: Vec<Complex> = rows
            .iter()
            .map(|row| self.fastest(row.factor, asked))
            .collect();
        let mut out = Vec::new();
        let largest = norm(&rows.iter().map(|r| r.factor).collect::<Vec<_>>());
        for k in 1..rows.len() {
            if grows(&fastest[k - 1], UNSTABLE) || !grows(&fastest[k], UNSTABLE) {
                continue;
            }
            let (mut low, mut high) = (rows[k - 1].factor, rows[k].factor);
            let mut value = fastest[k];
            while high - low > WIDTH * largest {
                let middle = 0.5 * (low + high);
                if middle <= low || middle >= high {
                    break;
                }
                let there = self.fastest(middle, asked);
                match grows(&there, UNSTABLE) {
                    true => (high, value) = (middle, there),
                    false => low = middle,
                }
            }
            // Without damping growth leaves zero with the root, and what is found is as near as rounding lets one see; with damping it goes through zero in
            // proportion to friction, and the straight line says where.
            let ahead = high + NEAR * largest;
            let there = self.fastest(ahead, asked);
            let slope = (there[0] - value[0]) / (ahead - high);
            let back = if slope > 0.0 { value[0] / slope } else { 0.0 };
            out.push([high - back.min(NEAR * largest), value[1] / TAU]);
        }
        out
    }
}
