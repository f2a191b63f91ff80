//! Growth over friction, speed and load: many factors at the price of few solutions.
//!
//! The space is that of the modes of the state, of the lowest real modes, and of the displacements that their friction causes at rest, `A⁻¹ L Rᵀ φ`, which is all that
//! first-order perturbation of a mode needs; modes alone would leave the local give of the surfaces out, by which normal motion and friction meet. What modes leave open
//! in the equations of all dofs follows, at the factor at which it is most, until it is little at all that are tried: `estimate` tells without a solution. In that space
//! a factor costs an eigenvalue problem, by the method of Arnoldi where it is large; the modes of some factors span a smaller one, in which all others are found at a
//! cost that does not count.

use std::f64::consts::TAU;

use super::companion::{Asked, fastest, lifted};
use super::estimate::Estimate;
use super::few::Few;
use super::linear::{FrictionTerms, Linear};
use super::outcome::{FrictionMap, MapRow};
use super::quadratic::{Eigen, UNSTABLE_GROWTH, residuals};
use super::real::lowest;
use super::reduced::{Reduced, images};
use super::shifted::Shifted;
use crate::linear::Complex;
use crate::math::vector::norm;
use crate::modal::companion;
use crate::model::modal::{MapOver, MapPlan};
use crate::number::digits;
use crate::tolerance::NEGLIGIBLE;

/// Rounds in which what modes leave open is added, at most.
const ROUNDS: usize = 40;

/// So many critical factors are told in notes.
const TOLD_FACTORS: usize = 4;

/// Companion forms above this size are worth a smaller space.
const MANY: usize = 160;

/// What modes between those of which a smaller space is made may leave open in the larger one: a tenth of what the larger one leaves open itself.
const LEFT_OPEN: f64 = 0.1 * NEGLIGIBLE;
/// Part of a mode that counts as new beside others, so that what a space of them lacks is less than may be left open.
const NEW_PART: f64 = 0.1 * LEFT_OPEN;

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
    fn rub(&self) -> FrictionTerms<'_> {
        let linear = self.rubbed.as_ref().unwrap_or(self.shifted.linear);
        FrictionTerms {
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

/// The space in which modes of least frequency are found at factors between these; `found`: those of the state.
pub(crate) fn space(
    over: &mut Over,
    asked: Asked,
    found: &[Eigen],
    tried: &[f64],
    solves: &mut usize,
) -> (Reduced, Estimate) {
    let shifted = over.shifted;
    let linear = shifted.linear;
    let count = asked.0;
    let modes = lowest(shifted, (count + 8).min(linear.free()), f64::INFINITY);
    *solves += modes.solves;
    let pace = modes.values.get(count / 2).map_or(1.0, |v| v.abs().sqrt());
    let pace = if pace > 0.0 { pace } else { 1.0 };
    let damped = |x: &[f64]| linear.damped(x);
    let mut reduced = Reduced::new(shifted, pace);
    let mut block = reduced.grow(shifted, &damped, modes.vectors);
    let own = found.iter().flat_map(|mode| mode.vector.iter().cloned());
    block.extend(reduced.grow(shifted, &damped, own.collect()));
    let images = images(shifted, &block, solves);
    reduced.grow(shifted, &damped, images);
    let mut estimate = Estimate::new(shifted, solves);
    // Modes may leave a negligible part of the equations of all dofs open. Eigenvalues are better by what left vectors, which the space does not contain, have beside it.
    // More displacements leave less open: who was good is not asked again, and who was not is when nothing that is known is worse.
    let mut known = vec![f64::INFINITY; tried.len()];
    for _ in 0..ROUNDS {
        estimate.take(&reduced);
        let worst = (0..tried.len()).max_by(|a, b| known[*a].total_cmp(&known[*b]));
        let Some(worst) = worst.filter(|k| known[*k] > NEGLIGIBLE) else {
            break;
        };
        over.set(tried[worst], &mut reduced);
        let modes = companion::eigen(&reduced, asked);
        let open = estimate.open(&reduced, over.rub(), &modes);
        known[worst] = largest(&open);
        let bad = modes
            .into_iter()
            .zip(open)
            .filter(|(_, open)| open.is_nan() || *open > NEGLIGIBLE);
        let bad = lifted(&reduced.basis, bad.map(|(mode, _)| mode).collect());
        let (_, rests) = residuals(shifted, &bad, over.rub(), solves);
        if !rests.is_empty() && reduced.grow(shifted, &damped, rests).is_empty() {
            break;
        }
    }
    estimate.take(&reduced);
    (reduced, estimate)
}

fn largest(all: &[f64]) -> f64 {
    all.iter().copied().fold(0.0, f64::max)
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
            few.add(&whole, &companion::eigen(&whole, asked), NEW_PART);
        }
        let mut untried = vec![[from, middle], [middle, to]];
        while let Some([from, to]) = untried.pop() {
            let known = few.len();
            // As many states as the larger space has displacements are few.
            if known > whole.basis.len() {
                return Space { whole, few: None };
            }
            let middle = 0.5 * (from + to);
            over.set(middle, &mut whole);
            few.take(&whole);
            let open = companion::open(&whole, &few.eigen(&whole, asked));
            if open.into_iter().all(|open| open <= LEFT_OPEN) {
                continue;
            }
            few.add(&whole, &companion::eigen(&whole, asked), NEW_PART);
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
            None => companion::values(&self.whole, asked),
        }
    }

    /// The same with vectors in the coordinates of the larger space.
    fn eigen(&self, asked: Asked) -> Vec<Eigen> {
        match &self.few {
            Some(few) => few.eigen(&self.whole, asked),
            None => companion::eigen(&self.whole, asked),
        }
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
    estimate: &Estimate,
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
    let mut rates = Vec::new();
    for &factor in &factors {
        space.set(over, factor);
        let modes = space.eigen(asked);
        let values: Vec<Complex> = modes.iter().map(|mode| mode.value).collect();
        map.rows.push(MapRow {
            factor,
            mu: over.mu(),
            modes: values.iter().map(|v| [v[1] / TAU, v[0]]).collect(),
            residual: largest(&estimate.open(&space.whole, over.rub(), &modes)),
        });
        rates.push(fastest(&values));
    }
    map.residual = worst(over, &mut space, &map.rows, asked, solves);
    for k in 1..factors.len() {
        let [before, now] = [k - 1, k].map(|k| grows(&rates[k], UNSTABLE_GROWTH));
        let ends = match (before, now) {
            (false, true) => [k - 1, k],
            // More friction is not expected to calm what has begun, and what a map is asked for is where it begins.
            (true, false) if plan.over != MapOver::Friction => [k, k - 1],
            _ => continue,
        };
        let value = rates[ends[1]];
        let ends = ends.map(|k| factors[k]);
        let found = lost(over, &mut space, ends, value, norm(&factors), asked);
        map.critical.push(found);
    }
    if linear.damping.is_some() && !map.critical.is_empty() && plan.over == MapOver::Friction {
        space.whole.damping.fill(0.0);
        let mut space = Space::new(over, space.whole, plan.range, asked);
        map.undamped = first_lost(over, &mut space, &factors, asked);
    }
    map
}

/// The largest residual in the equations of all dofs of the modes of the row that is estimated to be worst.
fn worst(
    over: &mut Over,
    space: &mut Space,
    rows: &[MapRow],
    asked: Asked,
    solves: &mut usize,
) -> f64 {
    let row = rows.iter().max_by(|a, b| a.residual.total_cmp(&b.residual));
    let Some(row) = row else { return 0.0 };
    space.set(over, row.factor);
    let modes = lifted(&space.whole.basis, space.eigen(asked));
    let (open, _) = residuals(over.shifted, &modes, over.rub(), solves);
    largest(&open)
}

/// Whether something grows by more than a part of its size.
fn grows(value: &Complex, limit: f64) -> bool {
    value[0] > limit * value[0].hypot(value[1])
}

/// The factor between one that is stable and one that is not at which stability is lost, with the frequency there. `value`: of the one that grows fastest at the second.
fn lost(
    over: &mut Over,
    space: &mut Space,
    [mut stable, mut unstable]: [f64; 2],
    mut value: Complex,
    largest: f64,
    asked: Asked,
) -> [f64; 2] {
    let mut at = |factor: f64| {
        space.set(over, factor);
        space.fastest(asked)
    };
    // A critical factor is known to this width, relative to the largest.
    while (unstable - stable).abs() > 1e-13 * largest {
        let middle = 0.5 * (stable + unstable);
        if middle == stable || middle == unstable {
            break;
        }
        let there = at(middle);
        match grows(&there, UNSTABLE_GROWTH) {
            true => (unstable, value) = (middle, there),
            false => stable = middle,
        }
    }
    // Without damping growth leaves zero with the root, and what is found is as near as rounding lets one see; with damping it goes through zero in
    // proportion to friction, and the straight line says where.
    // How far from a critical factor its slope is looked for, relative to the largest.
    let way = NEGLIGIBLE * largest * (unstable - stable).signum();
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
        match (before, grows(&value, UNSTABLE_GROWTH)) {
            (Some(stable), true) => {
                let ends = [stable, factor];
                return Some(lost(over, space, ends, value, norm(factors), asked)[0]);
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
    for [factor, frequency] in map.critical.iter().take(TOLD_FACTORS) {
        notes.push(match map.over == MapOver::Friction.name() {
            true => format!(
                "sliding becomes unstable at {factor:.6} times the friction of the step (mu {:.6}), with the frequency {frequency}",
                factor * map.mu,
                frequency = digits(frequency, 5),
            ),
            false => format!(
                "sliding is unstable {} {factor:.6} times the {} of the step, with the frequency {frequency}",
                side(map, *factor),
                map.over,
                frequency = digits(frequency, 5),
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
    // Above this residual a note says so.
    if map.residual > 1e-4 {
        notes.push(format!(
            "modes of the map leave the equations of all dofs open by {}: ask for a smaller range",
            digits(map.residual, 2)
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
            .any(|m| grows(&[m[1], TAU * m[0]], UNSTABLE_GROWTH))
    });
    if unstable { "above" } else { "below" }
}
