//! The way through the steps, an increment at a time: [`Simulation::advance`].

use super::position::Increments;
use std::sync::Arc;
use std::time::Instant;

use super::queue::{Due, Failed, Pending};
use super::simulation::{Simulation, view};
use crate::assess::doctor;
use crate::contact::interface::mass_per_area;
use crate::error::Error;
use crate::integrate::explicit::Explicit;
use crate::integrate::implicit::Implicit;
use crate::integrate::integration::Integration;
use crate::integrate::quasi_static::QuasiStatic;
use crate::model::cycling::Block;
use crate::model::definition::Step;
use crate::model::frame::Motion;
use crate::model::scene::Scene;
use crate::results::observer::{Event, Observer, Snapshot};
use crate::solve::accepted::Accepted;
use crate::solve::work::{Watch, Work};
use crate::system::{Cause, StepFailure};
use crate::time::Trial;
use crate::time::scheme::Method;

/// Asked between increments and between Newton iterations whether the analysis shall stop.
pub type Interrupt = Arc<dyn Fn() -> bool + Send + Sync>;

impl Simulation {
    /// Lets the analysis stop when `interrupt` says so: it is asked between increments and between Newton iterations, on the thread that calls
    /// [`Simulation::advance`]. The increment at hand is given up, and those before it stay; the analysis can go on from there.
    pub fn set_interrupt(&mut self, interrupt: Interrupt) {
        self.solver.newton.interrupt = Some(interrupt);
    }

    /// Lets `watch` know what is being worked on, from within attempts: each Newton iteration, whichever way it belongs to, and what else may take a while.
    pub fn set_watch(&mut self, watch: Watch) {
        self.solver.seen.watch = Some(watch);
    }

    /// Goes on by at most one increment that is reported; `false` at the end. [`Simulation::run`] is a loop over this, and gives the same bits.
    ///
    /// After it returns, [`Simulation::frame`] is that of the increment reported last. Not every call reports one: a step may begin, an
    /// increment may fail, and increments of condensed bodies are found together. Where bodies that only contact can hold are moved,
    /// several may be reported by one call.
    ///
    /// # Errors
    /// As [`Simulation::run`]. After [`Error::Interrupted`] the analysis goes on with the next call, after any other it is over.
    pub fn advance(&mut self, observers: &mut [&mut dyn Observer]) -> Result<bool, Error> {
        if self.steps.over {
            return Ok(false);
        }
        if !self.steps.begun {
            self.steps.begun = true;
            self.started = Instant::now();
            self.saved = (0, self.started);
            self.ask_first(observers)?;
        }
        let outcome = self.next(observers);
        let outcome = outcome.and_then(|more| match more {
            true => self.save_if_due(observers).map(|()| true),
            false => Ok(false),
        });
        if matches!(outcome, Ok(true)) {
            return outcome;
        }
        self.steps.over = !matches!(outcome, Err(Error::Interrupted(_)));
        self.close(outcome, observers)
    }

    /// Looks at the model before the first step: what the doctor finds in it does not stop the run, but is told and kept.
    fn ask_first(&mut self, observers: &mut [&mut dyn Observer]) -> Result<(), Error> {
        let (_, findings) = self.look();
        for finding in findings {
            self.tell(observers, || Event::Finding(&finding))?;
            doctor::note(&mut self.summary.findings, finding);
        }
        Ok(())
    }

    /// One turn. Where it ends because an increment was taken back, the analysis goes on from there.
    fn next(&mut self, observers: &mut [&mut dyn Observer]) -> Result<bool, Error> {
        let outcome = self.turn(observers);
        match self.taken_back.take() {
            Some(taken) => self.go_back(taken, observers).map(|()| true),
            None => outcome,
        }
    }

    fn turn(&mut self, observers: &mut [&mut dyn Observer]) -> Result<bool, Error> {
        if self.report_next(observers)? {
            return Ok(true);
        }
        // An attempt that has failed is dealt with first: its increment may have to be smaller.
        let failed = self
            .steps
            .running
            .as_ref()
            .is_some_and(|r| r.failed.is_some());
        if !failed && self.solver.newton.interrupted() {
            return Err(self.stop(observers));
        }
        let running = match self.steps.running.take() {
            Some(running) => running,
            None if self.steps.next < self.model.steps.len() => {
                let step = self.steps.next;
                self.steps.next += 1;
                self.begin_step(step)?;
                self.tell_notes(observers)?;
                if self.model.steps[step].modal.is_some() {
                    self.find_modes(observers)?;
                    return Ok(true);
                }
                Increments::of(&self.model.steps[step])
            }
            None => return Ok(false),
        };
        let running = self.begin_block(running);
        self.steps.running = self.next_attempt(running, observers)?;
        if self.steps.running.is_none() {
            self.tell_growth(observers)?;
        }
        Ok(true)
    }

    /// Reports what has been accepted; the error of an analysis that was asked to stop.
    fn stop(&mut self, observers: &mut [&mut dyn Observer]) -> Error {
        // What is reported from here on, who goes on from there reports again.
        match self.save(observers).and_then(|()| self.flush(observers)) {
            Ok(()) => Error::Interrupted(self.told()),
            Err(e) => e,
        }
    }

    /// The time up to which all is reported.
    fn told(&self) -> f64 {
        let trying = self.trying.as_ref().map(|trying| trying.start.time());
        trying.unwrap_or(self.frame.state.t)
    }

    /// Hands on a checkpoint where one is due and can be taken.
    fn save_if_due(&mut self, observers: &mut [&mut dyn Observer]) -> Result<(), Error> {
        let (every, seconds) = self.model.reports.output.checkpoint;
        let (increments, at) = self.saved;
        let passed = self.summary.attempts.increments - increments;
        let failed = (self.steps.running.as_ref()).is_some_and(|running| running.failed.is_some());
        let between = self.pending.is_empty() && self.recovered.is_none() && self.trying.is_none();
        if !between || failed {
            return Ok(());
        }
        let due = every > 0 && passed >= every
            || seconds > 0.0 && passed > 0 && at.elapsed().as_secs_f64() >= seconds;
        match due {
            true => self.save(observers),
            false => Ok(()),
        }
    }

    /// Hands on a checkpoint where one can be taken.
    fn save(&mut self, observers: &mut [&mut dyn Observer]) -> Result<(), Error> {
        let before = self.before.take();
        let taken = match (&self.trying, before) {
            (Some(trying), _) => Some(trying.start.clone()),
            (None, Some(before)) => Some(self.checkpoint_with(before)),
            (None, None) => self.checkpoint(),
        };
        let Some(checkpoint) = taken else {
            return Ok(());
        };
        let (step, ended) = checkpoint.step();
        let snapshot = Snapshot {
            increments: checkpoint.increments(),
            time: checkpoint.time(),
            step,
            ended,
            state: checkpoint.to_bytes(),
        };
        self.saved = (snapshot.increments, Instant::now());
        self.tell(observers, || Event::Checkpoint(&snapshot))?;
        let remarks = observers.iter_mut().flat_map(|observer| observer.remarks());
        let notes = &mut self.solver.log.notes;
        notes.extend(remarks);
        match notes.is_empty() {
            true => Ok(()),
            false => self.tell_notes(observers),
        }
    }

    /// Begins a step.
    fn begin_step(&mut self, step: usize) -> Result<(), Error> {
        let kick = self.find_kick(step)?;
        self.frame.kick = kick;
        let Simulation {
            model,
            contact,
            frame,
            solver,
            summary,
            ..
        } = self;
        frame.step = step;
        for (interface, conditions) in contact.interfaces.iter().zip(&mut solver.conditions) {
            conditions.steady = model.sliding(step, &interface.name);
            conditions.impulses = false;
        }
        frame.block = Block::default();
        frame.begin_step(model, contact);
        let contacts = Arc::make_mut(&mut frame.contacts);
        contact.begin_acting(
            contacts,
            &solver.conditions,
            &model.steps[step],
            &frame.state,
        );
        if model.steps[step].modal.is_some() {
            return Ok(());
        }
        let Some(dynamic) = model.steps[step].dynamic else {
            return self.begin_rest();
        };
        solver.condenser.drop_at_rest();
        // What keeps loose bodies in place at rest has no part in motion, where their masses do.
        solver.floating.forget_all();
        let contacts = Arc::make_mut(&mut frame.contacts);
        contact.use_springs(contacts, false, |energy| frame.ledger.initial += energy);
        self.integration = match dynamic.method {
            Method::Implicit(alphas) => {
                // What is tried for the forces at the start is no increment that could be tried again.
                let interrupt = solver.newton.interrupt.take();
                let begun = Implicit::begin(model, frame, contact, solver, dynamic, alphas);
                solver.newton.interrupt = interrupt;
                Integration::Implicit(begun?)
            }
            Method::Explicit { .. } => {
                solver.include_all(model, contact);
                let explicit =
                    Explicit::begin(model, frame, contact, &solver.conditions, &dynamic)?;
                summary.explicit.mass_added = explicit.begun.mass_added;
                summary.explicit.stable_increment = explicit.begun.stable;
                Integration::Explicit(Box::new(explicit))
            }
        };
        Ok(())
    }

    /// Begins a quasi-static step: it knows no velocities, what motion there was ends.
    fn begin_rest(&mut self) -> Result<(), Error> {
        let Simulation {
            model,
            contact,
            frame,
            solver,
            ..
        } = self;
        let energy = &mut frame.ledger;
        energy.numerical += energy.kinetic;
        energy.kinetic = 0.0;
        frame.state.v.clear();
        frame.state.a.clear();
        frame.motion = Motion::default();
        solver.end_dynamics();
        for (interface, conditions) in contact.interfaces.iter().zip(&mut solver.conditions) {
            conditions.inertia = mass_per_area(interface, &[]);
        }
        let contacts = Arc::make_mut(&mut frame.contacts);
        contact.use_springs(contacts, false, |energy| frame.ledger.initial += energy);
        self.integration = Integration::QuasiStatic(QuasiStatic);
        solver.find_floating_bodies(model, frame, contact);
        if let Some((finding, error)) = view!(self).refuse_rigid_modes() {
            doctor::note(&mut self.summary.findings, finding);
            return Err(error.into());
        }
        let first = Increments::of(self.step()).stepper.next();
        if let Some(error) = first.and_then(|trial| self.refuse_unbalanced(trial)) {
            return Err(error);
        }
        let (model, frame) = (&self.model, &self.frame);
        (self.solver).choose_candidates(model, frame, &self.contact);
        (self.solver).condense(model, frame, &self.contact);
        Ok(())
    }

    /// The step at hand.
    pub(crate) fn step(&self) -> &Step {
        &self.model.steps[self.frame.step]
    }

    /// One attempt and what follows from it; `None` at the end of the step.
    fn next_attempt(
        &mut self,
        mut running: Increments,
        observers: &mut [&mut dyn Observer],
    ) -> Result<Option<Increments>, Error> {
        if let Some(failed) = running.failed.take() {
            self.cut_back(&mut running, failed, observers)?;
            return Ok(Some(running));
        }
        let integrator = self.integration.as_dyn();
        match integrator.bound(&self.model, &self.frame, &self.contact) {
            Some(bound) if running.attempt == 1 && !running.tight => running.stepper.bound(bound),
            Some(bound) if running.attempt == 1 => running.stepper.bound_again(bound),
            // The bound now is that of where an attempt went wrong: a law may be stiffer there than it will ever be.
            _ => {}
        }
        let Some(trial) = running.stepper.next() else {
            return Ok(None);
        };
        self.count_cycles(trial);
        if self.step().dynamic.is_none() {
            self.prepare_floating(trial, observers)?;
        }
        let counters = doctor::Counters::of(&self.solver.newton.statistics);
        self.solver.seen.tell(&Work::Increment {
            step: &self.step().name,
            from: trial.from,
            to: trial.to,
            attempt: running.attempt,
        });
        let stoppable = self.solver.newton.interrupt.is_some();
        let solves = self.integration.explicit().is_none();
        self.before = (stoppable && solves).then(|| self.working());
        let outcome = self.attempt(trial, observers)?;
        let stopped = matches!(&outcome, Err(e) if e.cause == Cause::Interrupted);
        if !stopped {
            self.before = None;
        }
        let outcome = match outcome {
            Ok(accepted) if !self.restarts(trial, &accepted, observers)? => {
                self.weigh(&mut running, trial, accepted).map(Some)
            }
            other => other.map(|_| None),
        };
        match outcome {
            Ok(None) => {}
            Ok(Some(accepted)) => self.accept(&mut running, trial, accepted, observers)?,
            Err(failure) if failure.cause == Cause::Interrupted => {
                // The same increment is tried again if the analysis goes on.
                self.steps.running = Some(running);
                return Err(self.stop(observers));
            }
            Err(failure) if failure.cause == Cause::Engine => {
                // Interiors of those before it cannot be found any more.
                self.pending.clear();
                self.examine(&trial, running.attempt, counters, &failure);
                return Err(self.give_up(failure, &trial).into());
            }
            // With half the increment it takes the same memory.
            Err(failure) if failure.cause == Cause::Memory => {
                self.flush(observers)?;
                self.examine(&trial, running.attempt, counters, &failure);
                return Err(self.give_up(failure, &trial).into());
            }
            Err(failure) if failure.cause == Cause::Reach => {
                self.flush(observers)?;
                (self.solver).widen(&self.model, &self.frame, &self.contact);
                self.tell_notes(observers)?;
            }
            Err(failure) if failure.cause == Cause::Interior => {
                self.flush(observers)?;
                self.solve_sparsely(&failure, observers)?;
            }
            Err(failure) if self.anchors_again(trial, &failure, observers)? => {}
            Err(failure) => {
                // The increments before it are reported first, each in a turn of its own.
                self.recover_pending();
                running.failed = Some(Failed {
                    trial,
                    counters,
                    failure,
                });
            }
        }
        Ok(Some(running))
    }

    /// Takes note for how many cycles beside its own an increment stands.
    fn count_cycles(&mut self, trial: Trial) {
        let step = self.step();
        let since = trial.from - step.start;
        let block = step.cycles.map(|c| c.block(since, self.frame.block));
        let skipped = block.map_or(0.0, |b| b.stands_for as f64 - 1.0);
        for conditions in &mut self.solver.conditions {
            conditions.skipped = skipped;
        }
    }

    /// Makes one attempt, and tells what happened in it.
    fn attempt(
        &mut self,
        trial: Trial,
        observers: &mut [&mut dyn Observer],
    ) -> Result<Result<Accepted, StepFailure>, Error> {
        let Simulation {
            model,
            contact,
            frame,
            solver,
            integration,
            ..
        } = self;
        solver.seen.clear();
        let integrator = integration.as_dyn_mut();
        let outcome = integrator.attempt(model, frame, contact, solver, trial);
        if !self.waits() {
            let seen = self.solver.seen.take();
            self.tell_iterations(&seen, observers);
        }
        if matches!(&outcome, Err(e) if e.cause == Cause::Interrupted) {
            // It is tried again from its beginning, as if nothing had been tried.
            self.solver.newton.fallbacks.clear();
            return Ok(outcome);
        }
        let notes = self.solver.factors.notes();
        self.solver.log.notes.extend(notes);
        self.note_fallbacks(&trial);
        self.tell_notes(observers)?;
        let scene = Scene {
            model: &self.model,
            contact: &self.contact,
            frame: &self.frame,
        };
        let outcome = self.solver.floating.judge(scene, outcome, trial);
        if self.solver.floating.went_astray() {
            self.reset_predictor();
        }
        Ok(outcome)
    }

    /// Whether accepted increments wait for their interiors.
    pub(crate) fn waits(&self) -> bool {
        self.solver.condenser.at_rest().is_some()
    }

    /// Moves floating bodies that touch nothing until they do, and notes where they are.
    fn prepare_floating(
        &mut self,
        trial: Trial,
        observers: &mut [&mut dyn Observer],
    ) -> Result<(), Error> {
        let solver = &mut self.solver;
        if solver.has_gaps_to_close(&self.model, &self.frame, &self.contact, trial) {
            self.flush(observers)?;
            (self.solver).close_gaps(&self.model, &mut self.frame, &mut self.contact, trial);
            self.tell_notes(observers)?;
        }
        if (self.solver).is_to_keep_bodies(&self.model, &self.frame, trial) {
            self.flush(observers)?;
            (self.solver).keep_bodies(&self.model, &self.frame, &mut self.contact, trial);
            self.tell_notes(observers)?;
        }
        let waiting = !self.pending.is_empty();
        (self.solver).set_out(&self.frame, &mut self.contact, trial, waiting);
        Ok(())
    }

    /// Whether an increment is computed again from where floating bodies have come.
    fn restarts(
        &mut self,
        trial: Trial,
        accepted: &Accepted,
        observers: &mut [&mut dyn Observer],
    ) -> Result<bool, Error> {
        let followed = &mut self.summary.loose.followed;
        let anchored = self.solver.floating.is_anchored();
        let contacts = Arc::clone(self.solver.contacts(&self.frame));
        let floating = &mut self.solver.floating;
        if !floating.wants_restart(&self.model, &self.contact, &contacts, followed) {
            if anchored {
                (self.solver).note_released(&self.model, &self.frame, accepted);
                self.tell_notes(observers)?;
            }
            return Ok(false);
        }
        self.flush(observers)?;
        (self.solver).restart_from_rigid_motion(
            &self.model,
            &mut self.frame,
            &mut self.contact,
            trial,
        );
        self.tell_notes(observers)?;
        Ok(true)
    }

    /// Whether an increment that failed is computed again with floating bodies anchored, or anchored more stiffly.
    fn anchors_again(
        &mut self,
        trial: Trial,
        failure: &StepFailure,
        observers: &mut [&mut dyn Observer],
    ) -> Result<bool, Error> {
        let stiffer = self.solver.floating.wants_stiffer_anchors(failure);
        if stiffer {
            self.reset_predictor();
        } else if !self.solver.floating.may_follow(self.step(), failure) {
            return Ok(false);
        }
        self.flush(observers)?;
        let Simulation {
            model,
            contact,
            frame,
            solver,
            ..
        } = self;
        match stiffer {
            true => solver.anchor(model, frame, contact, trial),
            false => solver.follow(model, frame, contact, trial),
        }
        self.tell_notes(observers)?;
        Ok(true)
    }

    /// Goes on from an increment that was accepted.
    fn accept(
        &mut self,
        running: &mut Increments,
        trial: Trial,
        accepted: Accepted,
        observers: &mut [&mut dyn Observer],
    ) -> Result<(), Error> {
        running.accepted += 1;
        let increment = running.accepted;
        let iterations = if accepted.hard {
            usize::MAX
        } else {
            accepted.effort.iterations
        };
        running.stepper.accept(trial, iterations);
        let plan = &self.model.reports.output;
        let last = running.stepper.next().is_none();
        let due = last || plan.times.contains(&trial.to) || increment.is_multiple_of(plan.every);
        let row = due || increment.is_multiple_of(plan.history_every);
        let pending = Pending::new(
            trial,
            accepted,
            increment,
            running.attempt,
            Due { fields: due, row },
        );
        if pending.row {
            let advance = pending.advance();
            self.tell(observers, || Event::Accepted(&advance))?;
        }
        self.go_on(pending, last, observers)?;
        // What a second field presses with in the next increment follows from this one.
        if !self.frame.fields.is_empty() {
            self.flush(observers)?;
        }
        if self.step().corners.contains(&trial.to) {
            self.reset_predictor();
        }
        running.attempt = 1;
        self.end_block(running, trial.to, observers)
    }

    /// Makes an increment that failed smaller.
    fn cut_back(
        &mut self,
        running: &mut Increments,
        failed: Failed,
        observers: &mut [&mut dyn Observer],
    ) -> Result<(), Error> {
        let Failed {
            trial,
            counters,
            failure,
        } = failed;
        let seen = self.solver.seen.take();
        self.tell_iterations(&seen, observers);
        self.examine(&trial, running.attempt, counters, &failure);
        running.attempt += 1;
        self.reject(&trial, &failure);
        let may_be = !matches!(failure.cause, Cause::NotFinite | Cause::CollapsedCell);
        if may_be
            && self.step().dynamic.is_none()
            && let Some(error) = self.refuse_unbalanced(trial)
        {
            return Err(error);
        }
        if !running.stepper.reject(trial) {
            if self.may_solve_sparsely(&failure) {
                let initial = running.stepper.initial();
                running.stepper.again(trial.from, initial);
                running.attempt = 1;
                return self.solve_sparsely(&failure, observers);
            }
            if self.try_fewer_cycles(running)? {
                return Ok(());
            }
            return Err(self.give_up(failure, &trial).into());
        }
        self.tell(observers, || Event::Cutback(&trial, &failure))
    }
}
