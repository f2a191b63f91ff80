//! `*STEADY STATE DYNAMICS`: loads that shake, and where the answer is told.
//!
//! What shakes is what the step itself loads; loads of steps before stay what they are, the state about which it shakes. As CalculiX has it, damping is that of
//! `*MODAL DAMPING`, of dashpots and, which CalculiX leaves out, of materials.

use std::collections::{BTreeMap, BTreeSet};

use stickslip::results::Quantity;

use super::bodies::Bodies;
use super::job::Job;
use super::part::Part;
use super::toml;
use crate::deck::{Action, Deck, FieldsOf, Print, Procedure, Step};

/// Displacements of more nodes than this are written as fields, not as columns of a table.
const COLUMNS: usize = 200;

/// Says what steps cannot do, and writes the probes at which the answer is told.
pub(super) fn write(job: &mut Job, bodies: &Bodies) {
    let deck = job.deck;
    for step in &deck.steps {
        step.actions.iter().for_each(|a| refuse(job, step, a));
        let damped = step.damping != Default::default();
        if damped && !step.is_harmonic() {
            let message = "*MODAL DAMPING in a step that superposes no modes";
            job.error(
                step.place,
                message,
                "write it into the *STEADY STATE DYNAMICS step",
            );
        }
        if step.is_harmonic()
            && deck
                .properties
                .materials
                .values()
                .any(|m| m.damping.is_some())
        {
            let message = "*STEADY STATE DYNAMICS: *DAMPING of materials counts, which CalculiX leaves out beside *MODAL DAMPING";
            job.note(step.place, message);
        }
    }
    for (node, name) in nodes(deck, bodies) {
        let at = deck.nodes[&node];
        let body = &bodies.all[bodies.of_node[&node]];
        job.table("probe", &name, body.place);
        let at = toml::numbers(&at[..bodies.dim()]);
        job.out.line(&format!("point = {at}"));
        job.out.line(&format!("of = {}", toml::text(&body.name)));
    }
}

/// What has no meaning where the step shakes, or where it does not.
fn refuse(job: &mut Job, step: &Step, action: &Action) {
    match (action, step.is_harmonic()) {
        (
            Action::Force {
                imaginary: true,
                place,
                ..
            }
            | Action::Distributed {
                imaginary: true,
                place,
                ..
            },
            false,
        ) => job.error(
            *place,
            "an imaginary part of a load in a step in which nothing shakes",
            "leave it out, or write the load into a *STEADY STATE DYNAMICS step",
        ),
        (
            Action::Force {
                amplitude: Some(_),
                place,
                ..
            }
            | Action::Distributed {
                amplitude: Some(_),
                place,
                ..
            },
            true,
        ) => job.error(
            *place,
            "loads that shake have one amplitude at all frequencies",
            "leave AMPLITUDE out; the answer is proportional to the load",
        ),
        (Action::Boundary(b), true) if b.value != 0.0 => job.error(
            b.place,
            "supports stand still in steady vibrations",
            "let forces shake, or take the step to *DYNAMIC",
        ),
        _ => {}
    }
}

/// The nodes whose displacements are printed in steps that shake, with the names of their probes.
fn nodes(deck: &Deck, bodies: &Bodies) -> BTreeMap<u64, String> {
    let printed = deck.steps.iter().filter(|s| s.is_harmonic());
    let sets = printed.flat_map(|s| &s.prints).filter_map(|p| match p {
        Print::Node { set, keys, .. } if keys.iter().any(|k| k == "U") => Some(set),
        _ => None,
    });
    let all: BTreeSet<u64> = (sets.filter_map(|s| deck.node_sets.get(s)))
        .flatten()
        .copied()
        .filter(|n| bodies.of_node.contains_key(n))
        .collect();
    if all.len() > COLUMNS {
        return BTreeMap::new();
    }
    let named = |n: u64| (n, toml::name(&format!("node-{}", deck.label(n))));
    all.into_iter().map(named).collect()
}

/// The line of a step that shakes.
pub(super) fn line(job: &mut Job, index: usize) -> Option<String> {
    let step = &job.deck.steps[index];
    let Procedure::Harmonic {
        range,
        points,
        bias,
    } = step.procedure
    else {
        return None;
    };
    let shaking = job.shaking.iter().filter(|(.., steps)| steps[index]);
    let shaking: Vec<(String, Part)> = shaking.map(|(n, p, _)| (n.clone(), *p)).collect();
    if shaking.is_empty() {
        let help =
            "loads of steps before do not shake: write *CLOAD, *DLOAD or *DSLOAD into this one";
        job.error(step.place, "no load shakes in this step", help);
        return Some(String::new());
    }
    let names: Vec<String> = shaking.iter().map(|(n, _)| n.clone()).collect();
    let mut parts = vec![format!("loads = {}", toml::texts(&names))];
    let ahead = shaking.iter().filter(|(_, p)| *p == Part::Imaginary);
    let ahead: Vec<String> = ahead
        .map(|(n, _)| format!("{} = 90", toml::key(n)))
        .collect();
    if !ahead.is_empty() {
        parts.push(format!("phases = {{ {} }}", ahead.join(", ")));
    }
    let [from, to] = range.map(toml::number);
    parts.push(format!("from = {from}, to = {to}, points = {points}"));
    parts.extend(bias.map(|b| format!("bias = {}", toml::number(b))));
    parts.extend(damping(step));
    if fields(job, step) {
        parts.push("shapes = true".into());
    }
    Some(format!("harmonic = {{ {} }}", parts.join(", ")))
}

fn damping(step: &Step) -> Option<String> {
    let mut parts = Vec::new();
    let mut ratios = step.damping.ratios.clone();
    if !ratios.is_empty() {
        // The last is that of all modes behind, and these have none.
        ratios.push(0.0);
        parts.push(format!("ratios = {}", toml::numbers(&ratios)));
    }
    for (key, value) in ["mass", "stiffness"].into_iter().zip(step.damping.rayleigh) {
        if value != 0.0 {
            parts.push(format!("{key} = {}", toml::number(value)));
        }
    }
    (!parts.is_empty()).then(|| format!("damping = {{ {} }}", parts.join(", ")))
}

/// Whether displacements of all points are written: where the deck asks for them, or for none at nodes.
fn fields(job: &Job, step: &Step) -> bool {
    let asked = step.filed.iter();
    let mut displacements = asked.filter(|f| f.of == FieldsOf::Nodes);
    let probes = job.tables.iter().any(|t| t.starts_with("probe."));
    !probes || displacements.any(|f| f.quantities.contains(&Quantity::Displacement))
}
