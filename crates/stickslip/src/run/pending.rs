//! Accepted increments on their way into the results.

use std::collections::VecDeque;
use std::sync::Arc;
use std::time::Instant;

use super::queue::Pending;

use super::book::book;
use super::simulation::{Simulation, view};
use crate::contact::look;
use crate::error::Error;
use crate::fatigue::Maximum;
use crate::newton::Progress;
use crate::results::fatigue;
use crate::results::history;
use crate::results::loops;
use crate::results::observer::{Event, Observer};
use crate::solve::choice::TOGETHER;
use crate::system::{Cause, State, StepFailure};
use crate::time::Trial;

impl Simulation {
    /// Goes on from an accepted increment: at once, or with others in one sweep.
    pub(crate) fn go_on(
        &mut self,
        mut pending: Pending,
        last: bool,
        observers: &mut [&mut dyn Observer],
    ) -> Result<(), Error> {
        let Simulation {
            model,
            contact,
            frame,
            solver,
            ..
        } = self;
        let Pending {
            accepted, trial, ..
        } = &pending;
        let Some(condensed) = solver.condenser.at_rest() else {
            // In motion that has been done when it was weighed.
            if model.steps[frame.step].dynamic.is_none() {
                let stage = accepted.stage(&frame.state, *trial);
                frame.contacts =
                    Arc::new(contact.commit(&frame.contacts, &solver.conditions, &stage));
                (frame.course).go_on(trial.to - trial.from, frame.state.u.clone());
            }
            return self.report(pending, observers);
        };
        let stage = accepted.stage(&condensed.state, *trial);
        let after = contact.commit(solver.contacts(frame), &solver.conditions, &stage);
        let after = Arc::new(after);
        pending.found = solver.move_ahead(&mut pending.accepted, pending.trial);
        pending.seen = solver.seen.take();
        solver.condenser.go_ahead(Some(Arc::clone(&after)));
        pending.after = Some(after);
        self.pending.push(pending);
        if last || self.pending.len() >= TOGETHER {
            self.recover_pending();
        }
        Ok(())
    }

    /// Finds the interiors of all pending increments and reports them.
    pub(crate) fn flush(&mut self, observers: &mut [&mut dyn Observer]) -> Result<(), Error> {
        self.recover_pending();
        while self.report_next(observers)? {}
        Ok(())
    }

    /// Finds the interiors of all pending increments.
    pub(crate) fn recover_pending(&mut self) {
        if self.pending.is_empty() {
            return;
        }
        let mut queue: VecDeque<Pending> = self.pending.drain(..).collect();
        let unknown = queue.iter_mut();
        let unknown = unknown.filter_map(|p| Some((p.found.as_ref()?, &mut p.accepted)));
        self.solver.recover(unknown);
        self.recovered = Some(queue);
    }

    /// Reports the next of the increments whose interiors are known; `false` if there is none.
    pub(crate) fn report_next(
        &mut self,
        observers: &mut [&mut dyn Observer],
    ) -> Result<bool, Error> {
        let Some(mut queue) = self.recovered.take() else {
            return Ok(false);
        };
        let mut outcome = Ok(());
        if let Some(mut one) = queue.pop_front() {
            if let Err(failure) = self.complete(&mut one) {
                self.solver.condenser.go_ahead(None);
                if failure.cause == Cause::Engine {
                    self.pending.clear();
                    return Err(failure.at(self.frame.state.t).into());
                }
                return Err(self.roll_back(&one, failure));
            }
            if let Some(after) = one.after.take() {
                self.frame.contacts = after;
            }
            outcome = self.report(one, observers);
        }
        if queue.is_empty() || outcome.is_err() {
            self.solver.condenser.go_ahead(None);
        } else {
            self.recovered = Some(queue);
        }
        outcome.map(|()| true)
    }

    /// Completes an increment whose interior has been found.
    fn complete(&mut self, one: &mut Pending) -> Result<(), StepFailure> {
        let (Some(found), Some(after)) = (&one.found, &one.after) else {
            return Ok(());
        };
        let Simulation {
            model,
            contact,
            frame,
            solver,
            ..
        } = self;
        solver.complete(model, frame, contact, after, found, &mut one.accepted)
    }

    /// Enters an increment into the ledger and tells the observers.
    fn report(
        &mut self,
        pending: Pending,
        observers: &mut [&mut dyn Observer],
    ) -> Result<(), Error> {
        self.tell_iterations(&pending.seen, observers);
        let Simulation {
            model,
            contact,
            frame,
            summary,
            ..
        } = self;
        let effort = book(model, contact, frame, summary, pending.accepted);
        let started = Instant::now();
        if pending.row {
            let row = history::row(
                &view!(self),
                &self.judges.around,
                pending.trial,
                effort,
                pending.increment,
                pending.attempt,
            );
            let named = row.names.iter().cloned().zip(row.values.iter().copied());
            self.summary.last = named.collect();
            self.judge();
            match &mut self.trying {
                Some(trying) => trying.hold(row, pending.fields),
                None => self.tell(observers, || Event::Increment(&row))?,
            }
        }
        let view = view!(self);
        let judges = &mut self.judges;
        let cycle = loops::follow(&view, &judges.shares, &mut judges.loops, pending.trial);
        let worst = self.follow_fatigue(pending.trial);
        if let Some(mut row) = cycle {
            fatigue::add_columns(&mut row, &worst, self.model.dofs.dim);
            self.summary.fatigue = worst;
            match &mut self.trying {
                Some(trying) => trying.hold_cycle(row),
                None => self.tell(observers, || Event::Cycle(&row))?,
            }
        }
        if pending.fields && self.trying.is_none() {
            self.write_fields(observers)?;
        }
        self.summary.cost.phases.write += started.elapsed().as_secs_f64();
        Ok(())
    }

    /// Takes note of an increment for the criteria of fatigue. Where a cycle ends with it, what they say of that.
    fn follow_fatigue(&mut self, trial: Trial) -> Vec<Maximum> {
        let Some(watched) = &self.judges.watched else {
            return Vec::new();
        };
        let Some(increment) = fatigue::increment(&view!(self), watched, trial) else {
            return Vec::new();
        };
        self.frame.fatigue.enter(increment);
        let Some(found) = fatigue::judge(&view!(self), watched, trial) else {
            return Vec::new();
        };
        let worst = fatigue::maxima(&view!(self), &found, trial);
        self.frame.fatigue.close(found);
        worst
    }

    /// Tells observers that fields are due.
    pub(super) fn write_fields(
        &mut self,
        observers: &mut [&mut dyn Observer],
    ) -> Result<(), Error> {
        let views = self.contact.views(&self.frame);
        let State { u, t, .. } = &self.frame.state;
        let interfaces = self.solver.conditions.iter().zip(views);
        let gaps =
            interfaces.map(|(conditions, view)| look::excluded_gaps(view, conditions, u, *t));
        let gaps: Vec<_> = gaps.collect();
        let histories = &mut Arc::make_mut(&mut self.frame.contacts).interfaces;
        for (history, gaps) in histories.iter_mut().zip(gaps) {
            history.note_gaps(&gaps);
        }
        self.tell(observers, || Event::Output)
    }

    /// Judges the last accepted increment.
    fn judge(&mut self) {
        let limits = &self.model.reports.quality;
        let view = view!(self);
        let summary = &mut self.summary;
        view.watch(&mut self.judges.watches);
        view.judge_quality(limits, &mut summary.quality);
        view.judge_travel(
            limits,
            &mut summary.quality,
            &mut summary.largest_rotation,
            &mut summary.findings,
        );
        summary.quality.settle();
        self.judges.unjoined.judge(&view, &mut summary.findings);
    }

    /// Tells observers about iterations.
    pub(crate) fn tell_iterations(&self, seen: &[Progress], observers: &mut [&mut dyn Observer]) {
        for p in seen {
            for observer in observers.iter_mut() {
                // An observer that cannot keep up with iterations does not stop the run.
                let _ = observer.see(&self.analysis(), Event::Iteration(p));
            }
        }
    }

    /// Tells observers what has been noted.
    pub(crate) fn tell_notes(&mut self, observers: &mut [&mut dyn Observer]) -> Result<(), Error> {
        let log = &mut self.solver.log;
        self.summary.solved_by.method = log.method.into();
        self.summary.solved_by.method_reason.clone_from(&log.reason);
        if let Some(engine) = &log.engine {
            self.summary.solved_by.engine = engine.report().into();
        }
        let notes: Vec<String> = log.notes.drain(..).collect();
        for note in notes {
            self.tell(observers, || Event::Note(&note))?;
            // Which method was chosen and why has a place of its own in the summary.
            let reason = &self.summary.solved_by.method_reason;
            if reason.is_empty() || !note.ends_with(reason.as_str()) {
                self.summary.notes.push(note);
            }
        }
        Ok(())
    }

    /// What the last increment did is no guide for the next.
    pub(crate) fn reset_predictor(&mut self) {
        self.frame.course.forget();
        self.solver.condenser.reset_predictor();
    }
}
