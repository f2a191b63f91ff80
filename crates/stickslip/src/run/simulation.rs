//! The loop over steps and increments: who owns an analysis, and how it goes on by one increment at a time.

use std::ops::Deref;
use std::sync::Arc;
use std::time::Instant;

use super::attempt::{attempt, prepare, propose};
use super::begin::begin_step;
use super::checkpoint::{AttemptState, Checkpoint};
use super::cycles::{begin_block, begins_block};
use super::ending::close;
use super::energy_balance::check_energy_balance;
use super::fallback::go_back;
use super::floating::restarts;
use super::modes::{find_modes, tell_growth};
use super::outcome::{accept, answer, cut_back};
use super::parts::Run;
use super::pending::{flush, report_next};
use super::position::Increments;
use super::queue::Failed;
use super::restart::{attempt_state, checkpoint_with, resume};
use super::sizes::{Sizes, sizes};
use crate::assess::diagnosis::CheckReport;
use crate::assess::{diagnosis, doctor};
use crate::error::Error;
use crate::friction::FrictionProblem;
use crate::integrate::explicit::explicit;
use crate::model::Setup;
use crate::newton::condensed::Library;
use crate::results::observer::{Event, Observer, Snapshot};
use crate::solve::work::Watch;
use crate::system::Cause;

/// Asked between increments and between Newton iterations whether the analysis shall stop.
pub type Interrupt = Arc<dyn Fn() -> bool + Send + Sync>;

/// A model being run.
pub struct Simulation {
    /// What is simulated, where it stands, and what has come of it.
    pub run: Run,
    /// Increments at the last checkpoint, and when it was taken.
    saved: (usize, Instant),
    /// What the attempt at hand may change, as it was at its beginning, where a run may be stopped in the middle of one.
    before: Option<AttemptState>,
}

impl Deref for Simulation {
    type Target = Run;

    fn deref(&self) -> &Run {
        &self.run
    }
}

impl Simulation {
    /// Assembles the bulk and checks the model's own consistency.
    pub fn new(setup: Setup) -> Result<Self, Error> {
        let library = Library::new(Library::small_limit());
        Simulation::with_library(setup, Arc::new(library))
    }

    /// The same with the factors of other runs: bodies with the same matrix, unknowns and contact candidates are factored once. Results have the
    /// same bits, whoever made the factors.
    pub fn with_library(setup: Setup, library: Arc<Library>) -> Result<Self, Error> {
        Ok(Simulation::of(Run::new(setup, library)))
    }

    /// An analysis that goes on from a checkpoint, with the bits of one that never stopped. `setup` is what the problem builds to; `library` as in
    /// [`Simulation::with_library`].
    ///
    /// # Errors
    /// [`Error::Run`] if the checkpoint is one of another model, or bodies cannot be factored again.
    pub fn resume(
        setup: Setup,
        library: Arc<Library>,
        checkpoint: Checkpoint,
    ) -> Result<Self, Error> {
        let mut run = Run::new(setup, library);
        resume(&mut run, checkpoint)?;
        Ok(Simulation::of(run))
    }

    fn of(run: Run) -> Self {
        Simulation {
            saved: (run.summary.attempts.increments, run.started),
            before: None,
            run,
        }
    }

    /// Lets the analysis stop when `interrupt` says so: it is asked between increments and between Newton iterations, on the thread that calls
    /// [`Simulation::advance`]. The increment at hand is given up, and those before it stay; the analysis can go on from there.
    pub fn set_interrupt(&mut self, interrupt: Interrupt) {
        self.run.solver.newton.interrupt = Some(interrupt);
    }

    /// Lets `watch` know what is being worked on, from within attempts: each Newton iteration, whichever way it belongs to, and what else may take a while.
    pub fn set_watch(&mut self, watch: Watch) {
        self.run.solver.seen.watch = Some(watch);
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

    /// Goes on by at most one increment that is reported; `false` at the end. [`Simulation::run`] is a loop over this, and gives the same bits.
    ///
    /// After it returns, [`Run::frame`] is that of the increment reported last. Not every call reports one: a step may begin, an
    /// increment may fail, and increments of condensed bodies are found together. Where bodies that only contact can hold are moved,
    /// several may be reported by one call.
    ///
    /// # Errors
    /// As [`Simulation::run`]. After [`Error::Interrupted`] the analysis goes on with the next call, after any other it is over.
    pub fn advance(&mut self, observers: &mut [&mut dyn Observer]) -> Result<bool, Error> {
        if self.run.steps.over {
            return Ok(false);
        }
        if !self.run.steps.begun {
            self.run.steps.begun = true;
            self.run.started = Instant::now();
            self.saved = (0, self.run.started);
            self.check_model(observers)?;
        }
        let outcome = self.next(observers);
        let outcome = outcome.and_then(|more| match more {
            true => self.save_if_due(observers).map(|()| true),
            false => Ok(false),
        });
        if matches!(outcome, Ok(true)) {
            return outcome;
        }
        self.run.steps.over = !matches!(outcome, Err(Error::Interrupted(_)));
        close(&mut self.run, outcome, observers)
    }

    /// Looks at the model without running it.
    pub fn check(&mut self) -> CheckReport {
        let (gaps, findings) = self.run.look();
        diagnosis::check(&self.run.view(), &gaps, findings)
    }

    /// How much the run will write, if it is asked before it begins.
    pub fn sizes(&self) -> Sizes {
        sizes(&self.run)
    }

    /// All state from which the analysis goes on; `None` before the first step.
    /// Increments that wait for their interiors or for their report are part of it: what is reported of them after it was taken, who goes on from it reports again.
    pub fn checkpoint(&self) -> Option<Checkpoint> {
        let steps = &self.run.steps;
        let ready = steps.begun && steps.next > 0 && self.run.taken_back.is_none();
        let ready = ready && self.run.block.is_none();
        ready.then(|| checkpoint_with(&self.run, attempt_state(&self.run)))
    }

    /// The last increment as a friction problem, if none of the ways of Newton's method led anywhere and its bodies are condensed.
    pub fn unsolved(&self) -> Option<&FrictionProblem> {
        self.run.solver.newton.unsolved.as_ref()
    }

    /// Looks at the model before the first step: what the doctor finds in it does not stop the run, but is told and kept.
    fn check_model(&mut self, observers: &mut [&mut dyn Observer]) -> Result<(), Error> {
        let (_, findings) = self.run.look();
        for finding in findings {
            self.run.tell(observers, || Event::Finding(&finding))?;
            doctor::note(&mut self.run.summary.findings, finding);
        }
        Ok(())
    }

    /// One turn. Where it ends because an increment was taken back, the analysis goes on from there.
    fn next(&mut self, observers: &mut [&mut dyn Observer]) -> Result<bool, Error> {
        let outcome = self.turn(observers);
        match self.run.taken_back.take() {
            Some(taken) => go_back(&mut self.run, taken, observers).map(|()| true),
            None => outcome,
        }
    }

    fn turn(&mut self, observers: &mut [&mut dyn Observer]) -> Result<bool, Error> {
        let run = &mut self.run;
        if report_next(run, observers)? {
            return Ok(true);
        }
        // An attempt that has failed is dealt with first: its increment may have to be smaller.
        let failed = (run.steps.running.as_ref()).is_some_and(|r| r.failed.is_some());
        if !failed && run.solver.newton.interrupted() {
            return Err(self.stop(observers));
        }
        if run.steps.running.is_none() {
            let step = run.steps.next;
            if step == run.model.steps.len() {
                return Ok(false);
            }
            run.steps.next += 1;
            begin_step(run, step)?;
            run.tell_notes(observers)?;
            if run.model.steps[step].modal.is_some() {
                find_modes(run, observers)?;
                return Ok(true);
            }
            run.steps.running = Some(Increments::of(run.step()));
        }
        let start = begins_block(run).then(|| checkpoint_with(run, attempt_state(run)));
        let Some(mut running) = run.steps.running.take() else {
            return Ok(false);
        };
        if let Some(start) = start {
            begin_block(run, &mut running, start);
        }
        self.run.steps.running = self.next_attempt(running, observers)?;
        if self.run.steps.running.is_none() {
            tell_growth(&mut self.run, observers)?;
        }
        Ok(true)
    }

    /// One attempt and what follows from it; `None` at the end of the step.
    fn next_attempt(
        &mut self,
        mut running: Increments,
        observers: &mut [&mut dyn Observer],
    ) -> Result<Option<Increments>, Error> {
        let run = &mut self.run;
        if let Some(failed) = running.failed.take() {
            cut_back(run, &mut running, failed, observers)?;
            return Ok(Some(running));
        }
        let Some(trial) = propose(run, &mut running) else {
            return Ok(None);
        };
        prepare(run, trial, running.attempt, observers)?;
        let counters = doctor::Counters::of(&run.solver.newton.statistics);
        let stoppable = run.solver.newton.interrupt.is_some();
        let solves = explicit(run.integrator.as_ref()).is_none();
        self.before = (stoppable && solves).then(|| attempt_state(run));
        let outcome = attempt(run, trial, observers)?;
        if matches!(&outcome, Err(e) if e.cause == Cause::Interrupted) {
            // The same increment is tried again if the analysis goes on.
            run.steps.running = Some(running);
            return Err(self.stop(observers));
        }
        self.before = None;
        let outcome = match outcome {
            Ok(accepted) if restarts(run, trial, &accepted, observers)? => {
                return Ok(Some(running));
            }
            Ok(accepted) => check_energy_balance(run, &mut running, trial, accepted),
            failed => failed,
        };
        match outcome {
            Ok(accepted) => accept(run, &mut running, trial, accepted, observers)?,
            Err(failure) => {
                let failed = Failed {
                    trial,
                    counters,
                    failure,
                };
                answer(run, &mut running, failed, observers)?;
            }
        }
        Ok(Some(running))
    }

    /// Reports what has been accepted; the error of an analysis that was asked to stop.
    fn stop(&mut self, observers: &mut [&mut dyn Observer]) -> Error {
        // What is reported from here on, who goes on from there reports again.
        match self
            .save(observers)
            .and_then(|()| flush(&mut self.run, observers))
        {
            // The time up to which all is reported.
            Ok(()) => {
                let block = self.run.block.as_ref().map(|block| block.start.time());
                Error::Interrupted(block.unwrap_or(self.run.frame.state.t))
            }
            Err(e) => e,
        }
    }

    /// Hands on a checkpoint where one is due and can be taken.
    fn save_if_due(&mut self, observers: &mut [&mut dyn Observer]) -> Result<(), Error> {
        let (every, seconds) = self.run.model.reports.output.checkpoint;
        let (increments, at) = self.saved;
        let passed = self.run.summary.attempts.increments - increments;
        let failed =
            (self.run.steps.running.as_ref()).is_some_and(|running| running.failed.is_some());
        let between =
            self.run.pending.is_empty() && self.run.recovered.is_none() && self.run.block.is_none();
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
        let taken = match (&self.run.block, before) {
            (Some(block), _) => Some(block.start.clone()),
            (None, Some(before)) => Some(checkpoint_with(&self.run, before)),
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
        self.run.tell(observers, || Event::Checkpoint(&snapshot))?;
        let remarks = observers.iter_mut().flat_map(|observer| observer.remarks());
        let notes = &mut self.run.solver.log.notes;
        notes.extend(remarks);
        match notes.is_empty() {
            true => Ok(()),
            false => self.run.tell_notes(observers),
        }
    }
}
