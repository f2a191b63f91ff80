//! The linear system of one iteration on the candidates that contact touches.

use super::active::{Active, Placed};
use super::condensation::Condensation;
use super::gap_matrix::{self, GapMatrix};
use super::gap_space;
use super::preconditioner::{Factored, Preconditioner, SMALL};
use super::rows::{GapRows, Rows};
use super::tangent::{Precision, Spring, Tangent};
use crate::linear::{GmresSettings, gmres_inexact};
use crate::math::vector::norm;
use crate::newton::failure::{not_finite, not_reached};
use crate::newton::settings::Settings;
use crate::newton::statistics::Statistics;
use crate::system::{ContactBlock, StepFailure};
use crate::tolerance::NEGLIGIBLE;

/// Solves `(I + K W) y = …` for the forces at the dofs that interfaces touch.
///
/// GMRES with the exact tangent is preconditioned by an exact factor of the tangent of some iteration before, without the curvature of the
/// gaps: of a matrix with a row for every gap and slip, which is small. Where nothing curves that matrix is the system itself (`gap_space`).
#[derive(Debug, Default)]
pub struct ReducedSystem {
    active: Option<Active>,
    /// `None` as well where the last solution took too many iterations.
    preconditioner: Option<Preconditioner>,
    /// What the preconditioner was made of where it is made anew every time: the columns of a friction problem have the same.
    made_of: Vec<ContactBlock>,
    /// The points of the last solution whose gaps did not curve, by their gradients.
    seen: Vec<[u64; 2]>,
    /// The compliance of gaps and slips, while gradients stay.
    gaps: Option<GapMatrix>,
}

/// What a solution consists of.
#[derive(Debug)]
pub struct ReducedSolution {
    /// Forces at the candidates.
    pub forces: Vec<f64>,
    /// The displacements that they make.
    pub displacements: Vec<f64>,
    /// Krylov iterations.
    pub iterations: usize,
}

/// The finest tolerance of an iteration, and the coarsest.
const TOLERANCES: (f64, f64) = (1e-14, 0.1);

/// Gap rows up to which the factor is made anew every time.
pub(super) const SMALL_SYSTEM: usize = 240;

/// Most iterations with a fresh factor, and with one that could be made anew: times what is usual.
const MOST_WITH_FRESH_FACTOR: usize = 200;
const OVERTIME: usize = 2;

/// Iterations after which GMRES starts again.
const RESTART: usize = 60;

/// Where the factor of an attempt comes from.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Factor {
    /// From an iteration before.
    Kept,
    /// From this one.
    Fresh,
}

/// One attempt at the solution; those that cost less come first.
#[derive(Debug, Clone, Copy)]
struct Attempt {
    precision: Precision,
    factor: Factor,
}

impl Attempt {
    /// What is tried after a failure: a fresh factor, then nothing but double precision.
    fn next(self) -> Option<Attempt> {
        match self {
            Attempt {
                factor: Factor::Kept,
                precision,
            } => Some(Attempt {
                factor: Factor::Fresh,
                precision,
            }),
            Attempt {
                precision: Precision::Single,
                factor,
            } => Some(Attempt {
                precision: Precision::Double,
                factor,
            }),
            _ => None,
        }
    }

    fn gmres(self, tolerance: f64, patience: usize) -> GmresSettings {
        let max_iterations = match self.factor {
            Factor::Kept => OVERTIME * patience,
            Factor::Fresh => MOST_WITH_FRESH_FACTOR,
        };
        GmresSettings {
            tolerance,
            max_iterations,
            restart: max_iterations.min(RESTART),
        }
    }
}

/// What a [`ReducedSystem`] was made of: enough to make it again, with the same bits.
#[derive(Debug, Clone, Default, crate::keep::Keep)]
pub struct ReducedRecipe {
    active: Option<Vec<usize>>,
    factored: Option<Factored>,
    seen: Vec<[u64; 2]>,
    /// The points of the compliance of gaps and slips in their order.
    gaps: Option<Vec<Rows>>,
}

impl ReducedSystem {
    /// What it was made of.
    pub fn recipe(&self) -> ReducedRecipe {
        ReducedRecipe {
            active: self.active.as_ref().map(|a| a.list.clone()),
            factored: self.preconditioner.as_ref().map(Preconditioner::factored),
            seen: self.seen.clone(),
            gaps: self.gaps.as_ref().map(|gaps| gaps.rows().to_vec()),
        }
    }

    /// Makes it again.
    ///
    /// # Errors
    /// As when it was made first.
    pub fn again(recipe: ReducedRecipe, condensation: &Condensation) -> Result<Self, StepFailure> {
        let Some(list) = recipe.active else {
            return Ok(ReducedSystem::default());
        };
        let mut touched = vec![false; condensation.size()];
        for i in list {
            // A list of other bodies would be one of another problem.
            if let Some(touched) = touched.get_mut(i) {
                *touched = true;
            }
        }
        let active = Active::new(condensation, &touched);
        let springs = springs(condensation);
        let tangent = Tangent {
            condensation,
            active: &active,
            blocks: &[],
            springs: &springs,
        };
        let make = |factored| Preconditioner::again(factored, &tangent);
        let preconditioner = recipe.factored.map(make).transpose()?;
        let gaps = recipe.gaps.map(|rows| GapMatrix::of(rows, &tangent));
        Ok(ReducedSystem {
            active: Some(active),
            preconditioner,
            made_of: Vec::new(),
            seen: recipe.seen,
            gaps,
        })
    }

    /// Forgets everything: the bodies have changed.
    pub fn clear(&mut self) {
        *self = ReducedSystem::default();
    }

    /// Forgets what need not outlast an increment, so that one that goes on from a checkpoint makes what one that was not stopped makes.
    pub(super) fn begin(&mut self) {
        self.made_of.clear();
    }

    /// Finds the forces `ds` with `(I + K W) ds = b` on the candidates, `K` the tangent of the interfaces less that of the artificial springs, and
    /// the displacements `W ds`.
    pub fn solve(
        &mut self,
        condensation: &Condensation,
        blocks: &[ContactBlock],
        b: &[f64],
        tolerance: f64,
        settings: &Settings,
        statistics: &mut Statistics,
    ) -> Result<ReducedSolution, StepFailure> {
        let springs = springs(condensation);
        if blocks.is_empty() && springs.is_empty() {
            return Ok(ReducedSolution {
                forces: b.to_vec(),
                displacements: condensation.apply_compliance(b),
                iterations: 0,
            });
        }
        let touched = Active::touched(condensation, blocks);
        let suits = self.active.as_ref().is_some_and(|a| a.suits(&touched));
        if !suits {
            // Positions in the list tell points apart.
            self.active = None;
            self.gaps = None;
            self.seen.clear();
        }
        let tiny = 3 * blocks.len() + springs.len() <= SMALL_SYSTEM;
        let same = tiny && self.made_of == blocks;
        if !suits || (tiny && !same) {
            self.preconditioner = None;
        }
        if !same {
            self.made_of.clear();
            let known = if tiny { blocks } else { &[] };
            self.made_of.extend_from_slice(known);
        }
        let active = &*self
            .active
            .get_or_insert_with(|| Active::new(condensation, &touched));
        let placed: Vec<Placed> = blocks
            .iter()
            .map(|b| active.place(condensation, b))
            .collect();
        let tangent = Tangent {
            condensation,
            active,
            blocks: &placed,
            springs: &springs,
        };
        // K (W b) and what the springs make of b
        let u = tangent.displacement_under(b);
        let rhs = tangent.right_hand_side(&u, b);
        // The residual of this system is that of the forces themselves, which are much smaller where interfaces are stiff.
        let tolerance = (tolerance * norm(b) / norm(&rhs).max(f64::MIN_POSITIVE))
            .clamp(TOLERANCES.0, TOLERANCES.1);
        let (rows, count) = Rows::of(tangent.blocks);
        keep_gaps(&mut self.gaps, &mut self.seen, &rows, count, &tangent);
        let known = Known {
            displacements: &u,
            forces: &rhs,
            gaps: self.gaps.as_ref(),
        };
        let rows = GapRows { rows: &rows, count };
        let kept = &mut self.preconditioner;
        let (y, iterations) =
            solve_preconditioned(&tangent, rows, kept, known, tolerance, settings, statistics)?;
        let mut forces = b.to_vec();
        tangent.add_forces(&y, &mut forces);
        Ok(ReducedSolution {
            displacements: condensation.apply_compliance(&forces),
            forces,
            iterations,
        })
    }
}

/// The artificial springs of all parts that float.
fn springs(condensation: &Condensation) -> Vec<Spring<'_>> {
    let parts = condensation.parts.iter().zip(&condensation.starts);
    let floating = parts.filter_map(|(part, &start)| Some((start, part.floating.as_ref()?)));
    floating
        .flat_map(|(start, floating)| {
            let modes = floating.modes.iter().zip(&floating.products);
            modes.map(move |(mode, product)| Spring {
                start,
                sigma: floating.sigma,
                mode,
                product,
            })
        })
        .collect()
}

/// Keeps the compliance of gaps and slips while they are those of the solution before.
fn keep_gaps(
    gaps: &mut Option<GapMatrix>,
    seen: &mut Vec<[u64; 2]>,
    rows: &[Rows],
    count: usize,
    tangent: &Tangent,
) {
    let mut parts = tangent.condensation.parts.iter();
    let suits = count > SMALL_SYSTEM && gap_space::straight(tangent);
    if !suits || !parts.all(|part| part.compliance.is_here()) {
        *gaps = None;
        seen.clear();
        return;
    }
    let keys: Vec<[u64; 2]> = rows.iter().map(Rows::key).collect();
    *gaps = gap_matrix::hardly_change(&keys, seen).then(|| {
        let known = gaps.take().unwrap_or_default();
        known.with(rows, tangent)
    });
    *seen = keys;
}

/// What is known before the forces along gaps are.
struct Known<'a> {
    /// The displacements without them.
    displacements: &'a [f64],
    /// The right-hand side: forces on the active dofs.
    forces: &'a [f64],
    /// The compliance of gaps and slips, where it is kept.
    gaps: Option<&'a GapMatrix>,
}

/// Solves with the factor that was kept, or with a fresh one where that does not do; which is kept if it is good. Returns the solution and all
/// iterations.
fn solve_preconditioned(
    tangent: &Tangent,
    rows: GapRows,
    kept: &mut Option<Preconditioner>,
    known: Known,
    tolerance: f64,
    settings: &Settings,
    statistics: &mut Statistics,
) -> Result<(Vec<f64>, usize), StepFailure> {
    let Known {
        displacements: u,
        forces: rhs,
        gaps,
    } = known;
    let patience = settings.krylov_patience;
    // Where a body is almost unconstrained, single precision would not see what does. A preconditioner need not be exact.
    let coarse = match tangent.springs.is_empty() && tangent.active.len() > SMALL {
        true => Precision::Single,
        false => Precision::Double,
    };
    let mut attempt = Attempt {
        precision: coarse,
        factor: match kept {
            Some(_) => Factor::Kept,
            None => Factor::Fresh,
        },
    };
    let placed = gaps.and_then(|gaps| gaps.place(rows.rows));
    statistics.kept_gaps += usize::from(placed.is_some());
    let mut spent = 0;
    loop {
        let preconditioner = match kept {
            Some(preconditioner) => &*preconditioner,
            None => {
                statistics.reduced += 1;
                kept.insert(Preconditioner::of(tangent, rows, gaps)?)
            }
        };
        let asked = attempt.gmres(tolerance, patience);
        let in_gaps = gap_space::solve(
            tangent,
            preconditioner,
            rows,
            placed.as_ref(),
            u,
            attempt.precision,
            asked,
        );
        let (y, report) = in_gaps.unwrap_or_else(|| {
            let mut y = vec![0.0; rhs.len()];
            let report = gmres_inexact(
                &mut |v, out, error| tangent.apply(v, out, attempt.precision.within(error)),
                &mut |v| preconditioner.apply(tangent, v, coarse),
                rhs,
                &mut y,
                asked,
            );
            (y, report)
        });
        statistics.krylov += report.iterations;
        spent += report.iterations;
        if !report.relative_residual.is_finite() {
            return Err(not_finite());
        }
        // With a fresh factor and double precision what is left is rounding: whether it is too much shows in the forces.
        let last = attempt.next().is_none();
        let rounding = last && report.relative_residual <= NEGLIGIBLE;
        if report.converged || rounding {
            if report.iterations > patience {
                *kept = None;
            }
            return Ok((y, spent));
        }
        let Some(next) = attempt.next() else {
            return Err(not_reached(spent));
        };
        if next.factor != attempt.factor {
            *kept = None;
        }
        attempt = next;
    }
}
