//! The course of what a step prescribes: growing, at once, or by an amplitude.

use stickslip::problem::AmplitudeTable;

use super::job::Job;
use super::names::problem_name;
use crate::card::Place;
use crate::deck::{Deck, Procedure, Step};

/// Whether what a step changes without an amplitude changes at once, instead of growing over it.
pub(super) fn abrupt(step: &Step) -> bool {
    let dynamic = matches!(step.procedure, Procedure::Dynamic { .. });
    step.abrupt.unwrap_or(dynamic)
}

/// Whether loads without amplitude change otherwise than usual in some step: at once in a static one, or slowly in a dynamic one.
pub(super) fn unusual(deck: &Deck) -> bool {
    deck.steps.iter().any(|s| {
        let dynamic = matches!(s.procedure, Procedure::Dynamic { .. });
        abrupt(s) != dynamic
    })
}

/// The course of a displacement that is prescribed without an amplitude, where it has to be said: the name of an amplitude that makes it jump.
pub(super) fn jump(
    job: &mut Job,
    active: &[bool],
    value: f64,
    place: Place,
    user: &str,
) -> Option<String> {
    let deck = job.deck;
    let (mut jumps, mut grows) = (false, false);
    for (i, step) in deck.steps.iter().enumerate() {
        let begins = active[i] && (i == 0 || !active[i - 1]);
        let dynamic = matches!(step.procedure, Procedure::Dynamic { .. });
        match (begins, abrupt(step), dynamic) {
            (false, ..) => {}
            // Where nothing has moved yet, zero is zero at once.
            _ if value == 0.0 && i == 0 => {}
            (_, false, _) => grows = true,
            (_, true, false) if value != 0.0 => jumps = true,
            // What moved a little before is held at its place from now on.
            (_, true, true) if value == 0.0 => jumps = true,
            (_, true, true) => {
                job.error(
                    place,
                    format!(
                        "what is prescribed here jumps at the start of step {}: values without an amplitude act at once in a *DYNAMIC step",
                        i + 1
                    ),
                    "a displacement that jumps has no end to its velocity: give the *BOUNDARY an AMPLITUDE, or let all loads of the step grow by \
                     *STEP, AMPLITUDE=RAMP",
                );
                return None;
            }
            _ => {
                job.error(
                    place,
                    format!(
                        "AMPLITUDE of *STEP is not supported for what step {} prescribes here",
                        i + 1
                    ),
                    "give the *BOUNDARY an AMPLITUDE of its own",
                );
                return None;
            }
        }
    }
    if jumps && grows {
        job.error(
            place,
            "what is prescribed here jumps in one step and grows in another",
            "give the *BOUNDARY of each step an AMPLITUDE of its own",
        );
    }
    if !jumps {
        return None;
    }
    Some(at_once(job, user, place))
}

/// The course of what acts in full from the start: the name of its amplitude.
pub(super) fn at_once(job: &mut Job, user: &str, place: Place) -> String {
    let end = job.spans.last().map_or(1.0, |[s, l]| s + l);
    let rows = vec![[0.0, 1.0], [end, 1.0]];
    add(job, &format!("{user}-course"), place, rows)
}

fn add(job: &mut Job, wanted: &str, place: Place, table: Vec<[f64; 2]>) -> String {
    let name = job.fresh::<AmplitudeTable>(&problem_name(wanted));
    job.add(&name, place, AmplitudeTable { table });
    name
}

/// An amplitude of the deck over the time of the analysis, as a table of its own for what acts in these steps. Its name. Where a step keeps what the
/// one before gave, an amplitude over the time of a step has run to its end: its last value stays.
pub(super) fn amplitude(
    job: &mut Job,
    name: &str,
    active: &[bool],
    kept: &[bool],
    user: &str,
) -> String {
    let Some(a) = job.deck.tables.amplitudes.get(name) else {
        return name.to_string();
    };
    let mut rows: Vec<[f64; 2]> = Vec::new();
    if a.total_time {
        rows.clone_from(&a.rows);
    } else {
        // Time starts anew in every step.
        let spans = job.spans.iter().zip(active.iter().zip(kept));
        for ([start, length], (_, kept)) in spans.filter(|(_, (on, _))| **on) {
            if let (true, Some(last)) = (*kept, rows.last().copied()) {
                push(&mut rows, [start + length, last[1]]);
                continue;
            }
            push(&mut rows, [*start, value(&a.rows, 0.0)]);
            for row in a.rows.iter().filter(|r| r[0] >= 0.0) {
                if row[0] <= *length * (1.0 + 1e-12) {
                    push(&mut rows, [start + row[0], row[1]]);
                }
            }
            push(&mut rows, [start + length, value(&a.rows, *length)]);
        }
    }
    if rows.len() == 1 {
        // A table has two rows.
        let end = job.spans.last().map_or(1.0, |[s, l]| s + l);
        rows.push([rows[0][0].max(end) + 1.0, rows[0][1]]);
    }
    let place = a.place;
    add(job, &format!("{name}-{user}"), place, rows)
}

/// The course of a load that ends at once with some steps, as a table of its own: what the steps before say, then nothing.
pub(super) fn ending(
    job: &mut Job,
    name: Option<&String>,
    active: &[bool],
    kept: &[bool],
    ends: &[bool],
    user: &str,
) -> String {
    let given = name.and_then(|n| job.deck.tables.amplitudes.get(n));
    let mut rows: Vec<[f64; 2]> = Vec::new();
    let mut before = 0.0;
    for (i, [start, length]) in job.spans.clone().into_iter().enumerate() {
        let end = start + length;
        let at_once = abrupt(&job.deck.steps[i]);
        match (given, active[i]) {
            // It stays as it is.
            (Some(a), true) if kept[i] && !a.total_time => {}
            (Some(a), true) => {
                let from = if a.total_time { 0.0 } else { start };
                push(&mut rows, [start, value(&a.rows, start - from)]);
                let within = |t: f64| t > start && t < end;
                for row in a.rows.iter().filter(|r| within(from + r[0])) {
                    push(&mut rows, [from + row[0], row[1]]);
                }
                before = value(&a.rows, end - from);
            }
            (None, true) => {
                push(&mut rows, [start, if at_once { 1.0 } else { before }]);
                before = 1.0;
            }
            // It falls where loads change slowly, unless something takes its place.
            (_, false) => {
                let fades = !ends[i] && !at_once;
                push(&mut rows, [start, if fades { before } else { 0.0 }]);
                before = 0.0;
            }
        }
        push(&mut rows, [end, before]);
    }
    let place = job
        .deck
        .steps
        .first()
        .map_or_else(Default::default, |s| s.place);
    let place = given.map_or(place, |a| a.place);
    add(job, &format!("{user}-course"), place, rows)
}

/// Adds a row; one at the time of the last comes an instant later, as times increase; increments land once on the two.
fn push(rows: &mut Vec<[f64; 2]>, mut row: [f64; 2]) {
    if let Some(last) = rows.last() {
        if *last == row {
            return;
        }
        if row[0] <= last[0] {
            if row[1] == last[1] {
                return;
            }
            row[0] = last[0].next_up();
        }
    }
    rows.push(row);
}

fn value(rows: &[[f64; 2]], t: f64) -> f64 {
    let i = rows.partition_point(|r| r[0] <= t);
    match (i.checked_sub(1).and_then(|k| rows.get(k)), rows.get(i)) {
        (Some(a), Some(b)) => a[1] + (b[1] - a[1]) * (t - a[0]) / (b[0] - a[0]),
        (Some(a), None) => a[1],
        (None, Some(b)) => b[1],
        (None, None) => 0.0,
    }
}
