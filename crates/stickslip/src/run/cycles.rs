//! Jumps over cycles that are chosen by the error they make.
//!
//! A cycle that stands for `N` wears as much as that, by the backward Euler rule: what it wears off opens its own gap. Where something wears a jump is made twice from one state, by one cycle
//! and by two that stand for half of its cycles each. The two are kept, and how they differ from the one is what they are off by ([`jump_error`](super::jump_error)). With all jumps before that may be a part,
//! the error that is asked for, of the volume and of the greatest depth that have been worn off so far, on each surface; where it is more the jump is taken back. So the last jump is judged like all
//! others, and times of output in between are as good as the end. Where so few cycles are allowed that computing each costs no more, each is computed, and nothing is off.
//!
//! Where nothing wears, what friction keeps settles within some cycles, and cycles change ever less: once all that is to come, as a geometric series, is no more than the error, one stands for all that are
//! left, and is taken back if it shows that they have changed by more. Where that cannot be seen, they are as good as equal if the last change, over and over again, comes to no more than the error.
//!
//! A block begins with a checkpoint. What it finds is reported when it is over; where it stands for too many it is taken back to that checkpoint, and is not reported.

use super::checkpoint::Checkpoint;
use super::cycle_block::CycleBlock;
use super::jump_error::Place;
use super::jumps::{Amounts, Halved, Jumps};
use super::parts::Run;
use super::pending::flush;
use super::position::Increments;
use super::restart::go_back_to;
use crate::contact::look;
use crate::error::Error;
use crate::model::cycling::{Block, ChosenJump};
use crate::number::digits;
use crate::results::observer::{Event, Observer};
use crate::tolerance::SAME;

/// The error that is aimed at, over the one that is allowed: one that is missed by a quarter costs no jump. With 0.24 and 2.4 the wear of the fretting contact
/// in partial slip, `fretting::partial_slip_wears_until_only_what_sticks_carries`, stays within what was asked for.
const SAFETY: f64 = 0.8;
/// How much longer a jump is at most than the one before, so that a lucky one does not lead far. With 1.2 and 9 the same test passes.
const JUMP_GROWTH: f64 = 3.0;

/// Fewest cycles of a jump: as a whole and in two halves it costs three.
const FEWEST: usize = 4;
/// Cycles that a jump may always be tried with, however short the one before: twice the fewest. With 3.2 and 24 the same test passes.
const ALWAYS_TRIED: f64 = 8.0;

fn chosen(run: &Run) -> Option<(ChosenJump, f64, usize)> {
    let cycles = run.step().cycles?;
    Some((cycles.chosen()?, cycles.period, cycles.count))
}

/// What sliding has taken, by interface and place.
fn taken(run: &Run) -> Vec<Vec<f64>> {
    let interfaces = run.contact.views(&run.frame);
    interfaces.map(|i| look::taken(i)).collect()
}

/// Whether a block is to begin; the analysis stands between two increments.
pub(super) fn begins_block(run: &Run) -> bool {
    let count = chosen(run).map_or(0, |(_, _, count)| count);
    run.block.is_none() && run.frame.block.before < count
}

/// Begins a block at a checkpoint.
pub(super) fn begin_block(run: &mut Run, running: &mut Increments, start: Checkpoint) {
    let Some((chosen, period, count)) = chosen(run) else {
        return;
    };
    let before = run.frame.block.before;
    let taken = taken(run);
    let jumps = &mut running.jumps;
    jumps.start = taken;
    if jumps.kept == 0 && jumps.rejected == 0 {
        jumps.wish = match wears(run) && chosen.first > 1 {
            true => 2.0 * chosen.first as f64,
            false => chosen.first as f64,
        };
    }
    let step = run.step();
    // Equal jumps to the next time of output.
    let times = run.model.reports.output.times.iter();
    let due = times.map(|t| ((t - step.start) / period - SAME).ceil().max(0.0) as usize);
    let target = due.filter(|&n| n > before).min().unwrap_or(count);
    let left = target.min(count) - before;
    let largest = chosen.largest.unwrap_or(count) as f64;
    let stands_for = match (&jumps.trial, wears(run)) {
        (Some(trial), _) if trial.whole.is_some() => trial.halves()[0],
        (_, false) => equal(left, jumps.wish.min(largest)),
        (_, true) => {
            let n = equal(left, jumps.wish.min(2.0 * largest));
            let single = n < FEWEST;
            jumps.trial = (!single).then(|| Halved {
                cycles: n,
                ..Halved::default()
            });
            if single { 1 } else { n }
        }
    };
    set_block(run, running, before, stands_for, period);
    run.block = Some(CycleBlock::from(start));
}

/// Lets a block begin.
fn set_block(
    run: &mut Run,
    running: &mut Increments,
    before: usize,
    stands_for: usize,
    period: f64,
) {
    let block = Block { before, stands_for };
    let at = (running.stepper).leap(run.step().start + block.begins(period));
    run.frame.block = block;
    run.frame.state.t = at;
    run.solver.condenser.pass_time(at);
    run.reset_predictor();
}

fn wears(run: &Run) -> bool {
    run.contact.interfaces.iter().any(|i| i.wears())
}

/// Judges the block that ends with an increment at a time, if one does: keeps it, or takes it back.
pub(super) fn end_block(
    run: &mut Run,
    running: &mut Increments,
    t: f64,
    observers: &mut [&mut dyn Observer],
) -> Result<(), Error> {
    let Some((chosen, period, count)) = chosen(run) else {
        return Ok(());
    };
    let Block { before, stands_for } = run.frame.block;
    let after = before + stands_for;
    if (t - run.step().start) / period < after as f64 - SAME {
        return Ok(());
    }
    flush(run, observers)?;
    if wears(run) {
        return end_wearing_block(run, running, chosen, period, count, observers);
    }
    let change = judge_block(run, &mut running.jumps);
    let n = stands_for as f64;
    let jumps = &mut running.jumps;
    if let Some(change) = change {
        jumps.note_change(change);
    }
    if jumps.overshot(stands_for, chosen.error) {
        return take_block_back(run, running, 1.0);
    }
    jumps.kept += 1;
    jumps.wish = match change {
        // The first has nothing to be compared with.
        None => n,
        Some(_) => 1.0,
    };
    let left = count - after;
    let repeats = change.is_some_and(|change| {
        change * left as f64 <= chosen.error * n || jumps.settles(chosen.error)
    });
    if repeats && left as f64 > jumps.wish.max(1.0) {
        jumps.wish = left as f64;
        if chosen.largest.is_none_or(|most| most >= left) {
            run.solver.log.notes.push(format!(
                "step `{}`: the dissipation of a cycle is constant from cycle {after} on, within the error: the next cycle represents all remaining ones",
                run.step().name
            ));
        }
    }
    run.frame.block = Block {
        before: after,
        stands_for: 0,
    };
    release_block(run, observers)
}

/// Goes on from a block that is over where something wears: from a whole to its halves, from one half to the other, and from both to what they tell.
fn end_wearing_block(
    run: &mut Run,
    running: &mut Increments,
    chosen: ChosenJump,
    period: f64,
    count: usize,
    observers: &mut [&mut dyn Observer],
) -> Result<(), Error> {
    let Block { before, stands_for } = run.frame.block;
    let after = before + stands_for;
    let worn = difference(&taken(run), &running.jumps.start);
    let places = places(run);
    let jumps = &mut running.jumps;
    let trial = jumps.trial.take();
    let (whole, first, halves) = match trial {
        None => {
            let change = (!jumps.rates.is_empty()).then(|| absolute(&worn, &jumps.rates));
            jumps.made.enter(&worn, change);
            jumps.rates = worn;
            let reach = ALWAYS_TRIED.max(JUMP_GROWTH);
            jumps.wish = (jumps.made).reach(&places, &jumps.rates, SAFETY * chosen.error, reach);
            return keep_block(run, running, after, count, observers);
        }
        Some(Halved {
            whole: Some(whole),
            first: Some(first),
            cycles,
        }) => {
            let halved = Halved {
                cycles,
                ..Halved::default()
            };
            (whole, first, halved.halves())
        }
        Some(trial) if trial.whole.is_some() => {
            let next = trial.halves()[1];
            jumps.trial = Some(Halved {
                first: Some(worn),
                ..trial
            });
            set_block(run, running, after, next, period);
            return Ok(());
        }
        Some(trial) => {
            let trial = Halved {
                whole: Some(worn),
                ..trial
            };
            return go_on_with(run, running, Some(trial), 1.0);
        }
    };
    let last = difference(&worn, &first);
    let rates = scaled(&last, 1.0 / halves[1] as f64);
    let made = jumps.made.with_halves(&whole, &worn, halves);
    let cycles = halves[0] + halves[1];
    if made.off(&places).worst() > chosen.error {
        // What comes before the jump is as it was; how rates change is known better now.
        let known = made.of_change(&jumps.made);
        let reach = known.reach(&places, &rates, SAFETY * chosen.error, 0.5 * cycles as f64);
        // Only a jump that may still be a fifth as long is tried again by its half.
        let halved = halves[0] >= FEWEST && reach >= 0.2 * cycles as f64;
        let trial = halved.then_some(Halved {
            cycles: halves[0],
            whole: Some(first),
            first: None,
        });
        run.summary.attempts.cycles_taken_back += 1;
        return go_on_with(run, running, trial, reach);
    }
    jumps.made = made;
    jumps.rates = rates;
    let most = (JUMP_GROWTH * cycles as f64).max(ALWAYS_TRIED);
    jumps.wish = (jumps.made).reach(&places, &jumps.rates, SAFETY * chosen.error, most);
    keep_block(run, running, after, count, observers)
}

/// Keeps what a block has found, and tells it.
fn keep_block(
    run: &mut Run,
    running: &mut Increments,
    after: usize,
    count: usize,
    observers: &mut [&mut dyn Observer],
) -> Result<(), Error> {
    running.jumps.kept += 1;
    run.frame.block = Block {
        before: after,
        stands_for: 0,
    };
    let off = running.jumps.made.off(&places(run));
    if after >= count && off.worst() > 0.0 {
        run.solver.log.notes.push(format!(
            "step `{}`: jumps over cycles are off by {} of the worn volume and by {} of the greatest depth, as halving each tells",
            run.step().name,
            digits(off.volume, 2),
            digits(off.depth, 2)));
    }
    release_block(run, observers)
}

/// Goes back to where the block began, and goes on with a jump of which the whole is known, or another.
fn go_on_with(
    run: &mut Run,
    running: &mut Increments,
    trial: Option<Halved>,
    wish: f64,
) -> Result<(), Error> {
    let (taken_back, rejected) = (
        run.summary.attempts.cycles_taken_back,
        running.jumps.rejected,
    );
    take_block_back(run, running, wish)?;
    run.summary.attempts.cycles_taken_back = taken_back;
    running.jumps.rejected = rejected + usize::from(trial.is_none());
    running.jumps.trial = trial;
    Ok(())
}

/// Where interfaces wear.
fn places(run: &Run) -> Vec<Vec<Place>> {
    let interfaces = run.contact.views(&run.frame);
    let wearing = interfaces.map(|i| match i.wears() {
        true => look::wear_places(i),
        false => Vec::new(),
    });
    wearing.collect()
}

/// By how much a cycle dissipates what the one before did not, place by place and relative to all that it does; `None` of the first.
fn judge_block(run: &Run, jumps: &mut Jumps) -> Option<f64> {
    let rates = difference(&taken(run), &jumps.start);
    let known = !jumps.rates.is_empty();
    let changes = absolute(&rates, &jumps.rates);
    let sum = |all: &[f64]| all.iter().map(|r| r.abs()).sum::<f64>();
    let each = changes.iter().zip(&rates).map(|(change, rate)| {
        let scale = sum(rate);
        if scale > 0.0 {
            sum(change) / scale
        } else {
            0.0
        }
    });
    let change = each.fold(0.0, f64::max);
    jumps.rates = rates;
    known.then_some(change)
}

/// Goes back to where the block began, which is to stand for so many cycles then.
fn take_block_back(run: &mut Run, running: &mut Increments, wish: f64) -> Result<(), Error> {
    let Some(block) = run.block.take() else {
        return Ok(());
    };
    let phases = run.summary.cost.phases;
    go_back_to(run, block.start)?;
    run.summary.cost.phases = phases;
    run.summary.attempts.cycles_taken_back += 1;
    if let Some(mut back) = run.steps.running.take() {
        back.jumps.wish = wish.max(1.0);
        back.jumps.rejected += 1;
        back.jumps.trial = None;
        *running = back;
    }
    Ok(())
}

/// The same after an increment that failed, where the block may stand for fewer; `false` where it may not.
pub(super) fn try_fewer_cycles(run: &mut Run, running: &mut Increments) -> Result<bool, Error> {
    let n = run.frame.block.stands_for;
    if run.block.is_none() || n < 2 {
        return Ok(false);
    }
    // A block in which an increment fails is tried again with a quarter of its cycles.
    let wish = (n as f64 * 0.25).floor();
    take_block_back(run, running, wish).map(|()| true)
}

/// The same as often, where increments do not hold with condensed bodies.
pub(super) fn try_block_again(run: &mut Run) -> Result<bool, Error> {
    let Some(block) = run.block.take() else {
        return Ok(false);
    };
    go_back_to(run, block.start).map(|()| true)
}

/// Tells what was held back.
pub(super) fn release_block(
    run: &mut Run,
    observers: &mut [&mut dyn Observer],
) -> Result<(), Error> {
    let Some(block) = run.block.take() else {
        return Ok(());
    };
    for row in &block.rows {
        run.tell(observers, || Event::Increment(row))?;
    }
    for row in &block.cycles {
        run.tell(observers, || Event::Cycle(row))?;
    }
    match block.fields {
        true => run.write_fields(observers),
        false => Ok(()),
    }?;
    run.tell_notes(observers)
}

/// Cycles of the first of equal blocks that are no longer than wished for.
fn equal(left: usize, wish: f64) -> usize {
    let parts = (left as f64 / wish.max(1.0)).ceil().max(1.0) as usize;
    left.div_ceil(parts)
}

/// Amounts less others, of which some may not be there yet.
fn difference(after: &[Vec<f64>], before: &[Vec<f64>]) -> Amounts {
    let each = after.iter().enumerate().map(|(i, after)| -> Vec<f64> {
        let own = before.get(i);
        let places = after.iter().enumerate();
        let at = |k: usize| own.and_then(|own| own.get(k)).copied().unwrap_or(0.0);
        places.map(|(k, a)| a - at(k)).collect()
    });
    each.collect()
}

fn absolute(after: &[Vec<f64>], before: &[Vec<f64>]) -> Amounts {
    let mut out = difference(after, before);
    out.iter_mut().flatten().for_each(|v| *v = v.abs());
    out
}

fn scaled(amounts: &[Vec<f64>], factor: f64) -> Amounts {
    let each = amounts.iter();
    each.map(|own| own.iter().map(|v| factor * v).collect())
        .collect()
}
