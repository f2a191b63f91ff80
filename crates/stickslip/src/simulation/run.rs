use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Instant;

use super::condense::Condensed;
use super::doctor::Finding;
use super::dynamic::Motion;
use super::explicit::Explicit;
use super::inertia::strain_energy;
use super::loose::Loose;
use super::march::March;
use super::model::{Model, Solution, Step};
use super::pending::{Pending, Recovered};
use super::summary::{FallbackSummary, Phases, Summary};
use super::{diagnosis, doctor, history, quality};
use crate::body::Around;
use crate::error::{Error, RunError};
use crate::linear::BlockCsr;
use crate::newton::condensed::{Condensation, Library, ReducedSystem};
use crate::newton::{Factors, Newton, Progress};
use crate::system::{Cause, State, StepFailure, Tally};
use crate::time::Trial;

/// A model being run.
pub struct Simulation {
    /// What is simulated.
    pub model: Model,
    /// Last accepted state.
    pub state: State,
    /// Internal minus external forces at the last accepted state: reactions where supported.
    pub forces: Vec<f64>,
    /// Energies and counts so far.
    pub summary: Summary,
    pub(super) matrix: BlockCsr,
    pub(super) diagonal: Vec<f64>,
    pub(super) newton: Newton,
    pub(super) factors: Factors,
    /// Points that may come into contact, and how often they were too few.
    pub(super) kept: Option<Vec<bool>>,
    pub(super) widened: usize,
    /// Largest norm of the forces in play at any recovered increment.
    pub(super) largest_forces: f64,
    /// The dofs that are no unknowns for which condensing was found the cheapest.
    pub(super) decided: Option<Vec<bool>>,
    pub(super) notes: Vec<String>,
    /// Iterations of the last condensed attempt.
    pub(super) seen: Vec<Progress>,
    pub(super) condensed: Option<Condensed>,
    /// Condensed bodies of implicit increments, by the key of their matrix.
    pub(super) moving: Vec<(u64, Condensation, ReducedSystem)>,
    pub(super) pending: Vec<Pending>,
    pub(super) recovered: Option<Recovered>,
    pub(super) march: March,
    pub(super) library: Arc<Library>,
    /// What interfaces add to the residual, and the external forces, at the last accepted state.
    pub(super) contact: Vec<f64>,
    pub(super) load: Vec<f64>,
    /// Energy in couplings at the last accepted state.
    pub(super) coupled: f64,
    pub(super) motion: Option<Motion>,
    pub(super) explicit: Option<Explicit>,
    pub(super) previous: Option<(f64, Vec<f64>)>,
    pub(super) held: BTreeMap<String, Vec<f64>>,
    pub(super) released: Vec<(usize, f64)>,
    /// By probe; `None` at rigid bodies.
    pub(super) around: Vec<Option<Around>>,
    pub(super) step: usize,
    /// What interfaces did so far.
    pub(super) watches: Vec<doctor::Watch>,
    /// Bodies that no interface joins.
    pub(super) unjoined: doctor::Unjoined,
    /// Bodies that only contact can hold.
    pub(super) loose: Loose,
    pub(super) started: Instant,
}

/// What observers are told.
pub enum Event<'a> {
    /// A Newton iteration.
    Iteration(&'a Progress),
    /// An increment was accepted. What comes of it may be told later, with others.
    Accepted(&'a Advance),
    /// What came of an accepted increment: the history row.
    Increment(&'a history::Row),
    /// Something a user should know.
    Note(&'a str),
    /// What the doctor found in the model before the first step.
    Finding(&'a Finding),
    /// Fields are due at the state of the simulation.
    Output,
    /// An increment failed and will be tried again, smaller.
    Cutback(&'a Trial, &'a StepFailure),
    /// The run is over, well or not.
    End,
}

/// An accepted increment at a glance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Advance {
    /// Number of the increment in its step, and of the attempt.
    pub increment: usize,
    /// Attempts it took.
    pub attempt: usize,
    /// Newton iterations.
    pub iterations: usize,
    /// Its end `[s]`.
    pub time: f64,
    /// Final residual relative to the forces in play.
    pub residual: f64,
    /// Points by status.
    pub tally: Tally,
}

/// Looks on while a simulation runs.
pub trait Observer {
    /// Something happened. An error ends the run.
    fn see(&mut self, simulation: &Simulation, event: Event) -> Result<(), Error>;
}

impl Simulation {
    /// Assembles the bulk and checks the model's own consistency.
    pub fn new(model: Model) -> Result<Self, Error> {
        let library = Library::new(Library::small_limit());
        Simulation::with_library(model, Arc::new(library))
    }

    /// The same with the factors of other runs: bodies with the same matrix, unknowns and contact candidates are factored once. Results have the
    /// same bits, whoever made the factors.
    pub fn with_library(mut model: Model, library: Arc<Library>) -> Result<Self, Error> {
        let started = Instant::now();
        // An explicit analysis needs no matrix of the bodies.
        let assembled = !model.steps.iter().all(Step::is_explicit);
        let mut matrix =
            BlockCsr::from_couplings(model.dofs.points, model.dofs.dim, &mut |visit| {
                for body in model.elastic().filter(|_| assembled) {
                    body.elastic.couplings(visit);
                }
                for link in model.links.all() {
                    visit(&[link.hidden, link.hidden + 1]);
                }
            });
        for body in model.elastic().filter(|_| assembled) {
            body.elastic.stiffness(&mut matrix);
        }
        for &(dof, stiffness) in model.springs.iter().flat_map(|s| s.entries()) {
            model.links.add_spring(&mut matrix, dof, stiffness);
        }
        let n = model.dofs.count();
        let newton = Newton::new(model.settings);
        let mut u = vec![0.0; n];
        for &(dof, value) in model.initials.iter().flat_map(|i| &i.displacements) {
            u[dof] = value;
        }
        model.links.impose(&mut u);
        let around = model
            .probes
            .iter()
            .map(|probe| model.elastic().find_map(|b| b.elastic.around(probe.point)))
            .collect();
        let unjoined = doctor::Unjoined::new(&model, &u);
        let mut simulation = Simulation {
            around,
            unjoined,
            contact: vec![0.0; n],
            load: vec![0.0; n],
            coupled: 0.0,
            motion: None,
            explicit: None,
            state: State {
                t: model.steps.first().map_or(0.0, |s| s.start),
                u,
                ..State::default()
            },
            forces: vec![0.0; n],
            summary: Summary::new(&model),
            diagonal: matrix.diagonal(),
            matrix,
            newton,
            factors: match model.method {
                Solution::Multigrid => Factors::multigrid(model.places()),
                _ => Factors::default(),
            },
            kept: None,
            widened: 0,
            largest_forces: 0.0,
            decided: None,
            notes: std::mem::take(&mut model.notes),
            seen: Vec::new(),
            condensed: None,
            moving: Vec::new(),
            pending: Vec::new(),
            recovered: None,
            march: March::default(),
            library,
            previous: None,
            held: BTreeMap::new(),
            released: Vec::new(),
            step: 0,
            watches: vec![doctor::Watch::default(); model.interfaces.len()],
            loose: Loose::default(),
            started,
            model,
        };
        let State { t, u, .. } = &simulation.state;
        let strain =
            strain_energy(&simulation.matrix, u) + simulation.model.couplings.begin_analysis(*t, u);
        simulation.coupled = simulation.model.couplings.energy().stored;
        simulation.summary.energy.initial = strain;
        simulation.summary.energy.strain = strain;
        simulation.summary.energy_quality.limit = simulation.model.energy_limit;
        simulation.summary.energy_quality.met = true;
        simulation.summary.quality.gate = simulation.model.quality.gate;
        simulation.summary.quality.met = true;
        simulation.summary.phases.assemble = started.elapsed().as_secs_f64();
        Ok(simulation)
    }

    /// Runs all steps, or what is left of them.
    ///
    /// # Errors
    /// [`Error::Run`] if the analysis cannot go on, [`Error::Interrupted`] if it was asked to stop (see [`Simulation::set_interrupt`]), and
    /// what observers return. In each case the results so far stay, and the observers have seen [`Event::End`].
    pub fn run(&mut self, observers: &mut [&mut dyn Observer]) -> Result<(), Error> {
        while self.advance(observers)? {}
        Ok(())
    }

    /// What is to be said at the end, well or not.
    pub(super) fn close(
        &mut self,
        outcome: Result<bool, Error>,
        observers: &mut [&mut dyn Observer],
    ) -> Result<bool, Error> {
        let outcome = outcome.map_err(|e| match e {
            Error::Run(error) => Error::Run(self.conclude(error)),
            e => e,
        });
        self.summary.finish(
            &self.newton.statistics,
            self.elapsed(),
            outcome.as_ref().err(),
        );
        self.summary.artificial_energy = self.artificial_energy();
        self.summary.interfaces = quality::interfaces(self);
        if self.summary.completed {
            for finding in doctor::watched(self) {
                doctor::note(&mut self.summary.findings, finding);
            }
        }
        let limits = self.model.quality;
        self.judge_energy(&limits);
        self.tell_notes(observers)?;
        for observer in observers.iter_mut() {
            observer.see(self, Event::End)?;
        }
        outcome
    }

    /// A quasi-static step knows no velocities: what motion there was ends.
    pub(super) fn rest(&mut self) {
        let energy = &mut self.summary.energy;
        energy.numerical += energy.kinetic;
        energy.kinetic = 0.0;
        self.state.v.clear();
        self.state.a.clear();
        self.motion = None;
        self.explicit = None;
        for interface in &mut self.model.interfaces {
            interface.set_masses(&[]);
            self.summary.energy.initial += interface.use_springs(false);
        }
        self.summary.energy.initial += self.model.couplings.use_springs(false);
    }

    /// Takes note of what was tried beside plain iteration.
    pub(super) fn note_fallbacks(&mut self, step: &Step, trial: &Trial) {
        let summary = &mut self.summary;
        for tried in self.newton.fallbacks.drain(..) {
            let outcome = if tried.converged {
                "converged"
            } else {
                "failed"
            };
            // Once of each kind is enough for people; the list has them all.
            if summary.fallbacks.iter().all(|f| f.tried.kind != tried.kind) {
                self.notes.push(format!(
                    "{} after {:.6e}: plain iteration failed; {} {outcome} in {} iterations (`fallbacks` of the summary lists all of them)",
                    step.name, trial.from, tried.kind.name(), tried.iterations
                ));
            }
            if summary.fallbacks.len() < MOST_REASONS {
                summary.fallbacks.push(FallbackSummary {
                    step: step.name.clone(),
                    from: trial.from,
                    to: trial.to,
                    tried,
                });
            }
        }
    }

    /// Lets the doctor look at an attempt that failed.
    pub(super) fn examine(
        &mut self,
        trial: &Trial,
        (attempt, chart): (usize, doctor::Chart),
        failure: &StepFailure,
    ) {
        if failure.cause != Cause::Event {
            let finding = doctor::diagnose(self, (trial, attempt, chart), failure);
            doctor::note(&mut self.summary.findings, finding);
        }
    }

    /// Sees to it that there is a finding about what ended the run; the error says the same.
    pub(super) fn conclude(&mut self, error: RunError) -> RunError {
        let findings = &self.summary.findings;
        if findings
            .iter()
            .any(|f| f.severity >= doctor::Severity::Error)
        {
            return error;
        }
        let finding = doctor::stopped(self, &error);
        let error = match finding.cause.is_mistake() {
            true => doctor::mistake(&finding, error.time),
            false => error,
        };
        doctor::note(&mut self.summary.findings, finding);
        error
    }

    /// Takes note of an attempt that failed.
    pub(super) fn reject(&mut self, step: &Step, trial: &Trial, failure: &StepFailure) {
        // What the last increment did is no guide any more.
        self.forget_direction();
        let summary = &mut self.summary;
        if failure.cause == Cause::Event {
            summary.events += 1;
            return;
        }
        summary.cutbacks += 1;
        if summary.cutback_reasons.len() < MOST_REASONS {
            summary.cutback_reasons.push(format!(
                "{} ({:.6e} to {:.6e}): {}",
                step.name, trial.from, trial.to, failure.message
            ));
        }
    }

    pub(super) fn give_up(&mut self, failure: StepFailure, trial: &Trial) -> RunError {
        if let Some(finding) = self.summary.findings.last_mut() {
            finding.severity = doctor::Severity::Error;
            if finding.cause.is_mistake() {
                return doctor::mistake(finding, self.state.t);
            }
        }
        if failure.cause == Cause::Singular {
            let free = self.explain_free(&failure, trial);
            return free.unwrap_or_else(|| diagnosis::explain_singular(self, &failure));
        }
        if failure.cause == Cause::Memory {
            let help = Some(doctor::MORE_MEMORY.to_string());
            return StepFailure { help, ..failure }.at(self.state.t);
        }
        let message = format!(
            "{}: {}; the increment cannot be made smaller",
            self.called(),
            failure.message
        );
        StepFailure { message, ..failure }.at(self.state.t)
    }

    /// Tells observers about iterations.
    pub(super) fn tell(&self, seen: &[Progress], observers: &mut [&mut dyn Observer]) {
        for p in seen {
            for observer in observers.iter_mut() {
                // An observer that cannot keep up with iterations does not stop the run.
                let _ = observer.see(self, Event::Iteration(p));
            }
        }
    }

    /// Refuses solutions that are too far from the last one.
    pub(super) fn check_change(&self, u: &[f64]) -> Result<(), StepFailure> {
        let pairs = u.iter().zip(&self.state.u);
        self.judge_change(pairs.fold(0.0_f64, |m, (a, b)| m.max((a - b).abs())))
    }

    /// Refuses displacement increments that are too large.
    pub(super) fn judge_change(&self, change: f64) -> Result<(), StepFailure> {
        if change > self.model.largest_change * self.model.mesh.diameter() {
            return Err(StepFailure::new(
                Cause::TooFar,
                format!(
                    "two successive solutions are {change:.3e} apart, more than `largest-change` allows"
                ),
            ));
        }
        Ok(())
    }

    /// Dofs that are prescribed at the time of the state, by dof.
    pub fn held_dofs(&self) -> Vec<bool> {
        self.constraints(self.state.t).fixed
    }

    /// What acts on the points from outside, by dof `[N]`: loads, reactions of supports, and equations. In equilibrium it is what bodies,
    /// springs and interfaces resist with.
    pub fn external_forces(&self) -> Vec<f64> {
        let both = self.forces.iter().zip(&self.load);
        let mut out: Vec<f64> = both.map(|(reaction, load)| reaction + load).collect();
        self.model.couplings.add_equation_forces(&mut out);
        out
    }

    /// What bodies, springs and interfaces resist with at the last accepted state, by dof `[N]`, without inertia and damping. At rest that is
    /// what acts from outside; in motion it is what CalculiX prints as `RF`.
    pub fn internal_forces(&self) -> Vec<f64> {
        let moves = self
            .model
            .steps
            .get(self.step)
            .is_some_and(|s| s.dynamic.is_some());
        let (mut out, contact): (Vec<f64>, &[f64]) = match (&self.explicit, &self.motion) {
            (Some(explicit), _) if moves => (explicit.force.clone(), &explicit.out.residual),
            (None, Some(motion)) if moves => (motion.internal.clone(), &self.contact),
            _ => return self.external_forces(),
        };
        out.iter_mut().zip(contact).for_each(|(out, c)| *out += c);
        // Equations act like contact and do not count as what resists.
        self.model.couplings.add_equation_forces(&mut out);
        out
    }

    /// The number of the point whose forces are farthest from balance, if any are.
    pub fn worst_point(&self) -> Option<u64> {
        let fixed = self.held_dofs();
        let dofs = self.model.dofs;
        let points = 0..self.model.mesh.points.len();
        let size = |p: usize| -> f64 {
            let free = (0..dofs.dim).map(|c| dofs.of(p, c)).filter(|&d| !fixed[d]);
            free.map(|d| self.forces[d].powi(2)).sum()
        };
        let worst = points
            .map(|p| (size(p), p))
            .max_by(|a, b| a.0.total_cmp(&b.0))?;
        (worst.0 > 0.0).then(|| self.model.mesh.point_ids[worst.1])
    }

    /// The step being run.
    pub fn step_name(&self) -> &str {
        self.model
            .steps
            .get(self.step)
            .map_or("", |s| s.name.as_str())
    }

    /// Index of the step being run.
    pub fn step_index(&self) -> usize {
        self.step
    }

    /// Seconds since the run started.
    pub fn elapsed(&self) -> f64 {
        self.started.elapsed().as_secs_f64()
    }

    /// Times of the phases so far.
    pub fn phases(&mut self) -> &mut Phases {
        &mut self.summary.phases
    }
}

/// Most reasons of cut-backs that the summary lists.
const MOST_REASONS: usize = 200;
