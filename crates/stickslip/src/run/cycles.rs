//! Jumps over cycles that are chosen by the error they make.
//!
//! A cycle that stands for `N` wears as much as that, by the backward Euler rule: what it wears off opens its own gap. With the amounts `w` that a cycle wears off, place
//! by place, in this one and in the one before, that is off by `N |Δw| / 2`, summed over places. It may be a part, the error that is asked for, of the mean of two things: what the block wears off,
//! `N Σ w`, and what has been worn off in the step so far, `V`, by the share `N` of all cycles. Summed over the step that is no more than the error times what is worn off in all, as
//! wear makes differences of depth smaller and not larger.
//!
//! Where nothing wears, what friction keeps settles within some cycles, and cycles change ever less: once all that is to come, as a geometric series, is no more than the error, one stands for all that are
//! left, and is taken back if it shows that they have changed by more. Where that cannot be seen, and with wear, they are as good as equal if the last change, over and over again, comes to no more than the error.
//!
//! A block begins with a checkpoint. What it finds is reported when it is over; where it stands for too many it is taken back to that checkpoint, and nobody is told.

use super::jumps::Jumps;
use super::position::Increments;
use super::simulation::Simulation;
use super::trying::Trying;
use crate::error::Error;
use crate::model::cycling::{Block, ChosenJump};
use crate::results::observer::{Event, Observer};

/// The error that is aimed at, over the one that is allowed.
const SAFETY: f64 = 0.8;
/// How much longer a jump is at most than the one before, and how much shorter when it is tried again.
const GROWTH: f64 = 3.0;
const SHRINKAGE: f64 = 0.2;
/// A block in which an increment fails is tried again with this part of its cycles.
const AFTER_FAILURE: f64 = 0.25;
/// Part of a cycle that is rounding.
const ON_TIME: f64 = 1e-9;

/// How a block went: the largest error, over that which is allowed, of interfaces that wear and of all.
#[derive(Clone, Copy, Default)]
struct Verdict {
    wearing: f64,
    all: f64,
}

impl Simulation {
    fn chosen(&self) -> Option<(ChosenJump, f64, usize)> {
        let cycles = self.step().cycles?;
        Some((cycles.chosen()?, cycles.period, cycles.count))
    }

    /// What sliding has taken, by interface and place.
    fn taken(&self) -> Vec<Vec<f64>> {
        let interfaces = self.contact.interfaces.iter();
        interfaces.map(|i| i.taken()).collect()
    }

    /// Begins a block where one is to begin; the analysis stands between two increments.
    pub(super) fn begin_block(&mut self, running: Increments) -> Increments {
        let Some((chosen, period, count)) = self.chosen() else {
            return running;
        };
        let before = self.frame.block.before;
        if self.trying.is_some() || before >= count {
            return running;
        }
        self.steps.running = Some(running);
        let start = self.checkpoint_with(self.working());
        let Some(mut running) = self.steps.running.take() else {
            unreachable!("it has just been put there")
        };
        let taken = self.taken();
        let jumps = &mut running.jumps;
        jumps.start = taken;
        if jumps.kept == 0 && jumps.rejected == 0 {
            jumps.wish = chosen.first as f64;
        }
        let step = self.step();
        // Equal jumps to the next time of output.
        let times = self.model.output.times.iter();
        let due = times.map(|t| ((t - step.start) / period - ON_TIME).ceil().max(0.0) as usize);
        let target = due.filter(|&n| n > before).min().unwrap_or(count);
        let left = target.min(count) - before;
        let wish = jumps.wish.min(chosen.largest.unwrap_or(count) as f64);
        let parts = (left as f64 / wish.max(1.0)).ceil().max(1.0) as usize;
        let block = Block {
            before,
            stands_for: left.div_ceil(parts),
        };
        let at = running.stepper.leap(step.start + block.begins(period));
        self.frame.block = block;
        self.frame.state.t = at;
        self.solver.condenser.pass_time(at);
        self.forget_direction();
        self.trying = Some(Trying::from(start));
        running
    }

    /// Judges the block that ends with an increment at a time, if one does: keeps it, or takes it back.
    pub(super) fn end_block(
        &mut self,
        running: &mut Increments,
        t: f64,
        observers: &mut [&mut dyn Observer],
    ) -> Result<(), Error> {
        let Some((chosen, period, count)) = self.chosen() else {
            return Ok(());
        };
        let Block { before, stands_for } = self.frame.block;
        let after = before + stands_for;
        if (t - self.step().start) / period < after as f64 - ON_TIME {
            return Ok(());
        }
        self.flush(observers)?;
        let verdict = self.judge_block(&mut running.jumps, count);
        let n = stands_for as f64;
        let wears = self.contact.interfaces.iter().any(|i| i.wears());
        let jumps = &mut running.jumps;
        if let Some(verdict) = verdict {
            jumps.note_change(verdict.all);
        }
        let governing = verdict.map_or(0.0, |v| v.wearing) / chosen.error;
        if governing > 1.0 && stands_for > 1 {
            let part = (SAFETY / governing).max(SHRINKAGE);
            return self.take_block_back(running, (n * part).floor());
        }
        if !wears && jumps.overshot(stands_for, chosen.error) {
            return self.take_block_back(running, 1.0);
        }
        jumps.kept += 1;
        jumps.wish = match verdict {
            // The first has nothing to be compared with.
            None => n,
            Some(_) if !wears => 1.0,
            Some(_) => n * (SAFETY / governing.max(1e-12)).clamp(SHRINKAGE, GROWTH),
        };
        let left = count - after;
        let repeats = verdict.is_some_and(|v| {
            v.all * left as f64 <= chosen.error * n || !wears && jumps.settles(chosen.error)
        });
        if repeats && left as f64 > jumps.wish.max(1.0) {
            jumps.wish = left as f64;
            if chosen.largest.is_none_or(|most| most >= left) {
                self.solver.log.notes.push(format!(
                    "step `{}`: what a cycle dissipates and wears off stays the same from cycle {after} on, but for the error: the next one stands for all that are left",
                    self.step().name
                ));
            }
        }
        self.frame.block = Block {
            before: after,
            stands_for: 0,
        };
        self.release_block(observers)
    }

    /// What a block took, beside the one before; `None` of the first.
    fn judge_block(&self, jumps: &mut Jumps, count: usize) -> Option<Verdict> {
        let n = self.frame.block.stands_for as f64;
        let taken = self.taken();
        let known = !jumps.rates.is_empty();
        let mut verdict = Verdict::default();
        let (mut rates, mut totals) = (Vec::new(), Vec::new());
        for (i, taken) in taken.iter().enumerate() {
            // Wear has been counted as often as the block stands for, what is dissipated once.
            let wears = self.contact.interfaces[i].wears();
            let often = if wears { n } else { 1.0 };
            let start = jumps.start.get(i).filter(|s| s.len() == taken.len());
            let rate: Vec<f64> = match start {
                Some(start) => (taken.iter().zip(start))
                    .map(|(b, a)| (b - a) / often)
                    .collect(),
                None => taken.iter().map(|b| b / often).collect(),
            };
            let sum: f64 = rate.iter().map(|r| r.abs()).sum();
            let total = jumps.total.get(i).copied().unwrap_or(0.0) + sum * n;
            let last = jumps.rates.get(i).filter(|r| r.len() == rate.len());
            let change: f64 = match last {
                Some(last) => rate.iter().zip(last).map(|(b, a)| (b - a).abs()).sum(),
                None => sum,
            };
            let scale = sum + total / count as f64;
            if known && scale > 0.0 {
                verdict.all = verdict.all.max(change / scale);
                if wears {
                    verdict.wearing = verdict.wearing.max(change / scale);
                }
            }
            rates.push(rate);
            totals.push(total);
        }
        jumps.rates = rates;
        jumps.total = totals;
        known.then_some(verdict)
    }

    /// Goes back to where the block began, which is to stand for so many cycles then.
    fn take_block_back(&mut self, running: &mut Increments, wish: f64) -> Result<(), Error> {
        let Some(trying) = self.trying.take() else {
            return Ok(());
        };
        let phases = self.summary.phases;
        self.go_back_to(trying.start)?;
        self.summary.phases = phases;
        self.summary.cycles_taken_back += 1;
        if let Some(mut back) = self.steps.running.take() {
            back.jumps.wish = wish.max(1.0);
            back.jumps.rejected += 1;
            *running = back;
        }
        Ok(())
    }

    /// The same after an increment that failed, where the block may stand for fewer; `false` where it may not.
    pub(super) fn try_fewer_cycles(&mut self, running: &mut Increments) -> Result<bool, Error> {
        let n = self.frame.block.stands_for;
        if self.trying.is_none() || n < 2 {
            return Ok(false);
        }
        let wish = (n as f64 * AFTER_FAILURE).floor();
        self.take_block_back(running, wish).map(|()| true)
    }

    /// The same as often, where increments do not hold with condensed bodies.
    pub(super) fn try_block_again(&mut self) -> Result<bool, Error> {
        let Some(trying) = self.trying.take() else {
            return Ok(false);
        };
        self.go_back_to(trying.start).map(|()| true)
    }

    /// Tells what was held back.
    pub(super) fn release_block(
        &mut self,
        observers: &mut [&mut dyn Observer],
    ) -> Result<(), Error> {
        let Some(trying) = self.trying.take() else {
            return Ok(());
        };
        for row in &trying.rows {
            self.tell(observers, || Event::Increment(row))?;
        }
        if let Some(row) = &trying.cycle {
            self.tell(observers, || Event::Cycle(row))?;
        }
        match trying.fields {
            true => self.put_out(observers),
            false => Ok(()),
        }?;
        self.tell_notes(observers)
    }
}
