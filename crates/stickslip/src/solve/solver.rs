//! The solver: matrix, factors and Newton's method, and the way in which increments are solved.

use super::inertia::{in_motion, times};
use super::iteration::{Iteration, Load, Task};
use std::sync::Arc;

use super::by_cells::{ByCells, linear_part, stiff, suffices};
use super::condenser::Condenser;
use super::floating_bodies::Floating;
use super::inertia::Inertia;
use super::pressed::Pressed;
use super::work::Seen;
use crate::body::model::{BodiesByCell, CorotatedBodies, LinearBodies};
use crate::contact::interface::Conditions;
use crate::linear::{BlockCsr, Digest, Engine, Matrix};
use crate::model::contact::Contact;
use crate::model::definition::{Model, Solution};
use crate::model::frame::{ContactMemory, Frame};
use crate::newton::condensed::{Identity, Library};
use crate::newton::{Converged, Factors, Newton, NonlinearBulk, SparseBulk};
use crate::system::{BodyModel, Deformed, State, StepFailure};

/// What solves increments: nothing in it is part of a result, and all of it can be made again.
pub(crate) struct Solver {
    /// Stiffness of bodies and springs; its entries may not be kept.
    pub stiffness: Arc<dyn Matrix>,
    /// Its diagonal.
    pub diagonal: Vec<f64>,
    /// The forces of bodies and springs.
    pub bodies: Arc<dyn BodyModel>,
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
    /// How many matrices of increments in motion there have been: no key is given twice.
    pub keys: u64,
    /// What holds for each interface in the increment at hand.
    pub conditions: Vec<Conditions>,
    /// Bodies that only contact can hold.
    pub floating: Floating,
    /// Iterations that have not been reported.
    pub seen: Seen,
    /// What a user should know.
    pub log: Log,
}

/// The key of factors of bodies that turn cell by cell: of numbers that no increment leaves to the next.
const TURNING_FACTOR_KEY: u64 = u64::MAX;

/// What the solver has to say.
#[derive(Debug, Default)]
pub(crate) struct Log {
    /// Notes that have not been reported.
    pub notes: Vec<String>,
    /// How systems are solved.
    pub method: &'static str,
    /// Why so.
    pub reason: String,
    /// The linear solver that factors condensed bodies.
    pub engine: Option<Arc<dyn Engine>>,
}

impl Solver {
    /// With the stiffness of the model, but for an analysis of explicit steps alone, and so many interfaces.
    pub fn new(model: &Model, interfaces: usize, library: Arc<Library>) -> Self {
        let identity = identity(model);
        let by_cells = ByCells::new(model, identity);
        let stiffness: Arc<dyn Matrix> = match suffices(model) {
            true => Arc::new(by_cells),
            false => library.stiffness(identity, || by_cells.make()),
        };
        Solver {
            diagonal: stiffness.diagonal(),
            bodies: body_model(model, &stiffness),
            stiffness,
            newton: Newton::new(model.solution.settings),
            method: match (
                model.solution.method,
                model.solution.engine.as_dyn().condenses(),
            ) {
                (Solution::Automatic, true) => Solution::Condensed,
                (method, _) => method,
            },
            factors: match model.solution.method {
                Solution::Multigrid => Factors::multigrid(model.places()),
                _ => Factors::default(),
            },
            condenser: Condenser::new(library),
            inertia: None,
            keys: 0,
            conditions: vec![Conditions::default(); interfaces],
            floating: Floating::default(),
            seen: Seen::default(),
            log: Log::default(),
        }
    }

    /// What interfaces and couplings know after the last accepted increment, where it has not been reported, too.
    pub fn contacts<'a>(&'a self, frame: &'a Frame) -> &'a Arc<ContactMemory> {
        let ahead = self.condenser.at_rest().and_then(|c| c.ahead.as_ref());
        ahead.unwrap_or(&frame.contacts)
    }

    /// Nothing moves any more: what was made of the masses goes.
    pub fn end_dynamics(&mut self) {
        if let Some(inertia) = self.inertia.take() {
            self.keys = inertia.keys();
        }
        self.condenser.drop_in_motion();
    }

    /// Makes the entries of the stiffness if they are not kept: somebody will ask for them.
    pub fn keep_stiffness(&mut self, model: &Model) {
        if self.stiffness.kept().is_err() {
            self.stiffness = Arc::new(self.stiffness.make());
            self.bodies = body_model(model, &self.stiffness);
        }
    }

    /// Strain energy of bodies and springs `[J]`.
    pub fn strain_energy(&self, u: &[f64]) -> f64 {
        let forces = &self.bodies.forces(u);
        self.bodies.energy(Deformed { u, forces })
    }

    /// Forces of Rayleigh damping at displacements and velocities, in motion `[N]`; zero where it does not act.
    pub fn damping_force(&self, acts: bool, u: &[f64], v: &[f64]) -> Vec<f64> {
        match &in_motion(&self.inertia).damping {
            Some(damping) if acts => self.bodies.damping(&|v| times(damping, v), u, v),
            _ => vec![0.0; v.len()],
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
        self.keep_stiffness(model);
        let fixed = task.constraints.fixed.clone();
        let (matrix, diagonal, key, external, origin) = match task.load {
            Load::External(external) => {
                let matrix = entries(&self.stiffness);
                (matrix, self.diagonal.as_slice(), 0, external, None)
            }
            Load::Known(origin) => {
                let (matrix, diagonal, key) = in_motion(&self.inertia).matrix();
                let none = vec![0.0; at.u.len()];
                (matrix, diagonal, key, none, Some(origin))
            }
        };
        let mut forces = contact.forces(task.contacts, &self.conditions);
        let forces = match origin {
            None => self.floating.with(forces.all()),
            Some(_) => forces.all(),
        };
        if let (Some(bodies), None) = (self.bodies.nonlinear(), &origin) {
            let pressed = Pressed::new(model, bodies, at.t, &task.from.u);
            let linearised = self.factors.of(TURNING_FACTOR_KEY);
            return Iteration {
                newton: &mut self.newton,
                seen: &mut self.seen,
                model,
                forces,
                bulk: &mut NonlinearBulk::new(
                    &pressed,
                    &self.diagonal,
                    external,
                    fixed,
                    linearised,
                ),
                rate: task.rate,
                frames: task.frames,
                stoppable: task.stoppable,
            }
            .solve(task.constraints, task.from, at);
        }
        let linearised = self.factors.of(key);
        Iteration {
            newton: &mut self.newton,
            seen: &mut self.seen,
            model,
            forces,
            bulk: &mut SparseBulk::new(matrix, diagonal, external, fixed, origin, linearised),
            rate: task.rate,
            frames: task.frames,
            stoppable: task.stoppable,
        }
        .solve(task.constraints, task.from, at)
    }
}

/// Bodies and springs by the formulation that the model asks for.
fn body_model(model: &Model, stiffness: &Arc<dyn Matrix>) -> Arc<dyn BodyModel> {
    if model.is_corotational() {
        let bodies = model.elastic().map(|b| &b.elastic);
        return Arc::new(BodiesByCell {
            linear: linear_part(model, entries(stiffness)),
            turning: bodies.filter(|e| e.is_corotational()).cloned().collect(),
        });
    }
    let stiffness = Arc::clone(stiffness);
    match model.corotations.is_empty() {
        true => Arc::new(LinearBodies { stiffness }),
        false => Arc::new(CorotatedBodies {
            stiffness,
            frames: Arc::clone(&model.corotations),
        }),
    }
}

/// The entries of a stiffness.
pub(crate) fn entries(stiffness: &Arc<dyn Matrix>) -> &BlockCsr {
    let kept = stiffness.kept();
    kept.expect("where entries are asked for, they were made before")
}

/// A digest of all that the stiffness is made of.
fn identity(model: &Model) -> Identity {
    let mut digest = Digest::of(model.dofs.points as u64);
    digest.floats(model.mesh.points.as_flattened());
    stiff(model).for_each(|body| body.elastic.mix(&mut digest));
    for link in model.links.all() {
        digest.bytes(format!("{link:?}").as_bytes());
    }
    for &(dof, k) in model.actions.springs.iter().flat_map(|s| s.entries()) {
        digest.word(dof as u64);
        digest.floats(&[k]);
    }
    Identity::of(&digest)
}
