//! Accepted increments on their way into the results.

use std::collections::VecDeque;
use std::time::Instant;

use super::accepted::Accepted;
use super::history;
use super::run::{Advance, Event, Observer, Simulation};
use crate::body::couplings::CouplingsMemory;
use crate::contact::interface::History;
use crate::error::Error;
use crate::newton::Progress;
use crate::newton::condensed::Amplitudes;
use crate::system::State;
use crate::time::Trial;

/// An accepted increment that nobody has been told of.
pub(super) struct Pending {
    pub trial: Trial,
    pub accepted: Accepted,
    /// Number of the increment in its step, and of the attempt.
    pub increment: usize,
    pub attempt: usize,
    /// Whether fields, and a row of the history, are due.
    pub fields: bool,
    pub row: bool,
    /// Newton iterations nobody has been told of.
    pub seen: Vec<Progress>,
    /// The histories of the interfaces after it; empty if it is reported at once.
    pub histories: Vec<History>,
    /// The same of the couplings.
    pub couplings: CouplingsMemory,
    /// The loads of a condensed increment and the displacements of the candidates: its interior is not known yet.
    pub found: Option<(Amplitudes, Vec<f64>)>,
}

impl Pending {
    /// It at a glance.
    pub fn advance(&self) -> Advance {
        Advance {
            increment: self.increment,
            attempt: self.attempt,
            iterations: self.accepted.iterations,
            time: self.trial.to,
            residual: self.accepted.residual,
            tally: self.accepted.tally,
        }
    }
}

/// Increments whose interiors are known, on their way to the observers.
pub(super) struct Recovered {
    queue: VecDeque<Pending>,
    /// The histories of the interfaces after the last of them.
    now: Vec<History>,
    /// And the couplings.
    coupled: CouplingsMemory,
}

/// Increments whose interiors are found in one sweep. Fixed, so that no number depends on when somebody looks.
pub(super) const TOGETHER: usize = 16;

/// Vectors by dof that such an increment holds: displacements, forces of contact and loads, and what is swept to find its interior.
const VECTORS: usize = 4;

impl Simulation {
    /// Memory that an increment takes until it is reported `[bytes]`.
    pub(super) fn pending_bytes(&self) -> usize {
        let interfaces = self.model.interfaces.iter();
        let histories: usize = interfaces.map(|i| i.history_bytes()).sum();
        histories + VECTORS * size_of::<f64>() * self.model.dofs.count()
    }

    /// Goes on from an accepted increment: at once, or with others in one sweep.
    pub(super) fn go_on(
        &mut self,
        mut pending: Pending,
        last: bool,
        observers: &mut [&mut dyn Observer],
    ) -> Result<(), Error> {
        if self.condensed.is_none() {
            let from = std::mem::take(&mut self.state);
            self.commit(&from, pending.trial, &pending.accepted);
            let length = pending.trial.to - pending.trial.from;
            self.state = from;
            self.previous = Some((length, self.state.u.clone()));
            return self.report(pending, observers);
        }
        self.move_ahead(&mut pending);
        self.pending.push(pending);
        if last || self.pending.len() >= TOGETHER {
            self.recover_pending();
        }
        Ok(())
    }

    /// Finds the interiors of all pending increments and reports them.
    pub(super) fn flush(&mut self, observers: &mut [&mut dyn Observer]) -> Result<(), Error> {
        self.recover_pending();
        while self.report_next(observers)? {}
        Ok(())
    }

    /// Finds the interiors of all pending increments.
    pub(super) fn recover_pending(&mut self) {
        if self.pending.is_empty() {
            return;
        }
        let mut pending = std::mem::take(&mut self.pending);
        self.recover(&mut pending);
        // The interfaces tell what they knew after each of them.
        let interfaces = self.model.interfaces.iter_mut();
        self.recovered = Some(Recovered {
            queue: pending.into(),
            now: interfaces.map(|i| std::mem::take(&mut i.history)).collect(),
            coupled: std::mem::take(&mut self.model.couplings.memory),
        });
    }

    /// Reports the next of the increments whose interiors are known; `false` if there is none.
    pub(super) fn report_next(
        &mut self,
        observers: &mut [&mut dyn Observer],
    ) -> Result<bool, Error> {
        let Some(mut recovered) = self.recovered.take() else {
            return Ok(false);
        };
        let mut outcome = Ok(());
        if let Some(mut one) = recovered.queue.pop_front() {
            self.remember(std::mem::take(&mut one.histories));
            self.model.couplings.memory = std::mem::take(&mut one.couplings);
            outcome = self.complete(&mut one);
            if outcome.is_ok() {
                outcome = self.report(one, observers);
            }
        }
        if recovered.queue.is_empty() || outcome.is_err() {
            self.remember(recovered.now);
            self.model.couplings.memory = recovered.coupled;
        } else {
            self.recovered = Some(recovered);
        }
        outcome.map(|()| true)
    }

    fn remember(&mut self, histories: Vec<History>) {
        for (interface, history) in self.model.interfaces.iter_mut().zip(histories) {
            interface.history = history;
        }
    }

    /// Enters an increment into the ledger and tells the observers.
    fn report(
        &mut self,
        pending: Pending,
        observers: &mut [&mut dyn Observer],
    ) -> Result<(), Error> {
        self.tell(&pending.seen, observers);
        let counts = (pending.increment, pending.attempt);
        let effort = self.book(pending.accepted);
        let started = Instant::now();
        if pending.row {
            let row = history::row(self, pending.trial, effort, counts);
            let named = row.names.iter().cloned().zip(row.values.iter().copied());
            self.summary.last = named.collect();
            let limits = self.model.quality;
            self.judge_quality(&limits);
            self.judge_unjoined();
            for observer in observers.iter_mut() {
                observer.see(self, Event::Increment(&row))?;
            }
        }
        if pending.fields {
            let State { u, t, .. } = &self.state;
            for interface in &mut self.model.interfaces {
                interface.measure(u, *t);
            }
            for observer in observers.iter_mut() {
                observer.see(self, Event::Output)?;
            }
        }
        self.summary.phases.write += started.elapsed().as_secs_f64();
        Ok(())
    }

    /// Tells observers what has been noted.
    pub(super) fn tell_notes(&mut self, observers: &mut [&mut dyn Observer]) -> Result<(), Error> {
        for note in std::mem::take(&mut self.notes) {
            for observer in observers.iter_mut() {
                observer.see(self, Event::Note(&note))?;
            }
            // Which method was chosen and why has a place of its own in the summary.
            let reason = &self.summary.method_reason;
            if reason.is_empty() || !note.ends_with(reason.as_str()) {
                self.summary.notes.push(note);
            }
        }
        Ok(())
    }

    /// What the last increment did is no guide for the next.
    pub(super) fn forget_direction(&mut self) {
        self.previous = None;
        if let Some(condensed) = &mut self.condensed {
            condensed.forget_direction();
        }
    }
}
