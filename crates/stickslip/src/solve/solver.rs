//! The solver: matrix, factors and Newton's method, and the way in which increments are solved.

use super::inertia::in_motion;
use super::iteration::{Iteration, Load, Task};
use std::sync::Arc;

use super::condenser::Condenser;
use super::floating_bodies::Floating;
use super::inertia::Inertia;
use super::work::Seen;
use crate::linear::{BlockCsr, Digest, Engine};
use crate::model::contact::Contact;
use crate::model::definition::{Body, Model, Solution, Step};
use crate::newton::condensed::{Identity, Library};
use crate::newton::{Converged, Factors, Newton, SparseBulk};
use crate::system::{State, StepFailure};

/// What solves increments: nothing in it is part of a result, and all of it can be made again.
pub(crate) struct Solver {
    /// Stiffness of bodies and springs.
    pub stiffness: Arc<BlockCsr>,
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
    /// How many matrices of increments in motion there have been: no key is given twice.
    pub keys: u64,
    /// Bodies that only contact can hold.
    pub floating: Floating,
    /// Iterations that nobody has been told of.
    pub seen: Seen,
    /// What a user should know.
    pub log: Log,
}

/// What the solver has to say.
#[derive(Debug, Default)]
pub(crate) struct Log {
    /// Notes that nobody has been told of.
    pub notes: Vec<String>,
    /// How systems are solved.
    pub method: &'static str,
    /// Why so.
    pub reason: String,
    /// Who factors condensed bodies.
    pub engine: Option<Arc<dyn Engine>>,
}

impl Solver {
    /// With the stiffness of the model, but for an analysis of explicit steps alone.
    pub fn new(model: &Model, library: Arc<Library>) -> Self {
        let stiffness = library.stiffness(identity(model), || assembled(model));
        Solver {
            diagonal: stiffness.diagonal(),
            stiffness,
            newton: Newton::new(model.settings),
            method: match (model.method, model.engine.as_dyn().condenses()) {
                (Solution::Automatic, true) => Solution::Condensed,
                (method, _) => method,
            },
            factors: match model.method {
                Solution::Multigrid => Factors::multigrid(model.places()),
                _ => Factors::default(),
            },
            condenser: Condenser::new(library),
            inertia: None,
            keys: 0,
            floating: Floating::default(),
            seen: Seen::default(),
            log: Log::default(),
        }
    }

    /// Nothing moves any more: what was made of the masses goes.
    pub fn come_to_rest(&mut self) {
        if let Some(inertia) = self.inertia.take() {
            self.keys = inertia.keys();
        }
        self.condenser.drop_in_motion();
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
                let matrix = (&*self.stiffness, self.diagonal.as_slice());
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
}

/// The bodies whose matrix is needed: an explicit analysis needs none.
fn stiff(model: &Model) -> impl Iterator<Item = &Body> {
    let needed = !model.steps.iter().all(Step::is_explicit);
    model.elastic().filter(move |_| needed)
}

/// A digest of all that [`assembled`] makes a matrix of.
fn identity(model: &Model) -> Identity {
    let mut digest = Digest::of(model.dofs.points as u64);
    digest.floats(model.mesh.points.as_flattened());
    stiff(model).for_each(|body| body.elastic.mix(&mut digest));
    for link in model.links.all() {
        digest.bytes(format!("{link:?}").as_bytes());
    }
    for &(dof, k) in model.springs.iter().flat_map(|s| s.entries()) {
        digest.word(dof as u64);
        digest.floats(&[k]);
    }
    Identity::of(&digest)
}

/// The stiffness of bodies, rigid links and springs.
fn assembled(model: &Model) -> BlockCsr {
    let mut stiffness = BlockCsr::from_couplings(model.dofs.points, model.dofs.dim, &mut |visit| {
        stiff(model).for_each(|body| body.elastic.couplings(visit));
        for link in model.links.all() {
            visit(&[link.hidden, link.hidden + 1]);
        }
    });
    stiff(model).for_each(|body| body.elastic.stiffness(&mut stiffness));
    for &(dof, k) in model.springs.iter().flat_map(|s| s.entries()) {
        model.links.add_spring(&mut stiffness, dof, k);
    }
    stiffness
}
