//! `*BOUNDARY` to supports: one for every set of nodes that are prescribed alike over all steps.

use std::collections::{BTreeMap, BTreeSet};

use stickslip::body::couplings::{CouplingKind, Equation, Term};
use stickslip::problem::{Component, Coupling, Support};

use super::bodies::Bodies;
use super::courses;
use super::job::Job;
use super::names::problem_name;
use super::sets::Sets;
use crate::axes;
use crate::card::Place;
use crate::deck::{Action, Boundary, Rigid, Target};

/// Displacements and rotations, in the order of directions 1 to 6.
pub(super) const COMPONENTS: [Component; 6] = [
    Component::X,
    Component::Y,
    Component::Z,
    Component::RotationX,
    Component::RotationY,
    Component::RotationZ,
];

/// What is prescribed of one displacement in one step.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Value {
    pub value: f64,
    pub amplitude: Option<String>,
    pub fixed: bool,
    pub place: Place,
    /// The set it was given for.
    label: String,
    /// The step that gives it; the first, too, for what stands before.
    pub step: usize,
}

impl Value {
    /// What tells one from another.
    fn key(&self) -> (u64, Option<String>, bool) {
        (
            (self.value + 0.0).to_bits(),
            self.amplitude.clone(),
            self.fixed,
        )
    }
}

/// By node and direction.
pub(super) type State = BTreeMap<(u64, usize), Value>;

/// A support under way: what is prescribed along and about the axes, when, and the reference node if it is of one.
type Alike = (When, Option<String>, [Option<(u64, bool)>; 6], Option<u64>);

/// In which steps something is prescribed, and in which of them it comes from the one before.
type When = (Vec<bool>, Vec<bool>);

fn apply(job: &Job, state: &mut State, b: &Boundary, step: usize) {
    let label = match &b.target {
        Target::Set(name) => name.clone(),
        Target::One(n) => format!("node-{}", job.deck.label(*n)),
    };
    for node in job.nodes(&b.target) {
        for &component in &b.components {
            state.insert(
                turned(job, node, component),
                Value {
                    value: b.value,
                    amplitude: b.amplitude.clone(),
                    fixed: b.fixed,
                    place: b.place,
                    label: label.clone(),
                    step,
                },
            );
        }
    }
}

/// The node and direction that are meant: the displacements of a rotation node are rotations of its reference node.
pub(super) fn turned(job: &Job, node: u64, component: usize) -> (u64, usize) {
    let rigid = &job.deck.connectors.rigid;
    let of = rigid.iter().find(|r| r.rotation == Some(node));
    match of.and_then(|r| r.reference) {
        Some(reference) if component < 3 => (reference, 3 + component),
        _ => (node, component),
    }
}

/// What is prescribed in each step.
pub(super) fn by_step(job: &Job) -> Vec<State> {
    let mut state = State::new();
    for b in &job.deck.supports {
        apply(job, &mut state, b, 0);
    }
    let mut out = Vec::new();
    for (i, step) in job.deck.steps.iter().enumerate() {
        for action in &step.actions {
            match action {
                Action::ClearBoundaries => state.clear(),
                Action::Boundary(b) => apply(job, &mut state, b, i),
                _ => {}
            }
        }
        out.push(state.clone());
    }
    out
}

/// Values of the displacements of a node that hold in the same steps, with one amplitude.
type Line = (u64, When, Option<String>);

pub(super) fn write(job: &mut Job, bodies: &Bodies, sets: &mut Sets) {
    let states = by_step(job);
    let mut groups: BTreeMap<Alike, (Vec<u64>, Value)> = BTreeMap::new();
    for ((node, steps, amplitude), values) in lines(job, bodies, &states) {
        let Some(first) = values.iter().flatten().min_by_key(|v| v.place).cloned() else {
            continue;
        };
        if job.deck.pretension(node).is_some() {
            continue;
        }
        let refers = bodies.references.contains_key(&node);
        if !refers && !bodies.of_node.contains_key(&node) {
            reference(job, bodies, node, &steps, &amplitude, &values, &states);
            continue;
        }
        let zero = values.iter().flatten().all(|v| v.value == 0.0 && !v.fixed);
        let all = values[..bodies.dim()].iter().all(Option::is_some);
        let turned = values[3..].iter().any(Option::is_some);
        if turned && job.deck.properties.transforms.contains_key(&node) {
            let message = "rotations in the local axes of a *TRANSFORM";
            job.error(
                first.place,
                message,
                "leave the reference node out of the set of the *TRANSFORM",
            );
            continue;
        }
        if job.deck.properties.transforms.contains_key(&node) && !(zero && all) {
            local(job, bodies, sets, node, &steps, &amplitude, &values);
            continue;
        }
        let alike = values
            .each_ref()
            .map(|v| v.as_ref().map(|v| ((v.value + 0.0).to_bits(), v.fixed)));
        // A node of a body that others refer to moves with the body and turns on its own.
        let split = match refers && !bodies.refers(node) {
            true => [(0..3, None), (3..6, Some(node))],
            false => [(0..6, refers.then_some(node)), (0..0, None)],
        };
        for (range, own) in split {
            let part = std::array::from_fn(|i| alike[i].filter(|_| range.contains(&i)));
            if part.iter().any(Option::is_some) {
                let group = groups
                    .entry((steps.clone(), amplitude.clone(), part, own))
                    .or_insert((Vec::new(), first.clone()));
                group.0.push(node);
            }
        }
    }
    // In the order of the deck.
    let mut ordered: Vec<(Alike, (Vec<u64>, Value))> = groups.into_iter().collect();
    ordered.sort_by_key(|(_, (_, v))| v.place);
    for (alike, (nodes, first)) in ordered {
        support(job, bodies, sets, alike, nodes, first);
    }
}

/// Every value of every displacement, with the steps in which it holds.
fn lines(job: &mut Job, bodies: &Bodies, states: &[State]) -> BTreeMap<Line, [Option<Value>; 6]> {
    let count = states.len();
    let dofs: BTreeSet<(u64, usize)> = states.iter().flat_map(|s| s.keys().copied()).collect();
    let mut lines: BTreeMap<Line, [Option<Value>; 6]> = BTreeMap::new();
    let mut wrong = BTreeSet::new();
    for (node, component) in dofs {
        let mut values: Vec<(Value, When)> = Vec::new();
        for (i, state) in states.iter().enumerate() {
            let Some(v) = state.get(&(node, component)) else {
                continue;
            };
            let at = values
                .iter()
                .position(|(w, _)| w.key() == v.key())
                .unwrap_or_else(|| {
                    values.push((v.clone(), (vec![false; count], vec![false; count])));
                    values.len() - 1
                });
            values[at].1.0[i] = true;
            // Without an amplitude it is the same, given anew or not.
            values[at].1.1[i] = v.step < i && v.amplitude.is_some();
        }
        for (v, steps) in values {
            let refers = bodies.references.contains_key(&node);
            let turns = component == 5 || component > 2 && bodies.dim() == 3;
            if component < bodies.dim() || refers && turns {
                let slot = lines.entry((node, steps, v.amplitude.clone())).or_default();
                slot[component] = Some(v);
                continue;
            }
            // Directions that the space does not have, and rotations, which cells do not have.
            let of_node = |r: &Rigid| [r.reference, r.rotation].contains(&Some(node));
            let turns = component >= 3 && job.deck.connectors.rigid.iter().any(of_node);
            if v.value != 0.0 && !turns && wrong.insert(v.place) {
                job.error(
                    v.place,
                    format!(
                        "node {} has no direction {}",
                        job.deck.label(node),
                        component + 1
                    ),
                    "only zero may be prescribed there",
                );
            }
        }
    }
    lines
}

/// The table of nodes that are prescribed alike.
fn support(
    job: &mut Job,
    bodies: &Bodies,
    sets: &mut Sets,
    (steps, amplitude, values, own): Alike,
    nodes: Vec<u64>,
    first: Value,
) {
    let name = job.fresh::<Support>(&problem_name(&first.label));
    let set = match own {
        Some(node) => bodies.references[&node].clone(),
        None => sets.points(bodies, &problem_name(&first.label), &nodes),
    };
    let given = values
        .iter()
        .flatten()
        .map(|(bits, _)| f64::from_bits(*bits));
    let largest = given.fold(0.0, |m: f64, v| m.max(v.abs()));
    // What is held where it is does not move.
    let still = values.iter().flatten().all(|(_, fixed)| *fixed);
    let factor = match still {
        true => None,
        false => course(job, &amplitude, &steps, largest, first.place, &name),
    };
    let held = COMPONENTS.into_iter().zip(values);
    let held = held.filter(|(_, v)| v.is_some_and(|(_, fixed)| fixed));
    let moved = values.map(|v| {
        v.filter(|(_, fixed)| !fixed)
            .map(|(bits, _)| f64::from_bits(bits))
    });
    let support = Support {
        hold: held.map(|(component, _)| component).collect(),
        ..prescribed(set, moved, factor)
    };
    job.add(&name, first.place, support);
    job.acts::<Support>(name, steps.0);
}

/// Displacements and rotations that are prescribed.
fn prescribed(set: String, values: [Option<f64>; 6], amplitude: Option<String>) -> Support {
    let [x, y, z, rotation_x, rotation_y, rotation_z] = values;
    Support {
        set,
        x,
        y,
        z,
        rotation_x,
        rotation_y,
        rotation_z,
        hold: Vec::new(),
        amplitude,
    }
}

/// The amplitude of what is prescribed, under its name in the problem.
fn course(
    job: &mut Job,
    amplitude: &Option<String>,
    (active, kept): &When,
    value: f64,
    place: Place,
    user: &str,
) -> Option<String> {
    match amplitude {
        Some(a) => Some(courses::amplitude(job, a, active, kept, user)),
        None => courses::jump(job, active, value, place, user),
    }
}

/// A node that is in no cell: the reference of a rigid body, or nothing that could move.
fn reference(
    job: &mut Job,
    bodies: &Bodies,
    node: u64,
    when: &When,
    amplitude: &Option<String>,
    values: &[Option<Value>; 6],
    states: &[State],
) {
    let Some(first) = values.iter().flatten().min_by_key(|v| v.place).cloned() else {
        return;
    };
    let rigid = &job.deck.connectors.rigid;
    let Some(index) = rigid.iter().position(|r| r.reference == Some(node)) else {
        let mut all = job.deck.elements.values();
        if !all.any(|e| e.nodes.contains(&node)) {
            job.note(
                first.place,
                format!(
                    "node {} is in no element: what is prescribed there has no effect",
                    job.deck.label(node)
                ),
            );
        }
        return;
    };
    let dim = bodies.dim();
    // Those of a rotation node have become directions 4 to 6.
    let axes: &[usize] = if dim == 2 { &[2] } else { &[0, 1, 2] };
    let held = |state: &State, axis: usize| state.get(&(node, 3 + axis)).map(|v| v.value);
    let still = states
        .iter()
        .zip(&when.0)
        .filter(|(_, on)| **on)
        .all(|(s, _)| {
            (0..dim).all(|c| s.contains_key(&(node, c)))
                && axes.iter().all(|&a| held(s, a) == Some(0.0))
        });
    if !still {
        job.error(
            first.place,
            format!(
                "the reference node {} of a rigid body is held in part",
                job.deck.label(node)
            ),
            "prescribe all its displacements and hold its rotations (directions 4 to 6, or those of its ROT NODE), or prescribe nodes of the body instead",
        );
        return;
    }
    let name = job.fresh::<Support>(&problem_name(&first.label));
    let body = bodies.all.iter().find(|b| b.rigid == Some(index));
    let Some(set) = body.map(|body| body.name.clone()) else {
        return;
    };
    let place = first.place;
    let given = values.iter().flatten().map(|v| v.value.abs());
    let largest = given.fold(0.0, f64::max);
    let factor = course(job, amplitude, when, largest, place, &name);
    let moved = std::array::from_fn(|i| values[i].as_ref().filter(|_| i < dim).map(|v| v.value));
    job.add(&name, place, prescribed(set, moved, factor));
    job.acts::<Support>(name, when.0.clone());
}

/// A node with local axes: an equation along each that is prescribed.
fn local(
    job: &mut Job,
    bodies: &Bodies,
    sets: &mut Sets,
    node: u64,
    when: &When,
    amplitude: &Option<String>,
    values: &[Option<Value>; 6],
) {
    let Some(first) = values.iter().flatten().next().cloned() else {
        return;
    };
    let Some(axes) = axes::at_node(
        &job.deck.properties.transforms[&node],
        job.deck.nodes[&node],
    ) else {
        job.error(
            first.place,
            format!(
                "the *TRANSFORM of node {} has no axes there",
                job.deck.label(node)
            ),
            "its points must span a plane; a node cannot lie on the axis of a cylinder",
        );
        return;
    };
    let label = problem_name(&format!("node-{}", job.deck.label(node)));
    let set = sets.points(bodies, &label, &[node]);
    for (axis, v) in axes.iter().zip(values) {
        let Some(v) = v else { continue };
        if v.fixed {
            job.error(
                v.place,
                "FIXED is not supported in local axes",
                "prescribe a value",
            );
            return;
        }
        let name = job.fresh::<Coupling>(&problem_name(&format!("{}-{node}", v.label)));
        let factor = course(job, amplitude, when, v.value, v.place, &name);
        let term = |(component, factor): (Component, &f64)| Term {
            set: set.clone(),
            component,
            factor: *factor,
        };
        let all = COMPONENTS.into_iter().zip(axis).take(bodies.dim());
        let equation = Equation {
            terms: all.filter(|(_, f)| f.abs() > 1e-14).map(term).collect(),
            value: v.value,
        };
        let coupling = Coupling {
            amplitude: factor,
            kind: CouplingKind::Equation(equation),
        };
        job.add(&name, v.place, coupling);
        job.acts::<Coupling>(name, when.0.clone());
    }
}
