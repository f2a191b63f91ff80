//! One friction problem: what of an increment are its unknowns, its solution, and the step there.

use super::account::Account;
use super::columns::{Columns, MOST_UNKNOWNS};
use super::linear::{COLUMN_RESIDUAL, Linear};
use super::place::{At, Found, Place};
use super::relaxation::Relaxation;
use super::search::search;
use crate::newton::attempt::Attempt;
use crate::newton::balance::transfer;
use crate::system::{Assembler, ContactBlock, Stage, StepFailure};

/// What is known of points from the attempt that failed.
pub(super) struct Points {
    /// Those that kept changing.
    pub restless: Vec<At>,
    /// Whether bodies are held by nothing else.
    pub loose: bool,
}

/// The increment at an iterate.
pub(super) struct Pass<'a, 'b, 's> {
    linear: Linear<'a, 'b, 's>,
    places: Vec<Place>,
    /// Points by force.
    counts: Vec<Option<usize>>,
    /// The larger residual of displacements and multipliers, relative to what counts as none.
    pub residual: f64,
}

impl<'a, 'b, 's> Pass<'a, 'b, 's> {
    /// Asks the forces for their points, and linearises those that have none.
    pub fn new(attempt: &'a mut Attempt<'b, 's>) -> Result<Option<Self>, StepFailure> {
        let n = attempt.at.u.len();
        let mut out = assembler(attempt, n);
        let balance = attempt.evaluate(&mut out, true)?;
        let target = balance.target(attempt.settings.tolerance);
        let residual = balance.with(out.multiplier_residual) / target.max(f64::MIN_POSITIVE);
        let mut held = assembler(attempt, n);
        held.reset(true);
        let (places, counts) = places(attempt, &mut held)?;
        if places.is_empty() {
            return Ok(None);
        }
        held.couplings = out.couplings;
        held.pairs = out.pairs;
        for place in &places {
            // A point is held where it is by the stiffness of an anchor, relative to that of the body beneath.
            place.hold(1e-3 * place.alone.body, &mut held);
        }
        let mut rest = vec![0.0; n];
        attempt.system.bulk.forces(&attempt.at.u, &mut rest);
        Ok(Some(Pass {
            linear: Linear {
                attempt,
                held,
                rest,
                tolerance: COLUMN_RESIDUAL,
            },
            places,
            counts,
            residual,
        }))
    }

    /// One friction problem, and the step to its solution: the forces of the unknowns. `None` where there is no problem, or it is too large.
    pub fn solve(
        self,
        Points { restless, loose }: &Points,
        last: &[Found],
        columns: &mut Columns,
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
        let d = linear.dimension();
        let mut free = linear.unbalanced();
        let mut alone = linear.displacements(&free)?;
        let Some((chosen, others)) = choose(&linear, &places, restless, last, d, &alone) else {
            return Ok(None);
        };
        if !others.is_empty() {
            for place in &others {
                place.surround(&mut linear.held);
            }
            free = linear.unbalanced();
            alone = linear.displacements(&free)?;
        }
        let (forces, du) = search(&mut linear, &chosen, free, alone, columns, account)?;
        let found: Vec<Found> = chosen
            .iter()
            .zip(forces.chunks(d))
            .map(|(p, r)| (p.at, [0, 1, 2].map(|q| r.get(q).copied().unwrap_or(0.0))))
            .collect();
        let start = linear.attempt.at.u.clone();
        let attempt = &mut *linear.attempt;
        let length = relaxation.length(&du);
        attempt.system.advance(attempt.at, &start, &du, length);
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
        frames: system.frames,
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
    restless: &[At],
    last: &[Found],
    d: usize,
    alone: &[f64],
) -> Option<(Few<'p>, Few<'p>)> {
    let before = |p: &Place| last.iter().any(|(at, _)| *at == p.at);
    let touching = places.iter().filter(|p| p.approaches(alone) || before(p));
    let touching: Vec<&Place> = touching.collect();
    let Attempt {
        system,
        settings,
        in_vain,
        ..
    } = &*linear.attempt;
    let solver = (MOST_UNKNOWNS as f64).powi(3);
    // As much again as has been spent without progress: that is never more than twice what the best choice would have cost.
    let most = system.bulk.affordable(settings, solver);
    let most = most.saturating_add(*in_vain).min(MOST_UNKNOWNS);
    if touching.len() * d <= most {
        return Some((touching, Vec::new()));
    }
    let (chosen, others): (Vec<&Place>, Vec<&Place>) =
        (places.iter()).partition(|p| restless.contains(&p.at) || before(p));
    let fits = !chosen.is_empty() && chosen.len() * d <= most;
    fits.then_some((chosen, others))
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
