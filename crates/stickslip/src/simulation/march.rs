//! The way through the steps, an increment at a time: [`Simulation::advance`].

use std::sync::Arc;
use std::time::Instant;

use super::accepted::Accepted;
use super::doctor;
use super::model::{Dynamic, Step};
use super::pending::Pending;
use super::run::{Event, Observer, Simulation};
use crate::body::couplings::CouplingsMemory;
use crate::error::Error;
use crate::system::{Cause, StepFailure};
use crate::time::scheme::Method;
use crate::time::{Stepper, Trial};

/// Asked between increments and between Newton iterations whether the analysis shall stop.
pub type Interrupt = Arc<dyn Fn() -> bool + Send + Sync>;

/// How far an analysis has come.
#[derive(Default)]
pub(super) struct March {
    begun: bool,
    over: bool,
    /// The next step to begin.
    next: usize,
    /// The step being run.
    step: Option<Running>,
}

/// A step being run.
struct Running {
    step: Step,
    stepper: Stepper,
    increment: usize,
    attempt: usize,
    /// An attempt that failed, kept until the increments before it are reported.
    failed: Option<(Trial, doctor::Chart, StepFailure)>,
}

impl Simulation {
    /// Lets the analysis stop when `interrupt` says so: it is asked between increments and between Newton iterations, on the thread that calls
    /// [`Simulation::advance`]. The increment at hand is given up, and those before it stay; the analysis can go on from there.
    pub fn set_interrupt(&mut self, interrupt: Interrupt) {
        self.newton.interrupt = Some(interrupt);
    }

    /// Goes on by at most one increment that is reported; `false` at the end. [`Simulation::run`] is a loop over this, and gives the same bits.
    ///
    /// After it returns, [`Simulation::state`] is that of the increment reported last. Not every call reports one: a step may begin, an
    /// increment may fail, and increments of condensed bodies are found together. Where bodies that only contact can hold are moved,
    /// several may be reported by one call.
    ///
    /// # Errors
    /// As [`Simulation::run`]. After [`Error::Interrupted`] the analysis goes on with the next call, after any other it is over.
    pub fn advance(&mut self, observers: &mut [&mut dyn Observer]) -> Result<bool, Error> {
        if self.march.over {
            return Ok(false);
        }
        if !self.march.begun {
            self.march.begun = true;
            self.started = Instant::now();
            self.ask_first(observers)?;
        }
        let outcome = self.go(observers);
        if matches!(outcome, Ok(true)) {
            return outcome;
        }
        self.march.over = !matches!(outcome, Err(Error::Interrupted(_)));
        self.close(outcome, observers)
    }

    /// Looks at the model before the first step: what the doctor finds in it does not stop the run, but is told and kept.
    fn ask_first(&mut self, observers: &mut [&mut dyn Observer]) -> Result<(), Error> {
        let (_, findings) = self.look();
        for finding in findings {
            for observer in observers.iter_mut() {
                observer.see(self, Event::Finding(&finding))?;
            }
            doctor::note(&mut self.summary.findings, finding);
        }
        Ok(())
    }

    fn go(&mut self, observers: &mut [&mut dyn Observer]) -> Result<bool, Error> {
        if self.report_next(observers)? {
            return Ok(true);
        }
        if self.newton.interrupted() {
            return Err(self.stop(observers));
        }
        let running = match self.march.step.take() {
            Some(running) => running,
            None if self.march.next < self.model.steps.len() => {
                let step = self.march.next;
                self.march.next += 1;
                self.enter(step)?;
                self.tell_notes(observers)?;
                self.running()
            }
            None => return Ok(false),
        };
        self.march.step = self.turn(running, observers)?;
        Ok(true)
    }

    /// Reports what has been accepted; the error of an analysis that was asked to stop.
    fn stop(&mut self, observers: &mut [&mut dyn Observer]) -> Error {
        match self.flush(observers) {
            Ok(()) => Error::Interrupted(self.state.t),
            Err(e) => e,
        }
    }

    /// Begins a step.
    fn enter(&mut self, step: usize) -> Result<(), Error> {
        self.step = step;
        self.begin_step();
        self.begin_acting();
        match self.model.steps[step].dynamic {
            Some(dynamic) => {
                self.explicit = None;
                self.condensed = None;
                for interface in &mut self.model.interfaces {
                    self.summary.energy.initial += interface.use_springs(false);
                }
                self.summary.energy.initial += self.model.couplings.use_springs(false);
                match dynamic.method {
                    Method::Implicit(alphas) => {
                        self.start_motion(&dynamic);
                        self.choose_candidates();
                        self.start_forces(&dynamic, alphas)?;
                    }
                    Method::Explicit { .. } => {
                        self.wake();
                        self.start_explicit(&dynamic)?;
                    }
                }
            }
            None => {
                self.rest();
                self.know();
                self.refuse_unheld()?;
                self.choose_candidates();
                self.condense()?;
            }
        }
        Ok(())
    }

    fn running(&self) -> Running {
        let step = self.model.steps[self.step].clone();
        let mut stepper = Stepper::new(step.start, step.milestones.clone(), step.increments);
        if step.dynamic.is_some() {
            stepper = stepper.doubling();
        }
        Running {
            step,
            stepper,
            increment: 0,
            attempt: 1,
            failed: None,
        }
    }

    /// One attempt and what follows from it; `None` at the end of the step.
    fn turn(
        &mut self,
        mut running: Running,
        observers: &mut [&mut dyn Observer],
    ) -> Result<Option<Running>, Error> {
        if let Some((trial, chart, failure)) = running.failed.take() {
            self.recede(&mut running, (trial, chart, failure), observers)?;
            return Ok(Some(running));
        }
        let attempt = running.attempt;
        let Running { step, stepper, .. } = &mut running;
        match self.bound() {
            Some(bound) if attempt == 1 => stepper.bound(bound),
            Some(bound) => stepper.bound_again(bound),
            None => {}
        }
        let Some(trial) = stepper.next() else {
            return Ok(None);
        };
        if step.dynamic.is_none() {
            self.meet(trial, observers)?;
            self.set_out(trial);
        }
        let chart = doctor::Chart::of(&self.newton.statistics);
        let outcome = match step.dynamic {
            None => self.attempt_static(trial, observers),
            Some(
                dynamic @ Dynamic {
                    method: Method::Implicit(alphas),
                    ..
                },
            ) => self.attempt_implicit(trial, &dynamic, alphas, observers),
            Some(_) => self.attempt_explicit(trial),
        };
        self.notes.extend(self.factors.notes());
        self.note_fallbacks(step, &trial);
        self.tell_notes(observers)?;
        let outcome = self.judge_loose(outcome, trial);
        match outcome {
            Ok(_) if self.carried_on(trial, observers)? => {}
            Ok(accepted) => self.proceed(&mut running, trial, accepted, observers)?,
            Err(failure) if failure.cause == Cause::Interrupted => {
                // The same increment is tried again if the analysis goes on.
                self.march.step = Some(running);
                return Err(self.stop(observers));
            }
            // With half the increment it takes the same memory.
            Err(failure) if failure.cause == Cause::Memory => {
                self.flush(observers)?;
                self.examine(&trial, (running.attempt, chart), &failure);
                return Err(self.give_up(failure, &trial).into());
            }
            Err(failure) if failure.cause == Cause::Reach => self.widen(observers)?,
            Err(failure) if self.firmer(trial, &failure, observers)? => {}
            Err(failure) if self.may_follow(step, &failure) => self.follow(trial, observers)?,
            Err(failure) => {
                // The increments before it are reported first, each in a turn of its own.
                self.recover_pending();
                running.failed = Some((trial, chart, failure));
            }
        }
        Ok(Some(running))
    }

    /// Goes on from an increment that was accepted.
    fn proceed(
        &mut self,
        running: &mut Running,
        trial: Trial,
        accepted: Accepted,
        observers: &mut [&mut dyn Observer],
    ) -> Result<(), Error> {
        running.increment += 1;
        let increment = running.increment;
        let iterations = if accepted.hard {
            usize::MAX
        } else {
            accepted.iterations
        };
        running.stepper.accept(trial, iterations);
        let plan = &self.model.output;
        let last = running.stepper.next().is_none();
        let due = last || plan.times.contains(&trial.to) || increment.is_multiple_of(plan.every);
        let pending = Pending {
            trial,
            accepted,
            increment,
            attempt: running.attempt,
            fields: due,
            row: due || increment.is_multiple_of(plan.history_every),
            seen: Vec::new(),
            histories: Vec::new(),
            couplings: CouplingsMemory::default(),
            found: None,
        };
        if pending.row {
            let advance = pending.advance();
            for observer in observers.iter_mut() {
                observer.see(self, Event::Accepted(&advance))?;
            }
        }
        self.go_on(pending, last, observers)?;
        if running.step.milestones.contains(&trial.to) {
            // Tables have their corners here.
            self.forget_direction();
        }
        running.attempt = 1;
        Ok(())
    }

    /// Makes an increment that failed smaller.
    fn recede(
        &mut self,
        running: &mut Running,
        (trial, chart, failure): (Trial, doctor::Chart, StepFailure),
        observers: &mut [&mut dyn Observer],
    ) -> Result<(), Error> {
        let seen = std::mem::take(&mut self.seen);
        self.tell(&seen, observers);
        self.examine(&trial, (running.attempt, chart), &failure);
        running.attempt += 1;
        self.reject(&running.step, &trial, &failure);
        if !running.stepper.reject(trial) {
            return Err(self.give_up(failure, &trial).into());
        }
        for observer in observers.iter_mut() {
            observer.see(self, Event::Cutback(&trial, &failure))?;
        }
        Ok(())
    }
}
