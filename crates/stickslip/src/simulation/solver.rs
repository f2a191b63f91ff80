//! The solver: matrix, factors and Newton's method, and the way in which increments are solved.

use std::sync::Arc;

use super::condensed::Condenser;
use super::contact::Contact;
use super::floating::Floating;
use super::inertia::{Inertia, times};
use super::model::{Model, Solution, Step};
use crate::linear::BlockCsr;
use crate::math::vector::dot;
use crate::newton::condensed::Library;
use crate::newton::{Bulk, Converged, Factors, Newton, Origin, Progress, SparseBulk, System};
use crate::system::{Cause, Constraints, Force, Rate, State, StepFailure};

/// What solves increments: nothing in it is part of a result, and all of it can be made again.
pub(super) struct Solver {
    /// Stiffness of bodies and springs.
    pub stiffness: BlockCsr,
    /// Its diagonal.
    pub diagonal: Vec<f64>,
    /// Newton's method, with its counts.
    pub newton: Newton,
    /// How systems are solved; `Automatic` until it is known.
    pub method: Solution,
    /// Factors of sparse matrices, by their keys: 0 is the stiffness.
    pub factors: Factors,
    /// Bodies without their interiors.
    pub condenser: Condenser,
    /// Mass and damping, in implicit steps.
    pub inertia: Option<Inertia>,
    /// Bodies that only contact can hold.
    pub floating: Floating,
    /// Iterations that nobody has been told of.
    pub seen: Vec<Progress>,
    /// What a user should know.
    pub log: Log,
}

/// What the solver has to say.
#[derive(Debug, Default)]
pub(super) struct Log {
    /// Notes that nobody has been told of.
    pub notes: Vec<String>,
    /// How systems are solved.
    pub method: &'static str,
    /// Why so.
    pub reason: String,
}

/// The forces of the bulk in an increment.
pub(super) enum Load {
    /// Elastic forces, and these from outside.
    External(Vec<f64>),
    /// Those of an increment in motion, known at the guess; its matrix is the one that was made ready last.
    Known(Origin),
}

/// An increment to be solved.
pub(super) struct Task<'a> {
    /// The forces of the bulk.
    pub load: Load,
    /// Prescribed displacements at its end.
    pub constraints: Constraints,
    /// How velocities follow from displacements.
    pub rate: Option<Rate<'a>>,
    /// The state at its start.
    pub from: &'a State,
}

/// Newton's method on one system: where all increments are solved.
pub(super) struct Iteration<'a> {
    pub newton: &'a mut Newton,
    pub seen: &'a mut Vec<Progress>,
    pub model: &'a Model,
    pub forces: Vec<&'a mut dyn Force>,
    pub bulk: &'a mut dyn Bulk,
}

impl<'a> Iteration<'a> {
    /// Solves it. `at` is the guess before and the solution after.
    pub fn solve(
        self,
        constraints: Constraints,
        rate: Option<Rate<'a>>,
        (from, at): (&State, &mut State),
    ) -> Result<Converged, StepFailure> {
        let mut system = System {
            dofs: self.model.dofs,
            bulk: self.bulk,
            contact: self.forces,
            rate,
            constraints,
            links: &self.model.links,
        };
        let seen = self.seen;
        (self.newton).solve(&mut system, from, at, &mut |p| seen.push(*p))
    }
}

impl Solver {
    /// Assembles the stiffness of a model, but for an analysis of explicit steps alone.
    pub fn new(model: &Model, library: Arc<Library>) -> Self {
        // An explicit analysis needs no matrix of the bodies.
        let assembled = !model.steps.iter().all(Step::is_explicit);
        let mut stiffness =
            BlockCsr::from_couplings(model.dofs.points, model.dofs.dim, &mut |visit| {
                for body in model.elastic().filter(|_| assembled) {
                    body.elastic.couplings(visit);
                }
                for link in model.links.all() {
                    visit(&[link.hidden, link.hidden + 1]);
                }
            });
        for body in model.elastic().filter(|_| assembled) {
            body.elastic.stiffness(&mut stiffness);
        }
        for &(dof, k) in model.springs.iter().flat_map(|s| s.entries()) {
            model.links.add_spring(&mut stiffness, dof, k);
        }
        Solver {
            diagonal: stiffness.diagonal(),
            stiffness,
            newton: Newton::new(model.settings),
            method: model.method,
            factors: match model.method {
                Solution::Multigrid => Factors::multigrid(model.places()),
                _ => Factors::default(),
            },
            condenser: Condenser::new(library),
            inertia: None,
            floating: Floating::default(),
            seen: Vec::new(),
            log: Log::default(),
        }
    }

    /// Solves an increment with the sparse matrix. `at` is the guess before and the solution after.
    pub fn solve_sparse(
        &mut self,
        model: &Model,
        contact: &mut Contact,
        task: Task,
        at: &mut State,
    ) -> Result<Converged, StepFailure> {
        let fixed = task.constraints.fixed.clone();
        let (matrix, key, external, origin) = match task.load {
            Load::External(external) => {
                let matrix = (&self.stiffness, self.diagonal.as_slice());
                (matrix, 0, external, None)
            }
            Load::Known(origin) => {
                let (matrix, diagonal, key) = in_motion(&self.inertia).matrix();
                let none = vec![0.0; at.u.len()];
                ((matrix, diagonal), key, none, Some(origin))
            }
        };
        let forces = match origin {
            None => self.floating.with(contact.forces()),
            Some(_) => contact.forces(),
        };
        let linearised = self.factors.of(key);
        Iteration {
            newton: &mut self.newton,
            seen: &mut self.seen,
            model,
            forces,
            bulk: &mut SparseBulk::new(matrix, external, fixed, origin, linearised),
        }
        .solve(task.constraints, task.rate, (task.from, at))
    }

    /// Strain energy of bodies and springs `[J]`.
    pub fn strain_energy(&self, u: &[f64]) -> f64 {
        0.5 * dot(u, &times(&self.stiffness, u))
    }
}

/// What was made ready when a step in motion began.
pub(super) fn in_motion(inertia: &Option<Inertia>) -> &Inertia {
    (inertia.as_ref()).expect("a step in motion has begun with its masses")
}

/// Out-of-balance force relative to the forces in play that rounding may leave in a recovered interior.
const LEFT: f64 = 1e-6;

/// Forces that are none, relative to the largest there were in the analysis.
const NOTHING: f64 = 1e-8;

/// Roundings of stiffness times displacement that may be left.
const ROUNDINGS: f64 = 1e4;

/// The forces of an increment whose interior was found from that of its contact candidates.
pub(super) struct Recovered<'a> {
    /// Out of balance: what is left at free dofs, reactions at fixed ones `[N]`.
    pub forces: &'a [f64],
    /// Displacements `[m]`.
    pub u: &'a [f64],
    /// Diagonal of the matrix `[N/m]`.
    pub diagonal: &'a [f64],
    /// Prescribed dofs.
    pub fixed: &'a [bool],
    /// Sum of the squares of the forces of interfaces `[N²]`, and that of what else balances.
    pub contact: f64,
    pub others: f64,
}

impl Recovered<'_> {
    /// Refuses an interior that is not in balance: what is left at free dofs is compared with the largest of reactions, contact and what else
    /// balances, each as the root of its squares. `largest` is the largest of these in the analysis so far: where a path passes through the unloaded
    /// state, there is nothing but rounding in play.
    pub fn check(&self, tolerance: f64, largest: &mut f64) -> Result<(), StepFailure> {
        let (mut left, mut rounding, mut reactions) = (0.0, 0.0, 0.0_f64);
        for (i, f) in self.forces.iter().enumerate() {
            if self.fixed[i] {
                reactions += f * f;
            } else {
                left += f * f;
                rounding += (self.diagonal[i] * self.u[i]).powi(2);
            }
        }
        let size = reactions.max(self.contact).max(self.others).sqrt();
        let limit = ((10.0 * tolerance).max(LEFT) * size)
            .max(ROUNDINGS * f64::EPSILON * rounding.sqrt())
            .max(NOTHING * *largest);
        if left.sqrt() > limit || left.is_nan() {
            return Err(StepFailure::new(
                Cause::LinearSolver,
                format!(
                    "the recovered interior is not in balance: {:.1e} of the forces in play",
                    left.sqrt() / size
                ),
            )
            .help("set `solver.method = \"sparse\"`"));
        }
        // Forces of an attempt that is refused are none.
        *largest = largest.max(size);
        Ok(())
    }
}

/// Refuses displacement increments that are too large.
pub(super) fn check_change(
    model: &Model,
    pairs: impl Iterator<Item = (f64, f64)>,
) -> Result<(), StepFailure> {
    let change = pairs.fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
    if change > model.largest_change * model.mesh.diameter() {
        return Err(StepFailure::new(
            Cause::TooFar,
            format!(
                "two successive solutions are {change:.3e} apart, more than `largest-change` allows"
            ),
        ));
    }
    Ok(())
}

/// Refuses a solution with contact near points that do not take part.
pub(super) fn check_candidates(contact: &Contact) -> Result<(), StepFailure> {
    if contact.interfaces.iter().any(|i| i.spreads()) {
        return Err(StepFailure::new(
            Cause::Reach,
            "contact comes near to points that were not expected to be touched",
        ));
    }
    Ok(())
}
