//! Weak springs that hold bodies which nothing else holds, and move on with them until they carry nothing.

use crate::math::{Vec3, add_scaled, distance, norm, sub};
use crate::mesh::Mesh;
use crate::system::{Assembler, Augmentation, Dofs, Energy, Force, Stage, StepFailure, Tangent};
use crate::tolerance::NEGLIGIBLE;

/// Anchors of unconstrained bodies.
///
/// After each equilibrium the anchors move to where the bodies have come, and another is sought: the proximal point method. Where
/// contact holds a body the anchors soon move no more; then they carry nothing, and have changed nothing. A motion that nothing resists
/// and no load drives stays where it is.
#[derive(Debug, Clone, crate::keep::Keep)]
pub struct Anchors {
    dofs: Dofs,
    groups: Vec<Group>,
    rounds: usize,
    /// Evaluations since the last round.
    evaluations: usize,
    /// The last rounds with anchors as stiff as now: where these were, and where the bodies came.
    past: Vec<[Vec<f64>; 2]>,
    /// An equilibrium took no iteration: what is left is too small to tell where the bodies go.
    near: bool,
    /// Bodies were still on their way after all rounds. Newton's method may begin again after that.
    unbalanced: bool,
    /// Norm of the other forces of contact at the last evaluation `[N]`.
    others: f64,
}

/// The anchors of one body.
#[derive(Debug, Clone, crate::keep::Keep)]
struct Group {
    points: Vec<usize>,
    /// Stiffness in each direction at a point `[N/m]`: now, to start with, and at least.
    stiffness: f64,
    first: f64,
    least: f64,
    /// Largest force that pushes bodies `[N]`; zero where none is known.
    force: f64,
    /// How far the body may move in one round, about `[m]`.
    max_step: f64,
    /// Displacements of the points at the start, those of the anchors, and those of the points at the last evaluation.
    start: Vec<Vec3>,
    at: Vec<Vec3>,
    now: Vec<Vec3>,
    /// By how much supports carry the points on from the start in the increment; empty where they do not.
    ahead: Vec<Vec3>,
}

/// What an anchor is made of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hold {
    /// A spring of the size of the bodies' own at a point of their surfaces `[N/m]`.
    pub spring: f64,
    /// Largest force that pushes bodies `[N]`.
    pub force: f64,
    /// How far the body may move in one round, about `[m]`.
    pub max_step: f64,
    /// Size of the cells at its surface `[m]`.
    pub size: f64,
    /// How often anchors proved too weak so far.
    pub firmness: usize,
}

/// Part of the way of a round that the load may move a body in the first, before anything is known of what resists: the points that touch
/// first must not be pressed in so deep that others seem to touch, too. With 0.06 the examples `lug` and `closing-gaps` take 197 iterations in
/// place of 215, keep their expected values, and tests of unconstrained bodies pass; with 0.006 the test
/// `what_slides_off_between_walls_rubs_all_the_way` fails.
const FIRST_WAY: f64 = 0.02;

/// Largest ratio by which anchors get weaker from one round to the next. With 3 and 30 the same examples take 214 and 205 iterations and keep their expected
/// values, and tests of unconstrained bodies pass.
const LARGEST_RELIEF: f64 = 10.0;

/// Least stiffness of all anchors of a body, over the force on it and the size of a cell. A body that is pressed into a seat or onto other
/// bodies can roll there. What resists is the force over a radius, and the tangent leaves that out: Newton's method contracts only if the
/// anchors are stiffer.
const ROLLING_STIFFNESS: f64 = 2.0;
/// Factor on the least stiffness each time it proves too weak. With 2.4 and 24 the same examples have the same digits; with 24 the
/// test `a_ball_falls_onto_three` fails.
const FIRMER: f64 = 8.0;

/// Evaluations in a round up to which anchors may get weaker.
const EASY_EVALUATIONS: usize = 7;
/// Evaluations in a round from which on anchors have to get stiffer.
const HARD_EVALUATIONS: usize = 14;

/// Rounds from which the place of the anchors is extrapolated.
const REMEMBERED_ROUNDS: usize = 6;

/// Force in the anchors of a body, relative to that on it, which is no more than the solver leaves out of balance elsewhere. It is the
/// default of `solver.tolerance`.
const NO_ANCHOR_FORCE: f64 = 1e-8;

/// Rounds in which a body has to come to rest.
const MOST_ANCHOR_ROUNDS: usize = 100;

impl Anchors {
    /// No anchors yet.
    pub fn new(dofs: Dofs) -> Self {
        Anchors {
            dofs,
            groups: Vec::new(),
            rounds: 0,
            evaluations: 0,
            past: Vec::new(),
            near: false,
            others: 0.0,
            unbalanced: false,
        }
    }

    /// Anchors a body at these points of the mesh, where they are at displacements `u`.
    pub fn hold(&mut self, points: Vec<usize>, u: &[f64], hold: Hold) {
        let here: Vec<Vec3> = points.iter().map(|&p| self.dofs.vector(u, p)).collect();
        let count = points.len().max(1) as f64;
        let rolling = ROLLING_STIFFNESS * FIRMER.powi(hold.firmness as i32) * hold.force
            / (count * hold.size);
        // An anchor starts with a thousandth of the stiffness of the bodies.
        let first = (1e-3 * hold.spring)
            .max(hold.force / (FIRST_WAY * count * hold.max_step))
            .max(rolling);
        self.groups.push(Group {
            points,
            stiffness: first,
            first,
            // An anchor has at least a millionth of the stiffness of the bodies.
            least: (1e-6 * hold.spring).max(rolling),
            force: hold.force,
            max_step: hold.max_step,
            start: here.clone(),
            at: here.clone(),
            now: here,
            ahead: Vec::new(),
        });
    }

    /// The points of the mesh that are anchored.
    pub fn points(&self) -> impl Iterator<Item = usize> + '_ {
        self.groups.iter().flat_map(|g| g.points.iter().copied())
    }

    /// Lets the anchors of the `k`-th body begin the increment where supports carry its points.
    pub fn begin_ahead(&mut self, k: usize, ahead: impl Fn(usize) -> Vec3) {
        let g = &mut self.groups[k];
        g.ahead = g.points.iter().map(|&p| ahead(p)).collect();
    }

    /// How far each body has moved since its anchors were laid, what supports carry it apart, as the largest displacement of an anchored point over what it may move
    /// in one round.
    pub fn travel(&self) -> f64 {
        let moved = self.groups.iter().flat_map(|g| {
            let pairs = g.first_place().into_iter().zip(&g.now);
            pairs.map(|(a, &b)| distance(a, b) / g.max_step)
        });
        moved.fold(0.0, f64::max)
    }

    /// Points of the `k`-th body and how far they have moved since their anchors were laid, what supports carry them apart.
    pub fn moved(&self, k: usize) -> Vec<(usize, Vec3)> {
        let g = &self.groups[k];
        let moved = g.first_place().into_iter().zip(&g.now);
        let moved = moved.map(|(a, &b)| sub(b, a));
        g.points.iter().copied().zip(moved).collect()
    }

    /// The next increment starts from where the bodies have come.
    pub fn rest(&mut self) {
        self.unbalanced = false;
        for g in &mut self.groups {
            g.start.clone_from(&g.now);
            g.at.clone_from(&g.now);
            g.ahead.clear();
        }
    }

    /// Whether the bodies were still on their way when the last attempt ended.
    pub fn unbalanced(&self) -> bool {
        self.unbalanced
    }

    /// Energy left in the springs `[J]`.
    pub fn left(&self) -> f64 {
        let of = |g: &Group| -> f64 {
            let pairs = g.now.iter().zip(&g.at);
            0.5 * g.stiffness * pairs.map(|(&a, &b)| distance(a, b).powi(2)).sum::<f64>()
        };
        self.groups.iter().map(of).sum()
    }
}

impl Group {
    /// Where the anchors begin.
    fn first_place(&self) -> Vec<Vec3> {
        let ahead = self
            .ahead
            .iter()
            .copied()
            .chain(std::iter::repeat([0.0; 3]));
        let start = self.start.iter().zip(ahead);
        start
            .map(|(&start, ahead)| add_scaled(start, 1.0, ahead))
            .collect()
    }

    /// Force in the springs relative to that on the body; where that is not known, to the `other` forces of contact. Where there are none either, the
    /// springs hold what nothing moves.
    fn carried(&self, others: f64) -> f64 {
        let pairs = self.now.iter().zip(&self.at);
        let away: f64 = pairs.map(|(&a, &b)| distance(a, b)).sum();
        let force = match self.force > 0.0 {
            true => self.force,
            false => others,
        };
        match away == 0.0 || force == 0.0 {
            true => 0.0,
            false => self.stiffness * away / force,
        }
    }
}

impl Anchors {
    /// Where the anchors are to be next: where the bodies would come to rest if what they did in the last rounds went on in the same way
    /// ([Anderson's](stickslip_base::references::anderson_1965) mixing); where they are now if nothing is known of that. Never further than the max_step from where they are.
    fn extrapolate(&mut self) -> Vec<Vec<Vec3>> {
        let flat = |part: fn(&Group) -> &[Vec3]| -> Vec<f64> {
            let all = self.groups.iter().flat_map(|g| part(g).iter().flatten());
            all.copied().collect()
        };
        let (at, now) = (flat(|g| &g.at), flat(|g| &g.now));
        let mut next = now.clone();
        if !self.near {
            let blur = (self.groups.iter()).map(|g| NO_ANCHOR_FORCE * g.force / g.stiffness);
            let blur = blur.fold(0.0, f64::max);
            mix(&self.past, &at, &now, blur, &mut next);
        }
        if self.past.len() == REMEMBERED_ROUNDS {
            self.past.remove(0);
        }
        self.past.push([at, now]);
        let mut rest = next.chunks_exact(3);
        let mut out = Vec::new();
        for g in &self.groups {
            let steps = g.now.iter().map(|&now| match rest.next() {
                Some(&[x, y, z]) => sub([x, y, z], now),
                _ => [0.0; 3],
            });
            let steps: Vec<Vec3> = steps.collect();
            let longest = steps.iter().map(|&s| norm(s)).fold(0.0, f64::max);
            let part = if longest > g.max_step {
                g.max_step / longest
            } else {
                1.0
            };
            let moved = g.now.iter().zip(&steps);
            out.push(moved.map(|(&x, &s)| add_scaled(x, part, s)).collect());
        }
        out
    }
}

/// Takes from `next`, which is `now`, what makes the residual `now - at` least, as far as the past tells; changes below `blur` tell
/// nothing.
fn mix(past: &[[Vec<f64>; 2]], at: &[f64], now: &[f64], blur: f64, next: &mut [f64]) {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let minus =
        |a: &[f64], b: &[f64]| -> Vec<f64> { a.iter().zip(b).map(|(a, b)| a - b).collect() };
    let mut left = minus(now, at);
    let mut basis: Vec<(Vec<f64>, Vec<f64>)> = Vec::new();
    for [at_then, now_then] in past.iter().rev() {
        let mut change = minus(&minus(now, at), &minus(now_then, at_then));
        let mut image = minus(now, now_then);
        let whole = dot(&change, &change).sqrt();
        for _ in 0..2 {
            for (q, moved) in &basis {
                let s = dot(q, &change);
                change.iter_mut().zip(q).for_each(|(c, q)| *c -= s * q);
                image.iter_mut().zip(moved).for_each(|(i, m)| *i -= s * m);
            }
        }
        let size = dot(&change, &change).sqrt();
        // A smaller part of a change between rounds says nothing new.
        if size <= blur.max(NEGLIGIBLE * whole) {
            continue;
        }
        change.iter_mut().for_each(|c| *c /= size);
        image.iter_mut().for_each(|i| *i /= size);
        basis.push((change, image));
    }
    for (q, moved) in &basis {
        let s = dot(q, &left);
        left.iter_mut().zip(q).for_each(|(l, q)| *l -= s * q);
        next.iter_mut().zip(moved).for_each(|(n, m)| *n -= s * m);
    }
}

impl Force for Anchors {
    fn begin(&mut self) {
        self.rounds = 0;
        self.evaluations = 0;
        self.past.clear();
        self.near = false;
        for g in &mut self.groups {
            g.stiffness = g.first;
            g.at = g.first_place();
            g.now.clone_from(&g.at);
        }
    }

    fn assemble(&mut self, stage: &Stage, out: &mut Assembler) -> Result<(), StepFailure> {
        self.evaluations += 1;
        self.others = out.residual.iter().map(|r| r * r).sum::<f64>().sqrt();
        let dim = self.dofs.dim;
        let mut unit = vec![0.0; 3 * dim];
        let mut square = vec![0.0; dim * dim];
        for c in 0..dim {
            unit[c * dim + c] = 1.0;
            square[c * dim + c] = 1.0;
        }
        for g in &mut self.groups {
            let change: Vec<f64> = unit.iter().map(|e| g.stiffness * e).collect();
            let surrogate: Vec<f64> = match out.wants_surrogate {
                true => square.iter().map(|e| g.stiffness * e).collect(),
                false => Vec::new(),
            };
            for ((&p, at), now) in g.points.iter().zip(&g.at).zip(&mut g.now) {
                *now = self.dofs.vector(&stage.at.u, p);
                let dofs: Vec<usize> = (0..dim).map(|c| self.dofs.of(p, c)).collect();
                let away = sub(*now, *at);
                let force: Vec<f64> = (0..dim).map(|c| g.stiffness * away[c]).collect();
                out.add_coupling(&dofs);
                out.add_residual(&dofs, &force);
                // what rounding leaves of displacements that are large
                let rounding = 4.0 * f64::EPSILON * g.stiffness * norm(*now);
                out.rounding += rounding * rounding;
                out.add_tangent(
                    &dofs,
                    Tangent {
                        rows: &unit,
                        change: &change,
                        area: 1.0,
                        hessian: &[],
                        surrogate: &surrogate,
                    },
                );
            }
        }
        Ok(())
    }

    fn augment(&mut self, _stage: &Stage) -> Augmentation {
        let mut worst: f64 = 0.0;
        let effort = self.evaluations;
        self.evaluations = 0;
        let carried = self.groups.iter().map(|g| g.carried(self.others));
        let carried = carried.fold(0.0, f64::max);
        if carried <= NO_ANCHOR_FORCE {
            return Augmentation::Done;
        }
        // From this force in the anchors on, relative to that on the body, they blur how it goes on.
        self.near |= effort <= 1 || carried <= 3e-8;
        let next = self.extrapolate();
        let mut changed = false;
        for (g, next) in self.groups.iter_mut().zip(next) {
            let pairs = g.now.iter().zip(&g.at);
            let away = pairs.map(|(&a, &b)| distance(a, b)).fold(0.0, f64::max);
            worst = worst.max(away / g.max_step);
            g.at = next;
            if away == 0.0 || self.near {
                continue;
            }
            // What is left of the force may move the body as far in the next round as all of it in the first.
            let relief = match effort {
                ..=EASY_EVALUATIONS => (g.max_step / away).clamp(1.0, LARGEST_RELIEF),
                // Anchors get stiffer by a factor of three.
                HARD_EVALUATIONS.. => 1.0 / 3.0,
                _ => 1.0,
            };
            let before = g.stiffness;
            g.stiffness = (before / relief).max(g.least.min(before));
            changed |= g.stiffness != before;
        }
        if changed {
            // It was another map from anchors to bodies.
            self.past.clear();
        }
        if worst == 0.0 {
            return Augmentation::Done;
        }
        self.rounds += 1;
        self.unbalanced |= self.rounds >= MOST_ANCHOR_ROUNDS;
        Augmentation::Again(worst)
    }

    fn patience(&self) -> usize {
        MOST_ANCHOR_ROUNDS
    }
}

impl Anchors {
    /// Energies at the last committed state.
    pub fn energy(&self) -> Energy {
        Energy {
            stored: self.left(),
            ..Energy::default()
        }
    }
}

/// Points that span a body: each the farthest from those before, the first the farthest from their centre.
pub fn spread(mesh: &Mesh, points: std::ops::Range<usize>, count: usize) -> Vec<usize> {
    let x = &mesh.points;
    let number = points.len().max(1) as f64;
    let centre = points
        .clone()
        .fold([0.0; 3], |s, p| add_scaled(s, 1.0 / number, x[p]));
    let mut away: Vec<f64> = points.clone().map(|p| distance(x[p], centre)).collect();
    let mut out = Vec::new();
    while out.len() < count.min(points.len()) {
        // The first of those that are about as far: the choice must not depend on rounding.
        let largest = away.iter().copied().fold(0.0, f64::max);
        let k = away.iter().position(|&d| d >= (1.0 - 1e-6) * largest);
        let p = points.start + k.unwrap_or(0);
        if out.is_empty() {
            away.fill(f64::INFINITY);
        }
        out.push(p);
        for (away, q) in away.iter_mut().zip(points.clone()) {
            *away = away.min(distance(x[p], x[q]));
        }
    }
    out
}
