//! Steps and output.

use std::collections::{BTreeMap, BTreeSet};

use stickslip::io::frd::Encoding;

use super::harmonic;
use super::job::Job;
use super::spans::{duration, times};
use super::toml;
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
        job.places.push((format!("step.{i}"), step.place));
        job.out.line("");
        job.out.line("[[step]]");
        let length = duration(step);
        job.out
            .line(&format!("duration = {}", toml::number(length)));
        acting(job, i);
        match modes(step).or_else(|| harmonic::line(job, i)) {
            Some(line) => job.out.line(&line),
            None => {
                let sizes = increments(step).join(", ");
                job.out.line(&format!("increments = {{ {sizes} }}"));
            }
        }
        if let Some(line) = motion(step) {
            job.out.line(&line);
        }
        let slides = job.sliding.iter().filter(|(s, _)| *s == i);
        slides.for_each(|(_, line)| job.out.line(line));
        changes(job, i);
        let tensions = job.tensions.iter().filter(|(s, _)| *s == i);
        tensions.for_each(|(_, line)| job.out.line(line));
    }
}

/// The tables that act in a step, where some do not act in all.
fn acting(job: &mut Job, step: usize) {
    for (kind, table) in [
        ("supports", None),
        ("loads", None),
        ("temperatures", None),
        ("interfaces", Some("interface.")),
        ("couplings", Some("coupling.")),
    ] {
        let all: Vec<&(&str, String, Vec<bool>)> =
            job.active.iter().filter(|a| a.0 == kind).collect();
        if all.iter().any(|a| a.2.contains(&false)) {
            let on = all.iter().filter(|a| a.2[step]);
            let mut names: Vec<String> = on.map(|a| a.1.clone()).collect();
            if let Some(table) = table {
                // What says nothing of steps acts in all.
                let listed = |n: &str| all.iter().any(|a| a.1 == n);
                let always = job.places.iter();
                let always = always.filter_map(|(k, _)| k.strip_prefix(table));
                names.extend(always.filter(|n| !listed(n)).map(str::to_string));
            }
            job.out.line(&format!("{kind} = {}", toml::texts(&names)));
        }
    }
}

/// The sizes of the increments of a step, as parts of its length.
fn increments(step: &Step) -> Vec<String> {
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
    let mut sizes = Vec::new();
    if direct && first > 0.0 {
        sizes.push(format!("fixed = {}", (length / first).round().max(1.0)));
        return sizes;
    }
    // An explicit step finds its increments itself, up to the largest.
    let initial = match (first > 0.0, explicit && largest > 0.0) {
        (true, false) => fraction(first),
        (true, true) => fraction(first.min(largest)),
        (false, true) => fraction(largest),
        (false, false) => 1.0,
    };
    sizes.push(format!("initial = {}", toml::number(initial)));
    if smallest > 0.0 && !explicit {
        sizes.push(format!(
            "smallest = {}",
            toml::number(fraction(smallest).min(initial))
        ));
    }
    if largest > 0.0 {
        sizes.push(format!(
            "largest = {}",
            toml::number(fraction(largest).max(fraction(smallest)).max(initial))
        ));
    }
    sizes
}

/// Which modes a step looks for, where it does.
fn modes(step: &Step) -> Option<String> {
    let (count, range) = match step.procedure {
        Procedure::Frequency { count, range } => (count, range),
        Procedure::ComplexFrequency {
            count,
            highest,
            friction_damping,
        } => {
            let to = match highest > 0.0 {
                true => format!(", to = {}", toml::number(highest)),
                false => String::new(),
            };
            return Some(format!(
                "complex-modes = {{ count = {count}{to}, friction-damping = {friction_damping} }}"
            ));
        }
        _ => return None,
    };
    let ends = ["from", "to"].into_iter().zip(range);
    let ends = ends.filter(|(_, f)| *f > 0.0);
    let ends: String = ends
        .map(|(key, f)| format!(", {key} = {}", toml::number(f)))
        .collect();
    Some(format!("modes = {{ count = {count}{ends} }}"))
}

/// How motion is integrated.
fn motion(step: &Step) -> Option<String> {
    let Procedure::Dynamic {
        explicit, alpha, ..
    } = step.procedure
    else {
        return None;
    };
    let [_, _, smallest, _] = times(step);
    Some(match explicit {
        // What is the smallest increment elsewhere is one to be reached by mass scaling in an explicit step.
        true if smallest > 0.0 => format!(
            "dynamic = {{ scheme.central-difference = {{ mass-scaling = {} }} }}",
            toml::number(smallest)
        ),
        true => "dynamic = { scheme.central-difference = {} }".to_string(),
        // CalculiX's own default.
        false => {
            let alpha = toml::number(alpha.unwrap_or(-0.05));
            format!("dynamic = {{ scheme.hht = {{ alpha = {alpha} }} }}")
        }
    })
}

/// The laws of interfaces that a step changes.
fn changes(job: &mut Job, step: usize) {
    let mut changes: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for (_, interface, line) in job.changes.iter().filter(|(s, ..)| *s == step) {
        changes
            .entry(interface.clone())
            .or_default()
            .push(line.clone());
    }
    for (interface, lines) in changes {
        job.out.line(&format!(
            "change.{} = {{ {} }}",
            toml::key(&interface),
            lines.join(", ")
        ));
    }
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
    job.out.line("");
    job.out.line("[output]");
    job.out.line(&format!("every = {}", every.unwrap_or(0)));
    if !at.is_empty() {
        job.out.line(&format!("times = {}", toml::numbers(&at)));
    }
    if let Some(encoding) = deck.output.frd {
        job.out.line(match encoding {
            Encoding::Text => "frd = \"text\"",
            Encoding::Binary => "frd = \"binary\"",
        });
    }
}
