//! `GRAV`, `CENTRIF` and `BX`, `BY`, `BZ` of `*DLOAD`, on cells and on point masses.

use std::collections::{BTreeMap, BTreeSet};

use stickslip::body::loads::{BodyForce, Centrifugal, Gravity, LoadKind, NodalForce};
use stickslip::math::{add_scaled, dot, normalize, scale, sub};

use super::acting::{Acting, Given, When, add_load, collect, two_courses};
use super::bodies::Bodies;
use super::job::Job;
use super::names::problem_name;
use super::sets::Sets;
use crate::deck::{Action, Distributed};

/// An acceleration of a set of elements.
#[derive(Debug, Clone, PartialEq)]
struct Acceleration {
    elements: Vec<u64>,
    /// Its size, or the square of the angular speed.
    value: f64,
    field: Field,
}

/// How it is distributed.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Field {
    /// In one direction.
    Uniform([f64; 3]),
    /// Away from an axis: a point and the direction.
    Away([f64; 3], [f64; 3]),
}

impl Field {
    /// The acceleration at a place, for a value of one.
    fn at(self, x: [f64; 3]) -> [f64; 3] {
        match self {
            Field::Uniform(d) => d,
            Field::Away(p, d) => {
                let (arm, axis) = (sub(x, p), normalize(d).unwrap_or_default());
                add_scaled(arm, -dot(arm, axis), axis)
            }
        }
    }

    fn bits(self) -> Vec<u64> {
        let bits = |v: [f64; 3]| v.map(|c| (c + 0.0).to_bits());
        match self {
            Field::Uniform(d) => bits(d).to_vec(),
            Field::Away(p, d) => [bits(p), bits(d)].concat(),
        }
    }
}

pub(super) fn write(job: &mut Job, bodies: &Bodies, sets: &mut Sets) {
    accelerations(job, bodies, sets);
    forces(job, bodies, sets);
}

/// Accelerations are one where the deck names the same elements and the same direction or axis: the first of a step replaces what was there, further
/// ones add to it. Others act beside each other, whatever elements they share.
fn accelerations(job: &mut Job, bodies: &Bodies, sets: &mut Sets) {
    type Key = (String, Vec<u64>);
    type State = BTreeMap<Key, Given<Acceleration>>;
    let (mut state, mut by_step) = (State::new(), Vec::new());
    for (i, step) in job.deck.steps.iter().enumerate() {
        let mut touched: BTreeSet<Key> = BTreeSet::new();
        if job.part.begins_anew() {
            state.clear();
        }
        for action in job.part.actions(step) {
            if *action == Action::ClearDistributed {
                state.clear();
            }
            let Action::Distributed {
                load,
                amplitude,
                place,
                ..
            } = action
            else {
                continue;
            };
            let (elements, name, value, field, label) = match load {
                Distributed::Gravity(e, name, g, d) => (e, name, *g, Field::Uniform(*d), "gravity"),
                Distributed::Centrifugal(e, name, w, p, d) => {
                    (e, name, *w, Field::Away(*p, *d), "centrifugal")
                }
                _ => continue,
            };
            let key = (name.clone(), field.bits());
            let again = !touched.insert(key.clone());
            let before = state.get(&key).filter(|_| again);
            if before.is_some_and(|b| b.amplitude != *amplitude) {
                two_courses(job, *place);
                return;
            }
            let what = Acceleration {
                elements: elements.clone(),
                value: value + before.map_or(0.0, |b| b.what.value),
                field,
            };
            let given = Given {
                what,
                amplitude: amplitude.clone(),
                place: *place,
                label: label.into(),
                step: i,
            };
            state.insert(key, given);
        }
        by_step.push(state.clone());
    }
    for (_, a) in collect(&by_step) {
        if a.what.value == 0.0 {
            continue;
        }
        for set in sets.cells_of(bodies, &problem_name(&a.label), &a.what.elements) {
            let kind = inertia(bodies.dim(), &a.what);
            add_load(job, &a.label, set, a.place, &a.when(), kind);
        }
        masses(job, bodies, sets, &a);
    }
}

fn inertia(dim: usize, a: &Acceleration) -> LoadKind {
    match a.field {
        Field::Uniform(d) => LoadKind::Gravity(Gravity {
            acceleration: scale(a.value, d)[..dim].to_vec(),
        }),
        Field::Away(p, d) => LoadKind::Centrifugal(Centrifugal {
            speed: a.value.sqrt(),
            point: Some(p[..dim].to_vec()),
            axis: (dim == 3).then(|| d.to_vec()),
        }),
    }
}

/// Forces on point masses. A mass takes part if its own element is among those that are named; a problem file lets it take part if cells at its point
/// are. The difference is made up by forces at the points.
fn masses(job: &mut Job, bodies: &Bodies, sets: &mut Sets, a: &Acting<Acceleration>) {
    let deck = job.deck;
    let named: BTreeSet<u64> = a.what.elements.iter().copied().collect();
    let cells = named.iter().filter(|e| bodies.of_element.contains_key(e));
    let touched: BTreeSet<u64> = cells
        .flat_map(|e| deck.elements[e].nodes.iter().copied())
        .collect();
    let mut lacking: BTreeMap<u64, f64> = BTreeMap::new();
    for (set, mass, _) in &deck.connectors.masses {
        for id in deck.element_sets.get(set).into_iter().flatten() {
            let Some(node) = deck.elements[id].nodes.first() else {
                continue;
            };
            match (named.contains(id), touched.contains(node)) {
                (true, false) => *lacking.entry(*node).or_default() += mass,
                (false, true) => *lacking.entry(*node).or_default() -= mass,
                _ => {}
            }
        }
    }
    let mut groups: BTreeMap<[u64; 3], Vec<u64>> = BTreeMap::new();
    for (node, mass) in lacking {
        let force = scale(mass * a.what.value, a.what.field.at(deck.nodes[&node]));
        if force != [0.0; 3] && bodies.of_node.contains_key(&node) {
            let key = force.map(|c| (c + 0.0).to_bits());
            groups.entry(key).or_default().push(node);
        }
    }
    for (force, nodes) in groups {
        let label = format!("{}-of-masses", a.label);
        let set = sets.points(bodies, &label, &nodes);
        let value = force.map(f64::from_bits)[..bodies.dim()].to_vec();
        let kind = LoadKind::NodalForce(NodalForce { value });
        add_load(job, &label, set, a.place, &a.when(), kind);
    }
}

/// Forces per volume, which elements have one by one along each axis.
fn forces(job: &mut Job, bodies: &Bodies, sets: &mut Sets) {
    type State = BTreeMap<(u64, usize), Given<f64>>;
    let (mut state, mut by_step) = (State::new(), Vec::new());
    for (i, step) in job.deck.steps.iter().enumerate() {
        let mut touched = BTreeSet::new();
        if job.part.begins_anew() {
            state.clear();
        }
        for action in job.part.actions(step) {
            if *action == Action::ClearDistributed {
                state.clear();
            }
            let Action::Distributed {
                load: Distributed::Body(elements, axis, force),
                amplitude,
                place,
                ..
            } = action
            else {
                continue;
            };
            for e in elements {
                let again = !touched.insert((*e, *axis));
                let before = state.get(&(*e, *axis)).filter(|_| again);
                if before.is_some_and(|b| b.amplitude != *amplitude) {
                    two_courses(job, *place);
                    return;
                }
                let given = Given {
                    what: force + before.map_or(0.0, |b| b.what),
                    amplitude: amplitude.clone(),
                    place: *place,
                    label: "body-force".to_string(),
                    step: i,
                };
                state.insert((*e, *axis), given);
            }
        }
        by_step.push(state.clone());
    }
    type Alike = (When, usize, u64);
    let mut groups: BTreeMap<Alike, (Vec<u64>, Acting<f64>)> = BTreeMap::new();
    for ((element, axis), a) in collect(&by_step) {
        let key = (a.when(), axis, a.what.to_bits());
        groups.entry(key).or_insert((Vec::new(), a)).0.push(element);
    }
    let dim = bodies.dim();
    for ((when, axis, _), (elements, a)) in groups {
        if axis >= dim && a.what != 0.0 {
            job.error(
                a.place,
                "a force along z in the plane",
                "forces act along x (BX) and y (BY)",
            );
            continue;
        }
        let value: Vec<f64> = (0..dim)
            .map(|i| if i == axis { a.what } else { 0.0 })
            .collect();
        for set in sets.cells_of(bodies, &problem_name(&a.label), &elements) {
            let kind = LoadKind::BodyForce(BodyForce {
                value: value.clone(),
            });
            add_load(job, &a.label, set, a.place, &when, kind);
        }
    }
}
