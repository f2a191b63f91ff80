//! The increment as a friction problem: where no iteration in the displacements leads to equilibrium, one in the forces may.
//!
//! The bulk is linear, so that what points do to each other is an operator `W = B K⁻¹ Bᵀ`, and what they would do without forces a free motion `q`
//! ([`crate::friction`]). A point that yields brings its compliance along, on the diagonal. Bodies that nothing holds but contact are held softly where they are,
//! and let go again: each solution is where the next one holds them (a proximal term, as that of anchors). The laws are those of the points at the
//! last solution, linearised; Newton's method has the last word, with the laws themselves.
//!
//! Its unknowns are all points that are or may come to be pressed. Where a solution for each of them costs more than another attempt would, they are those
//! that do not settle, and the others surround them as they are.

mod account;
mod place;

use super::attempt::Attempt;
use super::balance::transfer;
use super::equilibrium::{equilibrium, stalled};
use super::progress::Converged;
use super::rounds::rounds;
use super::settings::Settings;
use crate::friction::{FrictionProblem, solve};
use crate::math::vector::dot;
use crate::system::{Assembler, Cause, ContactBlock, Stage, StepFailure};
pub(super) use account::Account;
use account::ERROR;
use place::{At, Found, Place};

/// Most unknowns of a friction problem: solvers take their cube.
const MOST_UNKNOWNS: usize = 900;

/// Stiffness by which a point is held where it is, relative to that of the body beneath: that of anchors.
const HOLD: f64 = 1e-3;

/// Residual to which the columns of the operator are solved.
const COLUMN: f64 = 1e-9;

/// Change of the forces from one problem to the next, relative to their size, that counts as none.
const SETTLED: f64 = 1e-6;

/// What is known of points from the attempt that failed.
struct Points {
    /// Those that kept changing.
    restless: Vec<At>,
    /// Whether bodies are held by nothing else.
    loose: bool,
}

/// Equilibria by friction problems, one after the other as [`rounds`] asks for them, where Newton's method has failed for some cause; `None` where it is not
/// for them.
pub(super) fn in_forces(
    attempt: &mut Attempt,
    cause: &Cause,
    account: &mut Account,
) -> Option<Result<Converged, StepFailure>> {
    let points = Points {
        restless: attempt.system.chattering(),
        loose: *cause == Cause::Singular || attempt.system.patience() > 0,
    };
    attempt.restart();
    match settle(attempt, &points, account) {
        Ok(true) => {}
        Ok(false) => return None,
        Err(failure) => return Some(Err(failure)),
    }
    Some(rounds(attempt, |attempt, round| {
        if round > 0 {
            settle(attempt, &points, account)?;
        }
        equilibrium(attempt, round)
    }))
}

/// Solves friction problems until the forces settle; whether there are any.
fn settle(
    attempt: &mut Attempt,
    points: &Points,
    account: &mut Account,
) -> Result<bool, StepFailure> {
    let (mut before, mut last): (Vec<Found>, Vec<Found>) = Default::default();
    let mut done = false;
    let mut residuals = Vec::new();
    let mut relaxation = Relaxation::default();
    while residuals.len() < attempt.settings.max_iterations && !stalled(&residuals) {
        let Some(pass) = Pass::new(attempt)? else {
            return Ok(false);
        };
        residuals.push(pass.residual);
        done = pass.residual <= 1.0;
        if done {
            break;
        }
        let Some(next) = pass.solve((points, &last), &mut relaxation, account)? else {
            return Ok(false);
        };
        done = settled(&last, &next);
        before = std::mem::replace(&mut last, next);
        if done {
            break;
        }
    }
    account.row(done, (&before, &last));
    Ok(true)
}

/// How much of a step from one solution to the next is taken, where surfaces and laws make them go to and fro or creep: Aitken's relaxation
/// ([Küttler and Wall 2008](stickslip_base::references::kuettler_2008)), which at most doubles from step to step.
#[derive(Debug)]
struct Relaxation {
    length: f64,
    last: Option<Vec<f64>>,
}

impl Default for Relaxation {
    fn default() -> Self {
        Self {
            length: 1.0,
            last: None,
        }
    }
}

impl Relaxation {
    /// The part of this step that is taken.
    fn length(&mut self, du: &[f64]) -> f64 {
        if let Some(last) = &self.last {
            let change: Vec<f64> = du.iter().zip(last).map(|(now, then)| now - then).collect();
            let length = -self.length * dot(last, &change) / dot(&change, &change);
            self.length = if length > 0.0 {
                length.min(2.0 * self.length)
            } else {
                1.0
            };
        }
        self.last = Some(du.to_vec());
        self.length
    }
}

/// Whether forces are those of the problem before.
fn settled(last: &[Found], next: &[Found]) -> bool {
    let same = last.len() == next.len() && last.iter().zip(next).all(|(a, b)| a.0 == b.0);
    let size = next
        .iter()
        .flat_map(|(_, f)| f)
        .fold(0.0_f64, |m, f| m.max(f.abs()));
    let changes = last
        .iter()
        .zip(next)
        .flat_map(|(a, b)| (0..3).map(|q| (a.1[q] - b.1[q]).abs()));
    same && changes.fold(0.0, f64::max) <= SETTLED * size
}

/// The linear problem of one pass.
struct Linear<'a, 'b, 's> {
    attempt: &'a mut Attempt<'b, 's>,
    /// Forces and tangents of all that is no unknown, and of what holds points where they are.
    held: Assembler,
    /// Forces of the bulk at the iterate.
    rest: Vec<f64>,
}

impl Linear<'_, '_, '_> {
    /// The displacements under forces by dof.
    fn displacements(&mut self, b: &[f64]) -> Result<Vec<f64>, StepFailure> {
        if (self.attempt.interrupted)() {
            return Err(StepFailure::new(Cause::Interrupted, "interrupted"));
        }
        let system = &mut *self.attempt.system;
        let fixed = system.bulk.fixed();
        let free: Vec<f64> = b
            .iter()
            .zip(fixed)
            .map(|(b, fixed)| if *fixed { 0.0 } else { *b })
            .collect();
        let mut du = vec![0.0; b.len()];
        // As accurate as rounding lets it be: what holds points is soft, and would make much of what is left.
        let settings = Settings {
            linear_tolerance: COLUMN,
            ..self.attempt.settings
        };
        let effort = (&settings, &mut *self.attempt.statistics);
        system
            .bulk
            .solve(&self.held, &free, COLUMN, &mut du, effort)?;
        system.links.impose(&mut du);
        Ok(du)
    }

    /// What is out of balance without the unknowns.
    fn unbalanced(&self) -> Vec<f64> {
        let both = self.rest.iter().zip(&self.held.residual);
        both.map(|(a, b)| -(a + b)).collect()
    }
}

/// The increment at an iterate.
struct Pass<'a, 'b, 's> {
    linear: Linear<'a, 'b, 's>,
    places: Vec<Place>,
    /// Points by force.
    counts: Vec<Option<usize>>,
    /// The larger residual of displacements and multipliers, relative to what counts as none.
    residual: f64,
}

impl<'a, 'b, 's> Pass<'a, 'b, 's> {
    /// Asks the forces for their points, and linearises those that have none.
    fn new(attempt: &'a mut Attempt<'b, 's>) -> Result<Option<Self>, StepFailure> {
        let n = attempt.at.u.len();
        let mut out = assembler(attempt, n);
        let balance = attempt.evaluate(&mut out, true)?;
        let target = balance.target(attempt.settings.tolerance);
        let residual = balance.norm.max(out.multiplier_residual) / target.max(f64::MIN_POSITIVE);
        let mut held = assembler(attempt, n);
        held.reset(true);
        let (places, counts) = places(attempt, &mut held)?;
        if places.is_empty() {
            return Ok(None);
        }
        held.couplings = out.couplings;
        held.pairs = out.pairs;
        for place in &places {
            place.hold(HOLD * place.alone.body, &mut held);
        }
        let mut rest = vec![0.0; n];
        attempt.system.bulk.forces(&attempt.at.u, &mut rest);
        Ok(Some(Pass {
            linear: Linear {
                attempt,
                held,
                rest,
            },
            places,
            counts,
            residual,
        }))
    }

    /// One friction problem, and the step to its solution: the forces of the unknowns. `None` where there is no problem, or it is too large.
    fn solve(
        self,
        (Points { restless, loose }, last): (&Points, &[Found]),
        relaxation: &mut Relaxation,
        account: &mut Account,
    ) -> Result<Option<Vec<Found>>, StepFailure> {
        let Pass {
            mut linear,
            places,
            counts,
            ..
        } = self;
        // Without friction a body that nothing else holds may lie anywhere along the surface, and only Newton's way leaves it where it is.
        if *loose && !places.iter().any(|p| p.alone.rubs) {
            return Ok(None);
        }
        let d = linear.attempt.system.dofs.dim.min(3);
        let mut free = linear.unbalanced();
        let mut alone = linear.displacements(&free)?;
        let Some((chosen, others)) = choose(&linear, &places, (restless, last), (d, &alone)) else {
            return Ok(None);
        };
        if !others.is_empty() {
            for place in &others {
                place.surround(&mut linear.held);
            }
            free = linear.unbalanced();
            alone = linear.displacements(&free)?;
        }
        let problem = problem(&mut linear, &chosen, (d, &alone))?;
        let known = |p: &Place| last.iter().find(|(at, _)| *at == p.at);
        let guess: Vec<f64> = chosen
            .iter()
            .flat_map(|p| known(p).map_or([0.0; 3], |(_, f)| *f).into_iter().take(d))
            .collect();
        let solution = solve(&problem, Some(&guess), ERROR);
        let points: Vec<At> = chosen.iter().map(|p| p.at).collect();
        account.note(problem, &points, &solution);
        if !solution.solved {
            let sentence = format!(
                "no solver ends the friction problem of {} points; its error is still {:.1e}",
                chosen.len(),
                solution.error
            );
            return Err(linear.attempt.failure(Cause::NotConverged, sentence));
        }
        let found: Vec<Found> = chosen
            .iter()
            .zip(solution.forces.chunks(d))
            .map(|(p, r)| (p.at, [0, 1, 2].map(|q| r.get(q).copied().unwrap_or(0.0))))
            .collect();
        let du = step(&mut linear, (&chosen, &found), free, relaxation)?;
        account.step(du.iter().fold(0.0, |m, u| f64::max(m, u.abs())));
        let carried: Vec<Found> = others.iter().map(|p| (p.at, p.carried(&du))).collect();
        adopt(linear.attempt, &counts, &[&found[..], &carried].concat());
        Ok(Some(found))
    }
}

/// An assembler that gets what the bulk wants to know of contact.
fn assembler(attempt: &Attempt, dofs: usize) -> Assembler {
    let mut out = Assembler::new(dofs);
    out.wants_surrogate = attempt.system.bulk.wants_surrogates();
    out.wants_pairs = attempt.system.bulk.wants_pairs();
    out
}

/// The points of all forces, and how many each force has; forces that have none write into the assembler.
fn places(
    attempt: &mut Attempt,
    held: &mut Assembler,
) -> Result<(Vec<Place>, Vec<Option<usize>>), StepFailure> {
    let Attempt {
        system, from, at, ..
    } = attempt;
    let stage = Stage {
        from,
        at,
        dt: at.t - from.t,
        rate: system.rate,
    };
    let (mut places, mut counts) = (Vec::new(), Vec::new());
    for (force, contact) in system.contact.iter_mut().enumerate() {
        let Some(points) = contact.alone(&stage) else {
            counts.push(None);
            contact.assemble(&stage, held)?;
            continue;
        };
        counts.push(Some(points.len()));
        let points = points.into_iter().enumerate();
        places.extend(points.filter_map(|(point, alone)| {
            let alone = alone?;
            let block = ContactBlock {
                dofs: alone.dofs.clone(),
                rows: alone.rows.clone(),
                change: alone.rows.clone(),
                ..ContactBlock::default()
            };
            let block = system.links.transform(&block).unwrap_or(block);
            let at = (force, point);
            Some(Place { at, alone, block })
        }));
    }
    transfer(system.links, held);
    Ok((places, counts))
}

/// Some of the points.
type Few<'p> = Vec<&'p Place>;

/// Which points are unknowns, and which surround them, where `alone` are the displacements without any; `None` where there are too many.
fn choose<'p>(
    linear: &Linear,
    places: &'p [Place],
    (restless, last): (&[At], &[Found]),
    (d, alone): (usize, &[f64]),
) -> Option<(Few<'p>, Few<'p>)> {
    let before = |p: &Place| last.iter().any(|(at, _)| *at == p.at);
    let touching = places.iter().filter(|p| p.approaches(alone) || before(p));
    let touching: Vec<&Place> = touching.collect();
    let Attempt {
        system, settings, ..
    } = &*linear.attempt;
    let solver = (MOST_UNKNOWNS as f64).powi(3);
    let most = system.bulk.affordable(settings, solver).min(MOST_UNKNOWNS);
    if touching.len() * d <= most {
        return Some((touching, Vec::new()));
    }
    let (chosen, others): (Vec<&Place>, Vec<&Place>) =
        (places.iter()).partition(|p| restless.contains(&p.at) || before(p));
    let fits = !chosen.is_empty() && chosen.len() * d <= most;
    fits.then_some((chosen, others))
}

/// The operator by columns, and the free motion.
fn problem(
    linear: &mut Linear,
    chosen: &[&Place],
    (d, alone): (usize, &[f64]),
) -> Result<FrictionProblem, StepFailure> {
    let size = chosen.len() * d;
    let mut operator = vec![0.0; size * size];
    let mut unit = vec![0.0; alone.len()];
    for (j, place) in chosen.iter().enumerate() {
        for q in 0..d {
            unit.fill(0.0);
            place.push(q, 1.0, &mut unit);
            let du = linear.displacements(&unit)?;
            for (i, other) in chosen.iter().enumerate() {
                for p in 0..d {
                    operator[(i * d + p) * size + j * d + q] = other.along(p, &du);
                }
            }
            operator[(j * d + q) * (size + 1)] += place.own(q);
        }
    }
    let free = chosen.iter().flat_map(|p| (0..d).map(|q| p.free(q, alone)));
    Ok(FrictionProblem {
        dimension: d,
        free: free.collect(),
        laws: chosen.iter().map(|p| p.law()).collect(),
        operator,
    })
}

/// Moves the iterate to where the forces take it; returns by how much.
fn step(
    linear: &mut Linear,
    (chosen, found): (&[&Place], &[Found]),
    free: Vec<f64>,
    relaxation: &mut Relaxation,
) -> Result<Vec<f64>, StepFailure> {
    let mut b = free;
    for (place, (_, forces)) in chosen.iter().zip(found) {
        for (q, &force) in forces.iter().enumerate() {
            place.push(q, force, &mut b);
        }
    }
    let du = linear.displacements(&b)?;
    let start = linear.attempt.at.u.clone();
    let attempt = &mut *linear.attempt;
    let length = relaxation.length(&du);
    attempt.system.advance(attempt.at, &start, &du, length);
    Ok(du)
}

/// Hands the forces back to those whose points have them.
fn adopt(attempt: &mut Attempt, counts: &[Option<usize>], found: &[Found]) {
    for (force, contact) in attempt.system.contact.iter_mut().enumerate() {
        let Some(count) = counts[force] else {
            continue;
        };
        let mut forces = vec![None; count];
        for ((_, point), f) in found.iter().filter(|(at, _)| at.0 == force) {
            forces[*point] = Some(*f);
        }
        contact.adopt(&forces);
    }
}
