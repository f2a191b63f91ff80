//! The increment as a friction problem: where no iteration in the displacements leads to equilibrium, one in the forces may.
//!
//! The bulk is linear, so that what points do to each other is an operator `W = B K⁻¹ Bᵀ`, and what they would do without forces a free motion `q`
//! ([`crate::friction`]). A point that yields brings its compliance along, on the diagonal. Bodies that nothing holds but contact are held softly where they are,
//! and let go again: each solution is where the next one holds them (a proximal term, as that of anchors). The laws are those of the points at the
//! last solution, linearised; Newton's method has the last word, with the laws themselves.

use super::attempt::Attempt;
use super::balance::transfer;
use super::progress::Converged;
use super::rounds::rounds;
use crate::friction::{FrictionProblem, PointLaw, solve};
use crate::system::{Assembler, Cause, ContactBlock, PointAlone, Stage, StepFailure, Tangent};

/// Most unknowns of a friction problem: its operator costs a solution each, and solvers their cube.
const MOST_UNKNOWNS: usize = 900;

/// Friction problems, each of them around the solution of the one before.
const PASSES: usize = 6;

/// Stiffness by which a point is held where it is, relative to that of the body beneath: that of anchors.
const HOLD: f64 = 1e-3;

/// Error to which friction problems are solved.
const ERROR: f64 = 1e-8;

/// Residual to which the columns of the operator are solved.
const COLUMN: f64 = 1e-9;

/// Change of the forces from one problem to the next, relative to their size, that counts as none.
const SETTLED: f64 = 1e-6;

/// Force and point, and what it carries.
type Found = ((usize, usize), [f64; 3]);

/// A point of one of the forces.
struct Place {
    force: usize,
    point: usize,
    alone: PointAlone,
    /// Gradients by the dofs of the bulk.
    block: ContactBlock,
}

/// Friction problems until the forces settle, then equilibrium from there; `None` where it is not for them. A problem that is not solved is kept.
pub(super) fn in_forces(
    attempt: &mut Attempt,
    unsolved: &mut Option<FrictionProblem>,
) -> Option<Result<Converged, StepFailure>> {
    if !attempt.system.bulk.answers_cheaply() {
        return None;
    }
    attempt.restart();
    let mut last: Vec<Found> = Vec::new();
    for _ in 0..PASSES {
        match pass(attempt, &last, unsolved) {
            Ok(Some(next)) => {
                let settled = settled(&last, &next);
                last = next;
                if settled {
                    break;
                }
            }
            Ok(None) => return None,
            Err(failure) => return Some(Err(failure)),
        }
    }
    Some(rounds(attempt))
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

/// What one pass works with.
struct Linear<'a, 'b, 's> {
    attempt: &'a mut Attempt<'b, 's>,
    /// Tangents of forces that are no points, and of what holds points where they are.
    held: Assembler,
}

impl Linear<'_, '_, '_> {
    /// The displacements under forces by dof.
    fn displacements(&mut self, b: &[f64]) -> Result<Vec<f64>, StepFailure> {
        let system = &mut *self.attempt.system;
        let fixed = system.bulk.fixed();
        let free: Vec<f64> = b
            .iter()
            .zip(fixed)
            .map(|(b, fixed)| if *fixed { 0.0 } else { *b })
            .collect();
        let mut du = vec![0.0; b.len()];
        let effort = (&self.attempt.settings, &mut *self.attempt.statistics);
        system
            .bulk
            .solve(&self.held, &free, COLUMN, &mut du, effort)?;
        system.links.impose(&mut du);
        Ok(du)
    }
}

/// One friction problem, and the step to its solution: the forces by force and point. `None` where there is none, or it is too large.
fn pass(
    attempt: &mut Attempt,
    last: &[Found],
    unsolved: &mut Option<FrictionProblem>,
) -> Result<Option<Vec<Found>>, StepFailure> {
    let n = attempt.at.u.len();
    let mut out = Assembler::new(n);
    out.wants_surrogate = false;
    attempt.evaluate(&mut out, true)?;
    let mut held = Assembler::new(n);
    held.wants_surrogate = false;
    held.reset(true);
    let Some((places, counts)) = places(attempt, &mut held)? else {
        return Ok(None);
    };
    // Without friction the other ways know all there is to know, and a body may lie anywhere along the surface.
    let rubs = |law: &PointLaw| law.mu > 0.0 || law.adhesion > 0.0;
    if !places.iter().any(|p| rubs(&p.alone.law)) {
        return Ok(None);
    }
    let mut rest = vec![0.0; n];
    attempt.system.bulk.forces(&attempt.at.u, &mut rest);
    let free: Vec<f64> = rest
        .iter()
        .zip(&held.residual)
        .map(|(a, b)| -(a + b))
        .collect();
    let mut linear = Linear { attempt, held };
    let alone = linear.displacements(&free)?;
    let chosen: Vec<&Place> = places
        .iter()
        .filter(|p| p.approaches(&alone) || last.iter().any(|(at, _)| *at == (p.force, p.point)))
        .collect();
    let d = linear.attempt.system.dofs.dim.min(3);
    if chosen.is_empty() || chosen.len() * d > MOST_UNKNOWNS {
        return Ok(None);
    }
    let problem = problem(&mut linear, &chosen, (d, &alone))?;
    let guess: Vec<f64> = chosen
        .iter()
        .flat_map(|p| {
            let known = last.iter().find(|(at, _)| *at == (p.force, p.point));
            let forces = known.map_or([0.0; 3], |(_, f)| *f);
            forces.into_iter().take(d).collect::<Vec<_>>()
        })
        .collect();
    let solution = solve(&problem, Some(&guess), ERROR);
    if !solution.solved {
        *unsolved = Some(problem);
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
        .map(|(p, r)| {
            let mut forces = [0.0; 3];
            forces[..d].copy_from_slice(r);
            ((p.force, p.point), forces)
        })
        .collect();
    *unsolved = Some(problem);
    step(&mut linear, (&chosen, &found), free)?;
    adopt(linear.attempt, &counts, &found);
    Ok(Some(found))
}

/// All points of all forces, those that are no points in the assembler, and points by force.
type Places = (Vec<Place>, Vec<Option<usize>>);

/// Asks the forces for their points; `held` gets the tangents of those that have none, and what holds points.
fn places(attempt: &mut Attempt, held: &mut Assembler) -> Result<Option<Places>, StepFailure> {
    let Attempt {
        system, from, at, ..
    } = attempt;
    let stage = Stage {
        from,
        at,
        dt: at.t - from.t,
        rate: system.rate,
    };
    let (mut all, mut counts) = (Vec::new(), Vec::new());
    for (force, contact) in system.contact.iter_mut().enumerate() {
        let Some(points) = contact.alone(&stage) else {
            counts.push(None);
            contact.assemble(&stage, held)?;
            continue;
        };
        counts.push(Some(points.len()));
        let points = points.into_iter().enumerate();
        all.extend(points.filter_map(|(point, alone)| Some((force, point, alone?))));
    }
    if all.is_empty() {
        return Ok(None);
    }
    let others = held.blocks.len();
    for (_, _, alone) in &all {
        held.add_tangent(
            &alone.dofs,
            Tangent {
                rows: &alone.rows,
                change: &alone.rows,
                area: HOLD * alone.body,
                hessian: &[],
                surrogate: &[],
            },
        );
    }
    transfer(system.links, held);
    let blocks = held.blocks[others..].to_vec();
    let places = all.into_iter().zip(blocks);
    let places = places.map(|((force, point, alone), block)| Place {
        force,
        point,
        alone,
        block,
    });
    Ok(Some((places.collect(), counts)))
}

impl Place {
    /// One of its gradients times displacements.
    fn along(&self, q: usize, du: &[f64]) -> f64 {
        let n = self.block.dofs.len();
        let row = &self.block.rows[q * n..(q + 1) * n];
        row.iter()
            .zip(&self.block.dofs)
            .map(|(b, &dof)| b * du[dof])
            .sum()
    }

    /// Adds a force along one of its gradients.
    fn push(&self, q: usize, force: f64, out: &mut [f64]) {
        let n = self.block.dofs.len();
        let row = &self.block.rows[q * n..(q + 1) * n];
        for (b, &dof) in row.iter().zip(&self.block.dofs) {
            out[dof] += force * b;
        }
    }

    /// Compliance of the point itself; where shear has none, that of the body, which does no harm where no shear is carried.
    fn own(&self, q: usize) -> f64 {
        match self.alone.stiffness[q] {
            k if k > 0.0 => 1.0 / k,
            _ => 1.0 / self.alone.body,
        }
    }

    /// Gap or slip that counts, under displacements and without forces.
    fn free(&self, q: usize, du: &[f64]) -> f64 {
        self.along(q, du) - self.own(q) * self.alone.forces[q]
    }

    /// Whether it would be pressed if it alone carried nothing.
    fn approaches(&self, alone: &[f64]) -> bool {
        self.free(0, alone) < 0.0 || self.alone.forces[0] > 0.0
    }

    /// The limit of its shear; none where nothing sticks.
    fn law(&self) -> PointLaw {
        let sticks = self.alone.stiffness[1] > 0.0;
        if sticks {
            self.alone.law
        } else {
            PointLaw::default()
        }
    }
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

/// Moves the iterate to where the forces take it.
fn step(
    linear: &mut Linear,
    (chosen, found): (&[&Place], &[Found]),
    free: Vec<f64>,
) -> Result<(), StepFailure> {
    let mut b = free;
    for (place, (_, forces)) in chosen.iter().zip(found) {
        for (q, &force) in forces.iter().enumerate() {
            place.push(q, force, &mut b);
        }
    }
    let du = linear.displacements(&b)?;
    let start = linear.attempt.at.u.clone();
    let attempt = &mut *linear.attempt;
    attempt.system.advance(attempt.at, &start, &du, 1.0);
    Ok(())
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
