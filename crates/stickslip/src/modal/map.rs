//! Growth over friction, speed and load: many factors at the price of few solutions.
//!
//! The space is that of the lowest real modes and of the displacements that their friction causes at rest, `A⁻¹ L Rᵀ φ`, which is all that first-order
//! perturbation of a mode needs; modes alone would leave the local give of the surfaces out, by which normal motion and friction meet. What modes leave open in the
//! equations of all dofs follows, while it is too much. In that space a factor costs an eigenvalue problem, by the method of Arnoldi where it is large; the modes of some
//! factors span a smaller one, in which all others are found at a cost that does not count.

use std::f64::consts::TAU;

use super::companion::{Asked, fastest, lifted};
use super::few::Few;
use super::linear::{Linear, Rub};
use super::outcome::{FrictionMap, MapRow};
use super::quadratic::{Eigen, UNSTABLE, residuals};
use super::real::lowest;
use super::reduced::{Reduced, images};
use super::shifted::Shifted;
use crate::linear::Complex;
use crate::math::vector::norm;
use crate::model::modal::{MapOver, MapPlan};

/// Rounds in which what modes leave open is added, at most.
pub(super) const ROUNDS: usize = 5;

/// Residual of modes in the equations of all dofs that is good enough. Eigenvalues are better by what left vectors, of which the space knows nothing, have beside it.
const GOOD: f64 = 1e-6;

/// The residual of unstable modes above which a note says so.
const DOUBTFUL: f64 = 1e-4;

/// How far from a critical factor its slope is looked for, relative to the largest.
const NEAR: f64 = 1e-6;

/// Width to which a critical factor is known, relative to the largest.
const WIDTH: f64 = 1e-13;

/// So many critical factors are told in notes.
const TOLD: usize = 4;

/// Companion forms above this size are worth a smaller space.
const MANY: usize = 160;

/// What modes between those of which a smaller space is made may leave open in the larger one, and the part of them that counts as new beside others.
const CLOSE: f64 = 1e-7;
const NEW: f64 = 0.1 * CLOSE;

/// So many states for each displacement of the larger space are few.
const FEWER: f64 = 1.0;

/// At so many factors unstable modes are held against the equations of all dofs.
const CHECKS: usize = 5;

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
pub(crate) fn space(over: &mut Over, asked: Asked, tried: &[f64], solves: &mut usize) -> Reduced {
    let shifted = over.shifted;
    let linear = shifted.linear;
    let count = asked.0;
    let modes = lowest(shifted, (2 * count + 8).min(linear.free()), f64::INFINITY);
    *solves += modes.solves;
    let pace = modes.values.get(count / 2).map_or(1.0, |v| v.abs().sqrt());
    let pace = if pace > 0.0 { pace } else { 1.0 };
    let damped = |x: &[f64]| linear.damped(x);
    let mut reduced = Reduced::new(shifted, pace);
    let block = reduced.grow(shifted, &damped, modes.vectors);
    let images = images(shifted, &block, solves);
    reduced.grow(shifted, &damped, images);
    for &factor in tried {
        for _ in 0..ROUNDS {
            over.set(factor, &mut reduced);
            let modes = reduced.modes(asked);
            let (open, solved) = residuals(shifted, &modes, over.rub(), solves);
            let rests = solved.into_iter().enumerate();
            let rests = rests.filter(|(k, _)| open[k / 2] > GOOD).map(|(_, x)| x);
            let rests: Vec<Vec<f64>> = rests.collect();
            if rests.is_empty() {
                break;
            }
            reduced.grow(shifted, &damped, rests);
        }
    }
    reduced
}

/// The space of a map, and few states of it in which modes are found, where they are fewer.
struct Space {
    whole: Reduced,
    few: Option<Few>,
}

impl Space {
    /// The space with few states, those of modes at some factors: so many that those at factors between leave little open in the whole of it.
    fn new(over: &mut Over, mut whole: Reduced, [from, to]: [f64; 2], asked: Asked) -> Self {
        if 2 * whole.basis.len() <= MANY {
            return Space { whole, few: None };
        }
        let middle = 0.5 * (from + to);
        let mut few = Few::default();
        for factor in [from, middle, to] {
            over.set(factor, &mut whole);
            few.add(&whole, &whole.eigen(asked), NEW);
        }
        let mut untried = vec![[from, middle], [middle, to]];
        while let Some([from, to]) = untried.pop() {
            let known = few.len();
            if known as f64 > FEWER * whole.basis.len() as f64 {
                return Space { whole, few: None };
            }
            let middle = 0.5 * (from + to);
            over.set(middle, &mut whole);
            few.take(&whole);
            let open = whole.open(&few.eigen(&whole, asked));
            if open.into_iter().all(|open| open <= CLOSE) {
                continue;
            }
            few.add(&whole, &whole.eigen(asked), NEW);
            if few.len() > known {
                untried.extend([[from, middle], [middle, to]]);
            }
        }
        let few = Some(few);
        Space { whole, few }
    }

    /// How many unknowns it has: displacements, or displacements and rates.
    fn dimension(&self) -> usize {
        let few = self.few.as_ref();
        few.map_or(self.whole.basis.len(), Few::len)
    }

    /// Goes to a factor.
    fn set(&mut self, over: &mut Over, factor: f64) {
        over.set(factor, &mut self.whole);
        if let (Some(few), MapOver::Speed) = (&mut self.few, over.over) {
            few.take(&self.whole);
        }
    }

    /// Eigenvalues of least size, by frequency.
    fn values(&self, asked: Asked) -> Vec<Complex> {
        match &self.few {
            Some(few) => few.values(&self.whole, asked),
            None => self.whole.values(asked),
        }
    }

    /// Modes of those that grow.
    fn unstable(&self, asked: Asked) -> Vec<Eigen> {
        let mut found = match &self.few {
            Some(few) => few.eigen(&self.whole, asked),
            None => self.whole.eigen(asked),
        };
        found.retain(|e| grows(&e.value, UNSTABLE));
        lifted(&self.whole.basis, found)
    }

    /// The mode that grows fastest, relative to its size.
    fn fastest(&self, asked: Asked) -> Complex {
        fastest(&self.values(asked))
    }
}

/// A map of the modes of least frequency.
pub(crate) fn rows(
    over: &mut Over,
    reduced: Reduced,
    plan: &MapPlan,
    asked: Asked,
    solves: &mut usize,
) -> FrictionMap {
    let linear = over.shifted.linear;
    let factors = plan.factors();
    let mut space = Space::new(over, reduced, plan.range, asked);
    let mut map = FrictionMap {
        over: plan.over.name().into(),
        mu: linear.mu,
        dimension: space.dimension(),
        ..FrictionMap::default()
    };
    let every = factors.len().div_ceil(CHECKS);
    let mut rates = Vec::new();
    for (k, &factor) in factors.iter().enumerate() {
        space.set(over, factor);
        let values = space.values(asked);
        let told = values.iter().map(|v| [v[1] / TAU, v[0]]);
        map.rows.push(MapRow {
            factor,
            mu: over.mu(),
            modes: told.collect(),
        });
        rates.push(fastest(&values));
        let checked = k % every == every / 2 || k + 1 == factors.len();
        if checked && grows(&rates[k], UNSTABLE) {
            let unstable = space.unstable(asked);
            let (open, _) = residuals(over.shifted, &unstable, over.rub(), solves);
            map.residual = open.into_iter().fold(map.residual, f64::max);
        }
    }
    for k in 1..factors.len() {
        let [before, now] = [k - 1, k].map(|k| grows(&rates[k], UNSTABLE));
        let ends = match (before, now) {
            (false, true) => [k - 1, k],
            // More friction is not expected to calm what has begun, and what a map is asked for is where it begins.
            (true, false) if plan.over != MapOver::Friction => [k, k - 1],
            _ => continue,
        };
        let value = rates[ends[1]];
        let ends = ends.map(|k| factors[k]);
        let found = lost(over, &mut space, (ends, value), norm(&factors), asked);
        map.critical.push(found);
    }
    if linear.damping.is_some() && !map.critical.is_empty() && plan.over == MapOver::Friction {
        space.whole.damping.fill(0.0);
        let mut space = Space::new(over, space.whole, plan.range, asked);
        map.undamped = first_lost(over, &mut space, &factors, asked);
    }
    map
}

/// Whether something grows by more than a part of its size.
fn grows(value: &Complex, limit: f64) -> bool {
    value[0] > limit * value[0].hypot(value[1])
}

/// The factor between one that is stable and one that is not at which stability is lost, with the frequency there. `value`: of the one that grows fastest at the second.
fn lost(
    over: &mut Over,
    space: &mut Space,
    ([mut stable, mut unstable], mut value): ([f64; 2], Complex),
    largest: f64,
    asked: Asked,
) -> [f64; 2] {
    let mut at = |factor: f64| {
        space.set(over, factor);
        space.fastest(asked)
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
fn first_lost(over: &mut Over, space: &mut Space, factors: &[f64], asked: Asked) -> Option<f64> {
    let mut before = None;
    for &factor in factors {
        space.set(over, factor);
        let value = space.fastest(asked);
        match (before, grows(&value, UNSTABLE)) {
            (Some(stable), true) => {
                let ends = ([stable, factor], value);
                return Some(lost(over, space, ends, norm(factors), asked)[0]);
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
