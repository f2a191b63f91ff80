//! Steps and output.

use std::collections::BTreeSet;

use stickslip::io::frd::Encoding;
use stickslip::problem::{
    ComplexModes, Coupling, Dynamic, Frd, Increments, Interface, Load, Modes, Support, Temperature,
};
use stickslip::time::scheme::{CentralDifference, Hht, SchemeModel};

use super::harmonic;
use super::job::{Active, Job, Listed};
use super::spans::{duration, times};
use crate::deck::{Deck, Print, Procedure, Step, When};

pub(super) fn write(job: &mut Job) {
    let deck = job.deck;
    output(job);
    if deck.steps.is_empty() {
        job.error(
            Default::default(),
            "the deck has no step",
            "a deck needs *STEP with *STATIC, *DYNAMIC, *FREQUENCY, *COMPLEX FREQUENCY or *STEADY STATE DYNAMICS",
        );
        return;
    }
    for (i, step) in deck.steps.iter().enumerate() {
        job.places.push((format!("step.{}", i + 1), step.place));
        acting::<Support>(job, i);
        acting::<Load>(job, i);
        acting::<Temperature>(job, i);
        acting::<Interface>(job, i);
        acting::<Coupling>(job, i);
        let harmonic = harmonic::harmonic(job, i);
        let table = &mut job.problem.step[i];
        table.harmonic = harmonic;
        match step.procedure {
            Procedure::Frequency { count, range } => table.modes = Some(modes(count, range)),
            Procedure::ComplexFrequency {
                count,
                highest,
                friction_damping,
            } => {
                table.complex_modes = Some(ComplexModes {
                    count,
                    to: (highest > 0.0).then_some(highest),
                    friction_damping,
                    ..ComplexModes::default()
                });
            }
            Procedure::Harmonic { .. } => {}
            _ => table.increments = increments(step),
        }
        table.dynamic = motion(step);
    }
}

/// The tables that act in a step, where some do not act in all.
fn acting<T: Listed>(job: &mut Job, step: usize) {
    let all: Vec<&Active> = job.active.iter().filter(|a| a.kind == T::KIND).collect();
    if all.iter().all(|a| !a.steps.contains(&false)) {
        return;
    }
    let on = all.iter().filter(|a| a.steps[step]);
    let mut names: Vec<String> = on.map(|a| a.name.clone()).collect();
    // What says nothing of steps acts in all.
    let own = |(key, _): &'_ (String, _)| {
        let name = key.strip_prefix(T::KIND)?.strip_prefix('.')?;
        Some(name.to_string())
    };
    let own = job.places.iter().filter_map(own);
    names.extend(own.filter(|n| all.iter().all(|a| a.name != *n)));
    *T::list(&mut job.problem.step[step]) = Some(names);
}

/// The sizes of the increments of a step, as parts of its length.
fn increments(step: &Step) -> Increments {
    let length = duration(step);
    let [first, _, smallest, largest] = times(step);
    let (direct, explicit) = match step.procedure {
        Procedure::Static { direct, .. } => (direct, false),
        Procedure::Dynamic {
            direct, explicit, ..
        } => (direct, explicit),
        _ => (false, false),
    };
    let fraction = |t: f64| (t / length).clamp(1e-12, 1.0);
    let mut sizes = Increments::default();
    if direct && first > 0.0 {
        // As many as a problem file can say: its check tells of too many.
        sizes.fixed = Some((length / first).round().max(1.0) as i64 as usize);
        return sizes;
    }
    // An explicit step finds its increments itself, up to the largest.
    let initial = match (first > 0.0, explicit && largest > 0.0) {
        (true, false) => fraction(first),
        (true, true) => fraction(first.min(largest)),
        (false, true) => fraction(largest),
        (false, false) => 1.0,
    };
    sizes.initial = initial;
    if smallest > 0.0 && !explicit {
        sizes.smallest = fraction(smallest).min(initial);
    }
    if largest > 0.0 {
        sizes.largest = fraction(largest).max(fraction(smallest)).max(initial);
    }
    sizes
}

/// Modes in a range of frequencies, whose ends are zero where they are not given.
fn modes(count: usize, range: [f64; 2]) -> Modes {
    let [from, to] = range.map(|f| (f > 0.0).then_some(f));
    Modes {
        count,
        from,
        to,
        ..Modes::default()
    }
}

/// How motion is integrated.
fn motion(step: &Step) -> Option<Dynamic> {
    let Procedure::Dynamic {
        explicit, alpha, ..
    } = step.procedure
    else {
        return None;
    };
    let [_, _, smallest, _] = times(step);
    let scheme = match explicit {
        // What is the smallest increment elsewhere is one to be reached by mass scaling in an explicit step.
        true => SchemeModel::CentralDifference(CentralDifference {
            mass_scaling: (smallest > 0.0).then_some(smallest),
            ..CentralDifference::default()
        }),
        // CalculiX's own default.
        false => SchemeModel::Hht(Hht {
            alpha: alpha.unwrap_or(-0.05),
        }),
    };
    Some(Dynamic {
        scheme,
        ..Dynamic::default()
    })
}

/// The largest number of increments that divides both.
fn gcd(a: usize, b: usize) -> usize {
    match b {
        0 => a,
        _ => gcd(b, a % b),
    }
}

/// The times of `*TIME POINTS` that lie in a step, in the time of the analysis.
pub(super) fn points(deck: &Deck, name: &str, [start, length]: [f64; 2]) -> Vec<f64> {
    let Some(points) = deck.tables.time_points.get(name) else {
        return Vec::new();
    };
    let from = if points.total_time { 0.0 } else { start };
    let all = points.times.iter().map(|t| from + t);
    all.filter(|t| *t > start && *t <= start + length).collect()
}

fn output(job: &mut Job) {
    let deck = job.deck;
    let of = |p: &Print| match p {
        Print::Node { when, .. }
        | Print::Element { when, .. }
        | Print::Section { when, .. }
        | Print::Contact { when, .. } => match when {
            When::Every(n) => Some(*n),
            When::Times(_) => None,
        },
    };
    let every = deck
        .steps
        .iter()
        .flat_map(|s| s.prints.iter().filter_map(of).chain(s.output_every))
        // Whatever is due is due at an output.
        .reduce(gcd);
    let mut at = Vec::new();
    for (step, [start, length]) in deck.steps.iter().zip(&job.spans) {
        let names: BTreeSet<&String> = step.output_times.iter().collect();
        at.extend(
            names
                .into_iter()
                .flat_map(|n| points(deck, n, [*start, *length])),
        );
    }
    at.sort_by(f64::total_cmp);
    at.dedup();
    job.problem.output.every = every.unwrap_or(0);
    job.problem.output.times = at;
    if let Some(encoding) = deck.output.frd {
        job.problem.output.frd = match encoding {
            Encoding::Text => Frd::Text,
            Encoding::Binary => Frd::Binary,
        };
    }
}
