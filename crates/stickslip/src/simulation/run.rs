use std::collections::BTreeMap;
use std::time::Instant;

use super::dynamic::Motion;
use super::explicit::Explicit;
use super::inertia::strain_energy;
use super::model::{Dynamic, Model, Step};
use super::summary::{Phases, Summary};
use super::{diagnosis, history, inertia};
use crate::error::{Error, RunError};
use crate::linear::BlockCsr;
use crate::newton::{Converged, Newton, Progress, System};
use crate::system::{Cause, Constraints, Force, Rate, Stage, State, StepFailure, Tally};
use crate::time::scheme::Method;
use crate::time::{Stepper, Trial};

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
    diagonal: Vec<f64>,
    pub(super) newton: Newton,
    /// What interfaces add to the residual, and the external forces, at the last accepted state.
    pub(super) contact: Vec<f64>,
    pub(super) load: Vec<f64>,
    pub(super) motion: Option<Motion>,
    pub(super) explicit: Option<Explicit>,
    previous: Option<(f64, Vec<f64>)>,
    held: BTreeMap<String, Vec<f64>>,
    released: Vec<(usize, f64)>,
    pub(super) step: usize,
    started: Instant,
}

/// What observers are told.
pub enum Event<'a> {
    /// A Newton iteration.
    Iteration(&'a Progress),
    /// An increment was accepted: the history row.
    Increment(&'a history::Row),
    /// Fields are due at the state of the simulation.
    Output,
    /// An increment failed and will be tried again, smaller.
    Cutback(&'a Trial, &'a StepFailure),
    /// The run is over, well or not.
    End,
}

/// Looks on while a simulation runs.
pub trait Observer {
    /// Something happened. An error ends the run.
    fn see(&mut self, simulation: &Simulation, event: Event) -> Result<(), Error>;
}

impl Simulation {
    /// Assembles the bulk and checks the model's own consistency.
    pub fn new(model: Model) -> Result<Self, Error> {
        let started = Instant::now();
        // An explicit analysis needs no matrix of the bodies.
        let explicit = |s: &Step| {
            matches!(
                s.dynamic,
                Some(Dynamic {
                    method: Method::Explicit { .. },
                    ..
                })
            )
        };
        let assembled = !model.steps.iter().all(explicit);
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
            let done = body.elastic.stiffness(&mut matrix);
            done.map_err(|e| e.at(0.0))?;
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
        let mut simulation = Simulation {
            contact: vec![0.0; n],
            load: vec![0.0; n],
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
            previous: None,
            held: BTreeMap::new(),
            released: Vec::new(),
            step: 0,
            started,
            model,
        };
        let strain = strain_energy(&simulation.matrix, &simulation.state.u);
        simulation.summary.energy.initial = strain;
        simulation.summary.energy.strain = strain;
        simulation.summary.energy_quality.limit = simulation.model.energy_limit;
        simulation.summary.energy_quality.met = true;
        simulation.summary.phases.assemble = started.elapsed().as_secs_f64();
        Ok(simulation)
    }

    /// Runs all steps.
    pub fn run(&mut self, observers: &mut [&mut dyn Observer]) -> Result<(), Error> {
        self.started = Instant::now();
        let outcome = self.run_steps(observers);
        self.summary.finish(
            &self.newton.statistics,
            self.started.elapsed().as_secs_f64(),
            outcome.as_ref().err(),
        );
        self.summary.interfaces = history::interfaces(self);
        for observer in observers.iter_mut() {
            observer.see(self, Event::End)?;
        }
        outcome
    }

    fn run_steps(&mut self, observers: &mut [&mut dyn Observer]) -> Result<(), Error> {
        for step in 0..self.model.steps.len() {
            self.step = step;
            self.begin_step();
            match self.model.steps[step].dynamic {
                Some(dynamic) => {
                    self.explicit = None;
                    for interface in &mut self.model.interfaces {
                        self.summary.energy.initial += interface.use_springs(false);
                    }
                    match dynamic.method {
                        Method::Implicit(_) => self.start_motion(&dynamic)?,
                        Method::Explicit { .. } => self.start_explicit(&dynamic)?,
                    }
                }
                None => self.rest(),
            }
            self.run_step(observers)?;
        }
        Ok(())
    }

    /// Remembers from where supports that begin to act start, and with which force those that end let go.
    fn begin_step(&mut self) {
        let step = &self.model.steps[self.step];
        let middle = 0.5 * (step.start + step.end);
        let before = self.step.checked_sub(1).map(|i| {
            let s = &self.model.steps[i];
            0.5 * (s.start + s.end)
        });
        let was = |s: &super::Support| before.is_some_and(|t| s.schedule.active(t));
        let mut supported = vec![false; self.state.u.len()];
        for support in &self.model.supports {
            if support.schedule.active(middle) {
                for e in &support.entries {
                    supported[e.dof] = true;
                }
                if !was(support) {
                    let start = support
                        .entries
                        .iter()
                        .map(|e| self.state.u[e.dof])
                        .collect();
                    self.held.insert(support.name.clone(), start);
                }
            }
        }
        self.previous = None;
        self.released.clear();
        if step.dynamic.is_some() {
            // In motion what lets go lets go at once.
            return;
        }
        let mut seen = vec![false; self.state.u.len()];
        for support in self.model.supports.iter().filter(|s| was(s)) {
            for e in &support.entries {
                if !supported[e.dof] && !seen[e.dof] {
                    seen[e.dof] = true;
                    self.released.push((e.dof, self.forces[e.dof]));
                }
            }
        }
    }

    /// A quasi-static step knows no velocities: what motion there was ends.
    fn rest(&mut self) {
        let energy = &mut self.summary.energy;
        energy.numerical += energy.kinetic;
        energy.kinetic = 0.0;
        self.state.v.clear();
        self.state.a.clear();
        self.motion = None;
        self.explicit = None;
        for interface in &mut self.model.interfaces {
            self.summary.energy.initial += interface.use_springs(false);
        }
    }

    fn run_step(&mut self, observers: &mut [&mut dyn Observer]) -> Result<(), Error> {
        let step = self.model.steps[self.step].clone();
        let mut stepper = Stepper::new(step.start, step.milestones.clone(), step.increments);
        if step.dynamic.is_some() {
            stepper = stepper.doubling();
        }
        let mut increment = 0;
        let mut attempt = 1;
        loop {
            if let Some(bound) = self.bound() {
                stepper.bound(bound);
            }
            let Some(trial) = stepper.next() else {
                break;
            };
            let outcome = match step.dynamic {
                None => self.attempt(trial, observers),
                Some(
                    dynamic @ Dynamic {
                        method: Method::Implicit(alphas),
                        ..
                    },
                ) => self.attempt_implicit(trial, &dynamic, alphas, observers),
                Some(_) => self.attempt_explicit(trial),
            };
            match outcome {
                Ok(accepted) => {
                    increment += 1;
                    let iterations = if accepted.hard {
                        usize::MAX
                    } else {
                        accepted.iterations
                    };
                    let effort = self.accept(trial, accepted);
                    stepper.accept(trial, iterations);
                    if step.milestones.contains(&trial.to) {
                        // Tables have their corners here.
                        self.previous = None;
                    }
                    let plan = &self.model.output;
                    let last = stepper.next().is_none();
                    let due = last
                        || plan.times.contains(&trial.to)
                        || (plan.every > 0 && increment % plan.every == 0);
                    if due || increment % plan.history_every == 0 {
                        let row = history::row(self, trial, effort, (increment, attempt));
                        let named = row.names.iter().cloned().zip(row.values.iter().copied());
                        self.summary.last = named.collect();
                        for observer in observers.iter_mut() {
                            observer.see(self, Event::Increment(&row))?;
                        }
                    }
                    attempt = 1;
                    if due {
                        for observer in observers.iter_mut() {
                            observer.see(self, Event::Output)?;
                        }
                    }
                }
                Err(failure) => {
                    attempt += 1;
                    self.reject(&step, &trial, &failure);
                    if !stepper.reject(trial) {
                        return Err(self.give_up(failure).into());
                    }
                    for observer in observers.iter_mut() {
                        observer.see(self, Event::Cutback(&trial, &failure))?;
                    }
                }
            }
        }
        Ok(())
    }

    /// Takes note of an attempt that failed.
    fn reject(&mut self, step: &Step, trial: &Trial, failure: &StepFailure) {
        // What the last increment did is no guide any more.
        self.previous = None;
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

    fn give_up(&self, failure: StepFailure) -> RunError {
        if failure.cause == Cause::Singular {
            let modes = diagnosis::free_modes(self, self.model.steps[self.step].end);
            return diagnosis::explain_singular(self, &failure, &modes);
        }
        let message = format!(
            "step {}: {}; the increment cannot be made smaller",
            self.model.steps[self.step].name, failure.message
        );
        StepFailure { message, ..failure }.at(self.state.t)
    }

    /// Constraints at a time.
    pub(super) fn constraints(&self, t: f64) -> Constraints {
        let mut constraints = Constraints::none(self.model.dofs);
        for support in &self.model.supports {
            if !support.schedule.active(t) {
                continue;
            }
            let s = support.schedule.at(t);
            let held = self.held.get(&support.name);
            for (i, e) in support.entries.iter().enumerate() {
                let start = held.and_then(|h| h.get(i)).copied().unwrap_or(0.0);
                let value = if e.hold {
                    start
                } else if support.table {
                    s * e.value
                } else {
                    start + s * (e.value - start)
                };
                constraints.prescribe(e.dof, value);
            }
        }
        self.model.links.dependent(&mut constraints.fixed);
        constraints
    }

    /// External forces at a time, with the fading forces of supports that let go in this step; those on the points of rigid bodies act on
    /// the bodies.
    pub(super) fn external(&self, t: f64) -> Vec<f64> {
        let mut external = vec![0.0; self.state.u.len()];
        for load in &self.model.loads {
            load.external(t, &mut external);
        }
        self.model.links.transfer(&mut external);
        let step = &self.model.steps[self.step];
        let left = (step.end - t) / (step.end - step.start);
        for &(dof, force) in &self.released {
            external[dof] += left * force;
        }
        external
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
        let change = pairs.fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
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

    /// Tries a quasi-static increment.
    fn attempt(
        &mut self,
        trial: Trial,
        observers: &mut [&mut dyn Observer],
    ) -> Result<Accepted, StepFailure> {
        let dt = trial.to - trial.from;
        let external = self.external(trial.to);
        let constraints = self.constraints(trial.to);
        let fixed = constraints.fixed.clone();
        let mut at = State {
            t: trial.to,
            u: self.state.u.clone(),
            ..State::default()
        };
        if let Some((before, u)) = &self.previous {
            // the last increment goes on
            let ratio = dt / before;
            for (a, (now, then)) in at.u.iter_mut().zip(self.state.u.iter().zip(u)) {
                *a = now + ratio * (now - then);
            }
        }
        let mut seen: Vec<Progress> = Vec::new();
        let converged = {
            let Simulation {
                model,
                newton,
                matrix,
                diagonal,
                state,
                ..
            } = self;
            let mut system = System {
                dofs: model.dofs,
                matrix,
                diagonal,
                external: external.clone(),
                rate: None,
                constraints,
                links: &model.links,
                origin: None,
                key: 0,
                contact: inertia::contact(&mut model.interfaces),
            };
            newton.solve(&mut system, state, &mut at, &mut |p| seen.push(*p))
        };
        self.tell(&seen, observers);
        let converged = converged?;
        self.check_change(&at.u)?;
        // Work of loads and reactions by the trapezoidal rule: exact for forces that vary linearly over the increment.
        let before = self.external(trial.from);
        let mut work = 0.0;
        for (i, (before, after)) in before.iter().zip(&external).enumerate() {
            work += 0.5 * (before + after) * (at.u[i] - self.state.u[i]);
        }
        for (i, _) in fixed.iter().enumerate().filter(|(_, fixed)| **fixed) {
            let mean = 0.5 * (self.forces[i] + converged.forces[i]);
            work += mean * (at.u[i] - self.state.u[i]);
        }
        Ok(Accepted {
            forces: converged.forces.clone(),
            contact: converged.contact.clone(),
            external,
            flow: Flow {
                work,
                ..Flow::default()
            },
            state: at,
            ..Accepted::from_newton(&converged)
        })
    }

    /// Makes an attempt the last accepted state.
    fn accept(&mut self, trial: Trial, accepted: Accepted) -> history::Effort {
        let effort = accepted.summary();
        let stage = Stage {
            from: &self.state,
            at: &accepted.state,
            dt: trial.to - trial.from,
            rate: accepted
                .rate
                .as_ref()
                .map(|(gain, shift)| Rate { gain, shift }),
        };
        for interface in &mut self.model.interfaces {
            interface.commit(&stage);
        }
        self.previous = Some((trial.to - trial.from, std::mem::take(&mut self.state.u)));
        self.state = accepted.state;
        self.forces = accepted.forces;
        self.contact = accepted.contact;
        self.load = accepted.external;
        let summary = &mut self.summary;
        summary.increments += 1;
        summary.iterations += effort.iterations;
        let turned = self.model.links.largest_rotation(&self.state.u);
        summary.largest_rotation = summary.largest_rotation.max(turned);
        let kinetic = match (&self.motion, accepted.kinetic) {
            (_, Some(kinetic)) => kinetic,
            (Some(motion), None) => motion.inertia.kinetic_energy(&self.state.v),
            (None, None) => 0.0,
        };
        let strain = accepted
            .strain
            .unwrap_or_else(|| strain_energy(&self.matrix, &self.state.u));
        let contact: Vec<_> = self.model.interfaces.iter().map(|i| i.energy()).collect();
        summary
            .energy
            .enter(accepted.flow, kinetic, strain, &contact);
        summary.energy_quality.note(&summary.energy);
        effort
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

/// Energy that flows over an increment.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Flow {
    /// Work of loads and reactions.
    pub work: f64,
    /// Dissipated by Rayleigh damping.
    pub damped: f64,
    /// Dissipated by the scheme.
    pub numerical: f64,
}

/// An increment that may be accepted.
#[derive(Default)]
pub(super) struct Accepted {
    pub state: State,
    /// Out-of-balance forces: reactions at fixed dofs.
    pub forces: Vec<f64>,
    pub contact: Vec<f64>,
    pub external: Vec<f64>,
    pub flow: Flow,
    pub rate: Option<(Vec<f64>, Vec<f64>)>,
    /// Energies, where the attempt knows them already.
    pub kinetic: Option<f64>,
    pub strain: Option<f64>,
    pub iterations: usize,
    pub rounds: usize,
    pub residual: f64,
    pub tally: Tally,
    /// The increment must not grow.
    pub hard: bool,
}

impl Accepted {
    pub(super) fn from_newton(converged: &Converged) -> Self {
        Accepted {
            iterations: converged.iterations,
            rounds: converged.rounds,
            residual: converged.residual,
            tally: converged.tally,
            ..Accepted::default()
        }
    }

    fn summary(&self) -> history::Effort {
        history::Effort {
            iterations: self.iterations,
            rounds: self.rounds,
            residual: self.residual,
            tally: self.tally,
        }
    }
}
