use std::collections::BTreeMap;
use std::time::Instant;

use super::model::Model;
use super::summary::{Phases, Summary};
use super::{diagnosis, history};
use crate::error::{Error, RunError};
use crate::linear::BlockCsr;
use crate::newton::{Newton, Progress, System};
use crate::system::{Cause, Constraints, Force, State, StepFailure, Tally};
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
    matrix: BlockCsr,
    diagonal: Vec<f64>,
    newton: Newton,
    previous: Option<(f64, Vec<f64>)>,
    held: BTreeMap<String, Vec<f64>>,
    released: Vec<(usize, f64)>,
    step: usize,
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
        let mut matrix =
            BlockCsr::from_couplings(model.dofs.points, model.dofs.dim, &mut |visit| {
                for body in &model.bodies {
                    body.elastic.couplings(visit);
                }
                for spring in &model.springs {
                    spring.couplings(visit);
                }
            });
        let bulk = model.bodies.iter().map(|b| &b.elastic as &dyn Force);
        let bulk = bulk.chain(model.springs.iter().map(|s| s as &dyn Force));
        for force in bulk {
            force.stiffness(&mut matrix).map_err(|e| e.at(0.0))?;
        }
        let n = model.dofs.count();
        let newton = Newton::new(model.settings);
        let mut simulation = Simulation {
            state: State {
                t: model.steps.first().map_or(0.0, |s| s.start),
                u: vec![0.0; n],
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

    fn run_step(&mut self, observers: &mut [&mut dyn Observer]) -> Result<(), Error> {
        let step = self.model.steps[self.step].clone();
        let mut stepper = Stepper::new(step.start, step.milestones.clone(), step.increments);
        let mut increment = 0;
        let mut attempt = 1;
        while let Some(trial) = stepper.next() {
            match self.attempt(trial, observers) {
                Ok((state, forces, accepted)) => {
                    increment += 1;
                    let row = self.accept(trial, state, forces, &accepted, increment, attempt);
                    stepper.accept(trial, accepted.iterations);
                    if step.milestones.contains(&trial.to) {
                        // Tables have their corners here.
                        self.previous = None;
                    }
                    attempt = 1;
                    for observer in observers.iter_mut() {
                        observer.see(self, Event::Increment(&row))?;
                    }
                    let plan = &self.model.output;
                    let last = stepper.next().is_none();
                    let due = plan.times.contains(&trial.to)
                        || (plan.every > 0 && increment % plan.every == 0);
                    if last || due {
                        for observer in observers.iter_mut() {
                            observer.see(self, Event::Output)?;
                        }
                    }
                }
                Err(failure) => {
                    attempt += 1;
                    self.summary.cutbacks += 1;
                    self.summary.cutback_reasons.push(format!(
                        "{} ({:.6e} to {:.6e}): {}",
                        step.name, trial.from, trial.to, failure.message
                    ));
                    // What the last increment did is no guide any more.
                    self.previous = None;
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
                let value = if support.table {
                    s * e.value
                } else {
                    start + s * (e.value - start)
                };
                constraints.prescribe(e.dof, value);
            }
        }
        constraints
    }

    /// External forces at a time, with the fading forces of supports that let go in this step.
    fn external(&self, t: f64) -> Vec<f64> {
        let mut external = vec![0.0; self.state.u.len()];
        for load in &self.model.loads {
            load.external(t, &mut external);
        }
        let step = &self.model.steps[self.step];
        let left = (step.end - t) / (step.end - step.start);
        for &(dof, force) in &self.released {
            external[dof] += left * force;
        }
        external
    }

    #[allow(clippy::type_complexity)]
    fn attempt(
        &mut self,
        trial: Trial,
        observers: &mut [&mut dyn Observer],
    ) -> Result<(State, Vec<f64>, Accepted), StepFailure> {
        let dt = trial.to - trial.from;
        let external = self.external(trial.to);
        let constraints = self.constraints(trial.to);
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
            let contact = model
                .interfaces
                .iter_mut()
                .map(|i| i as &mut dyn Force)
                .collect();
            let mut system = System {
                dofs: model.dofs,
                matrix,
                diagonal,
                contact,
                external: external.clone(),
                constraints,
            };
            newton.solve(&mut system, state, &mut at, &mut |p| seen.push(*p))
        };
        for p in &seen {
            for observer in observers.iter_mut() {
                // An observer that cannot keep up with iterations does not stop the run.
                let _ = observer.see(self, Event::Iteration(p));
            }
        }
        let converged = converged?;
        let change =
            at.u.iter()
                .zip(&self.state.u)
                .fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
        if change > self.model.largest_change * self.model.mesh.diameter() {
            return Err(StepFailure::new(
                Cause::TooFar,
                format!(
                    "two successive solutions are {change:.3e} apart, more than `largest-change` allows"
                ),
            ));
        }
        let accepted = Accepted {
            iterations: converged.iterations,
            rounds: converged.rounds,
            residual: converged.residual,
            tally: converged.tally,
            external,
        };
        Ok((at, converged.forces, accepted))
    }

    fn accept(
        &mut self,
        trial: Trial,
        at: State,
        forces: Vec<f64>,
        accepted: &Accepted,
        increment: usize,
        attempt: usize,
    ) -> history::Row {
        let stage = crate::system::Stage {
            from: &self.state,
            at: &at,
            dt: trial.to - trial.from,
        };
        for interface in &mut self.model.interfaces {
            interface.commit(&stage);
        }
        // Work of loads and reactions by the trapezoidal rule: exact for forces that vary linearly over the increment.
        let before = self.external(trial.from);
        let mut work = 0.0;
        for (i, (before, after)) in before.iter().zip(&accepted.external).enumerate() {
            work += 0.5 * (before + after) * (at.u[i] - self.state.u[i]);
        }
        let fixed = self.constraints(trial.to).fixed;
        for (i, _) in fixed.iter().enumerate().filter(|(_, fixed)| **fixed) {
            work += 0.5 * (self.forces[i] + forces[i]) * (at.u[i] - self.state.u[i]);
        }
        self.summary.energy.external_work += work;
        self.previous = Some((trial.to - trial.from, std::mem::take(&mut self.state.u)));
        self.state = at;
        self.forces = forces;
        self.summary.increments += 1;
        self.summary.iterations += accepted.iterations;
        let mut ku = vec![0.0; self.state.u.len()];
        self.matrix.mul(&self.state.u, &mut ku);
        let strain: f64 = ku.iter().zip(&self.state.u).map(|(f, u)| f * u).sum();
        let energy = &mut self.summary.energy;
        energy.strain = 0.5 * strain;
        let contact: Vec<_> = self.model.interfaces.iter().map(|i| i.energy()).collect();
        energy.contact = contact.iter().map(|e| e.stored).sum();
        energy.friction = contact.iter().map(|e| e.dissipated).sum();
        energy.belt_work = contact.iter().map(|e| e.work).sum();
        let names = (increment, attempt);
        let row = history::row(self, trial, accepted.summary(), names);
        self.summary.last = row
            .names
            .iter()
            .cloned()
            .zip(row.values.iter().copied())
            .collect();
        row
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

struct Accepted {
    iterations: usize,
    rounds: usize,
    residual: f64,
    tally: Tally,
    external: Vec<f64>,
}

impl Accepted {
    fn summary(&self) -> history::Effort {
        history::Effort {
            iterations: self.iterations,
            rounds: self.rounds,
            residual: self.residual,
            tally: self.tally,
        }
    }
}
