//! `*STEADY STATE DYNAMICS`: loads that shake, and where the answer is told.
//!
//! What shakes is what the step itself loads; loads of steps before stay what they are, the state about which it shakes. As CalculiX has it, damping is that of
//! `*MODAL DAMPING`, of dashpots and, which CalculiX leaves out, of materials.

use std::collections::{BTreeMap, BTreeSet};

use stickslip::model::ModalDamping;
use stickslip::problem::{Harmonic, Probe};
use stickslip::results::Quantity;

use super::bodies::Bodies;
use super::job::Job;
use super::names::problem_name;
use super::part::Part;
use crate::deck::{Action, Deck, FieldsOf, Print, Procedure, Step};

/// Displacements of more nodes than this are written as fields, not as columns of a table.
const MOST_NODES_IN_COLUMNS: usize = 200;

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
        let body = &bodies.all[bodies.of_node[&node]];
        let probe = Probe {
            point: deck.nodes[&node][..bodies.dim()].to_vec(),
            of: Some(body.name.clone()),
        };
        job.add(name, body.place, probe);
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
            "base excitation is not supported in steady-state dynamics",
            "use harmonic forces, or take the step to *DYNAMIC",
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
    if all.len() > MOST_NODES_IN_COLUMNS {
        return BTreeMap::new();
    }
    let named = |n: u64| (n, problem_name(&format!("node-{}", deck.label(n))));
    all.into_iter().map(named).collect()
}

/// What shakes in a step, at which frequencies; nothing where no load does.
pub(super) fn harmonic(job: &mut Job, index: usize) -> Option<Harmonic> {
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
        return None;
    }
    let ahead = shaking.iter().filter(|(_, p)| *p == Part::Imaginary);
    let [from, to] = range;
    Some(Harmonic {
        phases: ahead.map(|(n, _)| (n.clone(), 90.0)).collect(),
        loads: shaking.into_iter().map(|(n, _)| n).collect(),
        from,
        to: Some(to),
        points,
        bias,
        damping: damping(step),
        shapes: fields(job, step),
        ..Harmonic::default()
    })
}

fn damping(step: &Step) -> Option<ModalDamping> {
    let mut ratios = step.damping.ratios.clone();
    if !ratios.is_empty() {
        // The last is that of all modes behind, and these have none.
        ratios.push(0.0);
    }
    let [mass, stiffness] = step.damping.rayleigh;
    let damping = ModalDamping {
        ratios,
        mass,
        stiffness,
    };
    (damping != ModalDamping::default()).then_some(damping)
}

/// Whether displacements of all points are written: where the deck asks for them, or for none at nodes.
fn fields(job: &Job, step: &Step) -> bool {
    let asked = step.filed.iter();
    let mut displacements = asked.filter(|f| f.of == FieldsOf::Nodes);
    job.problem.probe.is_empty()
        || displacements.any(|f| f.quantities.contains(&Quantity::Displacement))
}
