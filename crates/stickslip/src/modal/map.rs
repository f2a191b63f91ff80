//! Growth over friction, speed and load: many factors at the price of few solutions.
//!
//! The space is that of the lowest real modes and of the displacements that their friction causes at rest, `A⁻¹ L Rᵀ φ`, which is all that first-order
//! perturbation of a mode needs; modes alone would leave the local give of the surfaces out, by which normal motion and friction meet. What modes leave open in the
//! equations of all dofs follows, while it is too much. In that space a factor costs an eigenvalue problem, by the method of Arnoldi where it is large; those of a few
//! factors span a smaller one, in which all others are found.

use std::f64::consts::TAU;

use super::linear::{Linear, Rub};
use super::outcome::{FrictionMap, MapRow};
use super::quadratic::{Eigen, UNSTABLE, by_frequency, residuals};
use super::real::lowest;
use super::reduced::{Reduced, extend, images};
use super::shifted::Shifted;
use crate::linear::{Complex, DenseLu, Krylov, arnoldi, general};
use crate::math::vector::{dot, norm};
use crate::model::modal::{MapOver, MapPlan};

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

/// So many critical factors are told in notes.
const TOLD: usize = 4;

/// Companion forms above this size are looked at by the method of Arnoldi.
const LARGE: usize = 160;

/// Estimate of the residual at which that method has found a mode.
const FOUND: f64 = 1e-12;

/// At so many factors modes are taken for the smaller space.
const NODES: usize = 5;

/// What has to be left of a mode beside those before it, and the part of the space that the smaller one may have.
const NEW: f64 = 1e-8;
const SMALLER: f64 = 0.7;

/// At so many factors unstable modes are held against the equations of all dofs.
const CHECKS: usize = 5;

/// How many modes, up to which frequency.
pub(crate) type Asked = (usize, f64);

/// What changes over a map.
pub(crate) struct Over<'a> {
    shifted: &'a Shifted<'a>,
    over: MapOver,
    /// Friction at so many times the speed.
    at_speed: &'a mut dyn FnMut(f64) -> Linear,
    /// That at hand, where it is that of a speed.
    rubbed: Option<Linear>,
    factors: [f64; 2],
}

impl<'a> Over<'a> {
    pub fn new(
        shifted: &'a Shifted<'a>,
        over: MapOver,
        at_speed: &'a mut dyn FnMut(f64) -> Linear,
    ) -> Self {
        Over {
            shifted,
            over,
            at_speed,
            rubbed: None,
            factors: [1.0; 2],
        }
    }

    /// Goes to a factor.
    fn set(&mut self, factor: f64, reduced: &mut Reduced) {
        self.factors = match self.over {
            MapOver::Friction => [factor; 2],
            MapOver::Speed => [1.0; 2],
            MapOver::Load => [1.0, factor],
        };
        if self.over == MapOver::Speed {
            let found = (self.at_speed)(factor);
            reduced.take(&found);
            self.rubbed = Some(found);
        }
        reduced.factors = self.factors;
    }

    /// Friction at hand.
    fn rub(&self) -> Rub<'_> {
        let linear = self.rubbed.as_ref().unwrap_or(self.shifted.linear);
        Rub {
            factors: self.factors,
            ..linear.rub(1.0)
        }
    }

    /// Its mean coefficient.
    fn mu(&self) -> f64 {
        let linear = self.rubbed.as_ref().unwrap_or(self.shifted.linear);
        self.factors[0] * linear.mu
    }
}

/// The space in which modes of least frequency are found at factors between these.
pub(crate) fn space(over: &mut Over, asked: Asked, ends: &[f64], solves: &mut usize) -> Reduced {
    let shifted = over.shifted;
    let linear = shifted.linear;
    let count = asked.0;
    let modes = lowest(shifted, (2 * count + 8).min(linear.free()), f64::INFINITY);
    *solves += modes.solves;
    let pace = modes.values.get(count / 2).map_or(1.0, |v| v.abs().sqrt());
    let pace = if pace > 0.0 { pace } else { 1.0 };
    let mut basis: Vec<Vec<f64>> = Vec::new();
    let block = extend(shifted, &mut basis, modes.vectors);
    let images = images(shifted, &block, solves);
    extend(shifted, &mut basis, images);
    let mut reduced = Reduced::new(shifted, basis, pace);
    for _ in 0..ROUNDS {
        let mut rests = Vec::new();
        for &end in ends {
            over.set(end, &mut reduced);
            let modes = reduced.modes(asked, true);
            let (open, solved) = residuals(shifted, &modes, over.rub(), solves);
            let worse = solved.into_iter().enumerate();
            rests.extend(worse.filter(|(k, _)| open[k / 2] > GOOD).map(|(_, x)| x));
        }
        if rests.is_empty() {
            break;
        }
        let mut basis = std::mem::take(&mut reduced.basis);
        extend(shifted, &mut basis, rests);
        reduced = Reduced::new(shifted, basis, pace);
    }
    reduced
}

/// A map of the modes of least frequency.
pub(crate) fn rows(
    over: &mut Over,
    mut reduced: Reduced,
    plan: &MapPlan,
    asked: Asked,
    solves: &mut usize,
) -> FrictionMap {
    let linear = over.shifted.linear;
    let factors = plan.factors();
    if let Some(smaller) = smaller(over, &mut reduced, plan, asked) {
        reduced = smaller;
    }
    let mut map = FrictionMap {
        over: plan.over.name().into(),
        mu: linear.mu,
        dimension: reduced.basis.len(),
        ..FrictionMap::default()
    };
    let every = factors.len().div_ceil(CHECKS);
    let mut fastest = Vec::new();
    for (k, &factor) in factors.iter().enumerate() {
        over.set(factor, &mut reduced);
        let checked = k % every == every / 2 || k + 1 == factors.len();
        let modes = reduced.modes(asked, checked);
        let told = modes.iter().map(|e| [e.value[1] / TAU, e.value[0]]);
        map.rows.push(MapRow {
            factor,
            mu: over.mu(),
            modes: told.collect(),
        });
        fastest.push(fastest_of(&modes));
        if checked {
            let unstable = modes.into_iter().filter(|e| grows(&e.value, UNSTABLE));
            let unstable: Vec<Eigen> = unstable.collect();
            let (open, _) = residuals(over.shifted, &unstable, over.rub(), solves);
            map.residual = open.into_iter().fold(map.residual, f64::max);
        }
    }
    for k in 1..factors.len() {
        let [before, now] = [k - 1, k].map(|k| grows(&fastest[k], UNSTABLE));
        let ends = match (before, now) {
            (false, true) => [k - 1, k],
            // More friction is not expected to calm what has begun, and what a map is asked for is where it begins.
            (true, false) if plan.over != MapOver::Friction => [k, k - 1],
            _ => continue,
        };
        let value = fastest[ends[1]];
        let ends = ends.map(|k| factors[k]);
        let found = lost(over, &mut reduced, (ends, value), norm(&factors), asked);
        map.critical.push(found);
    }
    if linear.damping.is_some() && !map.critical.is_empty() && plan.over == MapOver::Friction {
        reduced.damping.fill(0.0);
        map.undamped = first_lost(over, &mut reduced, &factors, asked);
    }
    map
}

/// Modes at a few factors as a space, where that is smaller.
fn smaller(
    over: &mut Over,
    reduced: &mut Reduced,
    plan: &MapPlan,
    asked: Asked,
) -> Option<Reduced> {
    let r = reduced.basis.len();
    if 2 * r <= LARGE {
        return None;
    }
    let [from, to] = plan.range;
    let mut columns: Vec<Vec<f64>> = Vec::new();
    for k in 0..NODES {
        over.set(from + (to - from) * k as f64 / (NODES - 1) as f64, reduced);
        for (_, y) in reduced.eigen(asked) {
            for q in 0..2 {
                let mut z: Vec<f64> = y[..r].iter().map(|z| z[q]).collect();
                let size = norm(&z);
                for _ in 0..2 {
                    for c in &columns {
                        let part = dot(c, &z);
                        z.iter_mut().zip(c).for_each(|(z, c)| *z -= part * c);
                    }
                }
                let left = norm(&z);
                if left > NEW * size {
                    z.iter_mut().for_each(|z| *z /= left);
                    columns.push(z);
                }
            }
        }
    }
    let few = !columns.is_empty() && (columns.len() as f64) < SMALLER * r as f64;
    few.then(|| reduced.within(&columns))
}

/// Whether something grows by more than a part of its size.
fn grows(value: &Complex, limit: f64) -> bool {
    value[0] > limit * value[0].hypot(value[1])
}

/// The value of the mode that grows fastest, relative to its size.
fn fastest_of(modes: &[Eigen]) -> Complex {
    let rate = |v: &Complex| v[0] / v[0].hypot(v[1]).max(f64::MIN_POSITIVE);
    let values = modes.iter().map(|e| e.value);
    let fastest = values.max_by(|a, b| rate(a).total_cmp(&rate(b)));
    fastest.unwrap_or_default()
}

/// The factor between one that is stable and one that is not at which stability is lost, with the frequency there. `value`: of the one that grows fastest at the second.
fn lost(
    over: &mut Over,
    reduced: &mut Reduced,
    ([mut stable, mut unstable], mut value): ([f64; 2], Complex),
    largest: f64,
    asked: Asked,
) -> [f64; 2] {
    let mut at = |factor: f64| {
        over.set(factor, reduced);
        reduced.fastest(asked)
    };
    while (unstable - stable).abs() > WIDTH * largest {
        let middle = 0.5 * (stable + unstable);
        if middle == stable || middle == unstable {
            break;
        }
        let there = at(middle);
        match grows(&there, UNSTABLE) {
            true => (unstable, value) = (middle, there),
            false => stable = middle,
        }
    }
    // Without damping growth leaves zero with the root, and what is found is as near as rounding lets one see; with damping it goes through zero in
    // proportion to friction, and the straight line says where.
    let way = NEAR * largest * (unstable - stable).signum();
    let there = at(unstable + way);
    let slope = (there[0] - value[0]) / way.abs();
    let back = if slope > 0.0 { value[0] / slope } else { 0.0 };
    let back = back.min(way.abs()) * way.signum();
    [unstable - back, value[1] / TAU]
}

/// The first factor at which stability is lost.
fn first_lost(
    over: &mut Over,
    reduced: &mut Reduced,
    factors: &[f64],
    asked: Asked,
) -> Option<f64> {
    let mut before = None;
    for &factor in factors {
        over.set(factor, reduced);
        let value = reduced.fastest(asked);
        match (before, grows(&value, UNSTABLE)) {
            (Some(stable), true) => {
                let ends = ([stable, factor], value);
                return Some(lost(over, reduced, ends, norm(factors), asked)[0]);
            }
            (_, false) => before = Some(factor),
            (None, true) => {}
        }
    }
    None
}

/// What there is to be said of a map.
pub(crate) fn notes(map: &FrictionMap) -> Vec<String> {
    let mut notes = Vec::new();
    for [factor, frequency] in map.critical.iter().take(TOLD) {
        notes.push(match map.over == MapOver::Friction.name() {
            true => format!(
                "sliding becomes unstable at {factor:.6} times the friction of the step (mu {:.6}), with the frequency {frequency:.6e}",
                factor * map.mu
            ),
            false => format!(
                "sliding is unstable {} {factor:.6} times the {} of the step, with the frequency {frequency:.6e}",
                side(map, *factor),
                map.over
            ),
        });
    }
    if map.critical.is_empty() {
        notes.push("no change of stability in the range of the map".into());
    }
    let others = map.rows.iter().map(|row| (row.mu - map.mu).abs());
    if map.over == MapOver::Speed.name() && others.fold(0.0, f64::max) > 0.01 * map.mu {
        notes.push("friction depends on the speed, and the map keeps the pressures of the step: where they depend on friction a sweep over the speed finds them anew".into());
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

/// On which side of a critical factor sliding is unstable.
fn side(map: &FrictionMap, factor: f64) -> &'static str {
    let above = map.rows.iter().find(|row| row.factor > factor);
    let unstable = above.is_some_and(|row| {
        row.modes
            .iter()
            .any(|m| grows(&[m[1], TAU * m[0]], UNSTABLE))
    });
    if unstable { "above" } else { "below" }
}

impl Reduced {
    /// Sums of the matrices, each multiplied.
    fn sum(&self, k: usize, parts: [f64; 5]) -> f64 {
        parts[0] * self.stiffness[k]
            + parts[1] * self.damping[k]
            + parts[2] * self.mass[k]
            + parts[3] * self.factors[0] * self.friction[k]
            + parts[4] * self.factors[1] * self.drag[k]
            + parts[4] * (self.factors[0] - self.factors[1]) * self.approach[k]
    }

    /// The companion form about the shift, velocities over the pace.
    fn companion(&self) -> Companion<'_> {
        let r = self.basis.len();
        let s = self.sigma;
        let of = |parts: [f64; 5]| -> Vec<f64> { (0..r * r).map(|k| self.sum(k, parts)).collect() };
        Companion {
            factor: DenseLu::new(r, &of([1.0, s, s * s, 1.0, s])),
            damping: of([0.0, 1.0, s, 0.0, 1.0]),
            of: self,
        }
    }

    /// Eigenvalues of the companion form of largest size with their vectors.
    fn largest(&self, (count, to): Asked) -> Vec<(Complex, Vec<Complex>)> {
        let companion = self.companion();
        let n = 2 * self.basis.len();
        if n <= LARGE {
            let unit = |j: usize| (0..n).map(|i| f64::from(u8::from(i == j))).collect();
            let columns: Vec<Vec<f64>> = (0..n).map(unit).collect();
            let images = companion.apply(&columns);
            let dense: Vec<f64> = (0..n * n).map(|k| images[k % n][k / n]).collect();
            let (values, vectors) = general(n, &dense).unwrap_or_default();
            return values.into_iter().zip(vectors).collect();
        }
        let size = |z: &Complex| z[0].hypot(z[1]);
        let far = |z: &Complex| 1.0 / size(z) > TAU * to + self.sigma;
        let enough = |values: &[(Complex, f64)]| -> bool {
            let first = values.iter().take_while(|(_, r)| *r <= FOUND).count();
            first >= count || values[..first].iter().any(|(z, _)| far(z))
        };
        let mut apply = |all: &[Vec<f64>]| companion.apply(all);
        let mut krylov = Krylov {
            size: n,
            rank: n,
            apply: &mut apply,
        };
        let found = arnoldi(&mut krylov, n, &enough).into_iter();
        let found = found.filter(|f| f.residual <= 1e3 * FOUND).map(|found| {
            let [re, im] = found.vector;
            let vector = re.into_iter().zip(im).map(|(re, im)| [re, im]);
            (found.value, vector.collect())
        });
        found.collect()
    }

    /// Modes of least size with their vectors in the companion form.
    fn eigen(&self, (count, to): Asked) -> Vec<(Complex, Vec<Complex>)> {
        let size = |z: &Complex| z[0].hypot(z[1]);
        let mut all = self.largest((count, to));
        let largest = all.iter().map(|(z, _)| size(z)).fold(0.0, f64::max);
        all.retain(|(z, _)| z[1] >= 0.0 && size(z) > 1e-13 * largest);
        all.sort_by(|a, b| size(&b.0).total_cmp(&size(&a.0)));
        all.truncate(count);
        for (z, _) in &mut all {
            let square = z[0] * z[0] + z[1] * z[1];
            *z = [self.sigma + z[0] / square, z[1] / square];
        }
        all.retain(|(z, _)| z[1] <= TAU * to);
        all
    }

    /// Modes of least size, by frequency; with their displacements where `shapes` are wanted.
    fn modes(&self, asked: Asked, shapes: bool) -> Vec<Eigen> {
        let r = self.basis.len();
        let part = |y: &[Complex], q: usize, sign: f64| {
            let mut x = vec![0.0; self.basis[0].len()];
            for (b, y) in self.basis.iter().zip(y).take(if shapes { r } else { 0 }) {
                x.iter_mut().zip(b).for_each(|(x, b)| *x += sign * y[q] * b);
            }
            x
        };
        let found = self.eigen(asked).into_iter().map(|(value, y)| Eigen {
            value,
            vector: [part(&y, 0, 1.0), part(&y, 1, -1.0)],
        });
        let mut out: Vec<Eigen> = found.collect();
        by_frequency(&mut out);
        out
    }

    /// The mode that grows fastest, relative to its size.
    pub(super) fn fastest(&self, asked: Asked) -> Complex {
        fastest_of(&self.modes(asked, false))
    }
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
