//! `*TEMPERATURE` and `*INITIAL CONDITIONS, TYPE=TEMPERATURE`.

use std::collections::BTreeMap;

use stickslip::body::heat::{Nodes, TemperatureKind, Uniform};
use stickslip::problem::{self, Initial};

use super::acting::{Given, When, collect, label};
use super::bodies::Bodies;
use super::courses;
use super::job::Job;
use super::names::problem_name;
use super::sets::Sets;
use crate::card::Place;
use crate::deck::{Action, Temperature};

/// Temperatures by node: the last line that names it counts.
type ByNode = BTreeMap<u64, Given<f64>>;

/// The temperatures of nodes at the start. CalculiX starts at zero where nothing is said.
pub(super) fn at_start(job: &Job) -> BTreeMap<u64, f64> {
    let mut at = BTreeMap::new();
    for t in &job.deck.start.temperatures {
        at.extend(job.nodes(&t.target).into_iter().map(|n| (n, t.value)));
    }
    at
}

pub(super) fn write(job: &mut Job, bodies: &Bodies, sets: &mut Sets) {
    initial(job, bodies, sets);
    let by_step = by_step(job, bodies);
    // Nodes that have a temperature in the same steps, by the same amplitude, are one field.
    let mut groups: BTreeMap<When, (BTreeMap<u64, f64>, Place, String)> = BTreeMap::new();
    for (node, a) in collect(&by_step) {
        let when = When {
            ends: vec![false; by_step.len()],
            ..a.when()
        };
        let group = groups
            .entry(when)
            .or_insert((BTreeMap::new(), a.place, a.label));
        group.1 = group.1.min(a.place);
        group.0.insert(node, a.what);
    }
    let mut groups: Vec<_> = groups.into_iter().collect();
    groups.sort_by_key(|(_, (_, place, _))| *place);
    for (when, (nodes, place, label)) in groups {
        field(job, bodies, sets, &when, &nodes, place, &label);
    }
}

/// The temperatures of each step.
fn by_step(job: &mut Job, bodies: &Bodies) -> Vec<ByNode> {
    let (mut state, mut out) = (ByNode::new(), Vec::new());
    for (i, step) in job.deck.steps.iter().enumerate() {
        for action in &step.actions {
            match action {
                Action::ClearTemperatures => state.clear(),
                Action::Temperature { of, amplitude } => {
                    let given = Given {
                        what: of.value,
                        amplitude: amplitude.clone(),
                        place: of.place,
                        label: label(job.deck, &of.target),
                        step: i,
                    };
                    let nodes = job.nodes(&of.target).into_iter();
                    let nodes = nodes.filter(|n| bodies.of_node.contains_key(n));
                    state.extend(nodes.map(|n| (n, given.clone())));
                }
                _ => {}
            }
        }
        out.push(state.clone());
    }
    out
}

/// Opens the table of a field and writes it.
fn field(
    job: &mut Job,
    bodies: &Bodies,
    sets: &mut Sets,
    when: &When,
    nodes: &BTreeMap<u64, f64>,
    place: Place,
    label: &str,
) {
    let Some(factor) = course(job, when, place, label) else {
        return;
    };
    let numbers: Vec<u64> = nodes.keys().copied().collect();
    let set = sets.points(bodies, &problem_name(label), &numbers);
    let name = job.fresh::<problem::Temperature>(&problem_name(label));
    let field = problem::Temperature {
        set,
        amplitude: factor,
        kind: spread(nodes),
    };
    job.add(&name, place, field);
    job.acts::<problem::Temperature>(name, when.steps.clone());
}

/// One number, or one for each node.
fn spread(nodes: &BTreeMap<u64, f64>) -> TemperatureKind {
    let value = nodes.values().next().copied().unwrap_or(0.0);
    if nodes.values().all(|t| *t == value) {
        return TemperatureKind::Uniform(Uniform { value });
    }
    let values = nodes.iter().map(|(n, t)| [*n as f64, *t]).collect();
    TemperatureKind::Nodes(Nodes { values })
}

/// The amplitude that a field needs, if any; nothing if there is none that says what the deck does.
fn course(job: &mut Job, when: &When, place: Place, label: &str) -> Option<Option<String>> {
    if let Some(name) = &when.amplitude {
        let name = name.clone();
        return Some(Some(courses::amplitude(
            job,
            &name,
            &when.steps,
            &when.kept,
            label,
        )));
    }
    let begins = |i: usize| when.steps[i] && (i == 0 || !when.steps[i - 1]);
    let odd = |i: usize| {
        let step = &job.deck.steps[i];
        begins(i).then(|| (courses::abrupt(step), step.is_dynamic()))
    };
    let all: Vec<(bool, bool)> = (0..when.steps.len()).filter_map(odd).collect();
    // What begins slowly in a step at rest and at once in a moving one needs no word.
    if all.iter().all(|(at_once, moving)| at_once == moving) {
        return Some(None);
    }
    if all.iter().all(|(at_once, _)| *at_once) {
        return Some(Some(courses::at_once(job, label, place)));
    }
    job.error(
        place,
        "AMPLITUDE of *STEP is not supported for what this *TEMPERATURE begins",
        "give the *TEMPERATURE an AMPLITUDE of its own",
    );
    None
}

fn initial(job: &mut Job, bodies: &Bodies, sets: &mut Sets) {
    let mut places: BTreeMap<u64, &Temperature> = BTreeMap::new();
    for t in &job.deck.start.temperatures {
        places.extend(job.nodes(&t.target).into_iter().map(|n| (n, t)));
    }
    places.retain(|n, t| bodies.of_node.contains_key(n) && t.value != 0.0);
    let Some(first) = places.values().min_by_key(|t| t.place) else {
        return;
    };
    let (place, label) = (first.place, label(job.deck, &first.target));
    let nodes: BTreeMap<u64, f64> = places.iter().map(|(n, t)| (*n, t.value)).collect();
    let numbers: Vec<u64> = nodes.keys().copied().collect();
    let set = sets.points(bodies, &problem_name(&label), &numbers);
    let name = job.fresh::<Initial>(&problem_name(&format!("temperature-{label}")));
    let start = Initial {
        set,
        temperature: Some(spread(&nodes)),
        ..Initial::default()
    };
    job.add(name, place, start);
}
