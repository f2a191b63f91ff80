//! `*CLOAD`, `*DLOAD`, `*DSLOAD` and `*INITIAL CONDITIONS`.

use std::collections::{BTreeMap, BTreeSet};

use stickslip::body::loads::{LoadKind, Moment, NodalForce, Pressure};
use stickslip::mesh::FacetRef;
use stickslip::problem::{Initial, Load};

use super::acting::{Acting, Given, When, add_load, collect, label, two_courses};
use super::bodies::Bodies;
use super::job::Job;
use super::names::problem_name;
use super::part::Part;
use super::sets::Sets;
use super::supports::turned;
use crate::axes;
use crate::card::Place;
use crate::deck::{Action, Distributed, SurfaceParts};

pub(super) fn write(job: &mut Job, bodies: &Bodies, sets: &mut Sets) {
    for part in Part::of(job.deck) {
        job.part = part;
        forces(job, bodies, sets);
        pressures(job, bodies, sets);
        super::volumes::write(job, bodies, sets);
    }
    initial(job, bodies, sets);
}

/// Forces by node and direction.
pub(super) type Forces = BTreeMap<(u64, usize), Given<f64>>;

/// The forces of each step; none if two of them cannot be added up.
pub(super) fn forces_by_step(job: &mut Job) -> Option<Vec<Forces>> {
    let (mut state, mut by_step) = (Forces::new(), Vec::new());
    for (i, step) in job.deck.steps.iter().enumerate() {
        // The first force of a step replaces what was there, further ones add to it.
        let mut touched = BTreeSet::new();
        if job.part.begins_anew() {
            state.clear();
        }
        for action in job.part.actions(step) {
            match action {
                Action::ClearForces => state.clear(),
                Action::Force {
                    target,
                    component,
                    value,
                    amplitude,
                    place,
                    ..
                } => {
                    for node in job.nodes(target) {
                        let at = turned(job, node, *component);
                        let again = !touched.insert(at);
                        let before = state.get(&at).filter(|_| again);
                        if before.is_some_and(|b| b.amplitude != *amplitude) {
                            two_courses(job, *place);
                            return None;
                        }
                        let given = Given {
                            what: value + before.map_or(0.0, |b| b.what),
                            amplitude: amplitude.clone(),
                            place: *place,
                            label: label(job.deck, target),
                            step: i,
                        };
                        state.insert(at, given);
                    }
                }
                _ => {}
            }
        }
        by_step.push(state.clone());
    }
    Some(by_step)
}

fn forces(job: &mut Job, bodies: &Bodies, sets: &mut Sets) {
    let Some(by_step) = forces_by_step(job) else {
        return;
    };
    // Directions of one node that act alike are one force, nodes with the same force one load.
    let mut nodes: BTreeMap<(u64, When), ([f64; 3], Place, String)> = BTreeMap::new();
    let (moments, forces): (Vec<_>, Vec<_>) =
        (collect(&by_step).into_iter()).partition(|((_, component), _)| *component >= 3);
    self::moments(job, bodies, moments);
    for ((node, component), a) in forces {
        if job.deck.pretension(node).is_some() {
            continue;
        }
        let entry = nodes
            .entry((node, a.when()))
            .or_insert(([0.0; 3], a.place, a.label));
        entry.0[component] = a.what;
    }
    // A reference point is a set of its own.
    type Alike = (When, [u64; 3], Option<u64>);
    let mut groups: BTreeMap<Alike, (Vec<u64>, Place, String)> = BTreeMap::new();
    for ((node, when), (force, place, label)) in nodes {
        let mut at = node;
        if !bodies.of_node.contains_key(&node) && !bodies.refers(node) {
            match stand_in(job, bodies, node) {
                Some(n) => at = n,
                None => {
                    job.error(place, format!("the force on node {} acts on no body", job.deck.label(node)), "the reference node of a rigid body is loaded where it coincides with a node of the body; otherwise load its nodes");
                    continue;
                }
            }
        }
        let force = match job
            .deck
            .properties
            .transforms
            .get(&node)
            .and_then(|t| axes::at_node(t, job.deck.nodes[&node]))
        {
            Some(axes) => std::array::from_fn(|i| (0..3).map(|k| axes[k][i] * force[k]).sum()),
            None => force,
        };
        if bodies.dim() == 2 && force[2] != 0.0 {
            job.error(
                place,
                "a force along z in the plane",
                "forces act along x (1) and y (2)",
            );
            continue;
        }
        let own = bodies.refers(node).then_some(node);
        let key = (when, force.map(|f: f64| (f + 0.0).to_bits()), own);
        groups
            .entry(key)
            .or_insert((Vec::new(), place, label))
            .0
            .push(at);
    }
    let mut ordered: Vec<_> = groups.into_iter().collect();
    ordered.sort_by_key(|(_, (_, place, _))| *place);
    for ((when, force, _), (nodes, place, label)) in ordered {
        let set = sets.points(bodies, &problem_name(&label), &nodes);
        let value = force.map(f64::from_bits)[..bodies.dim()].to_vec();
        let kind = LoadKind::NodalForce(NodalForce { value });
        add_load(job, &format!("force-{label}"), set, place, &when, kind);
    }
}

/// Moments on reference points.
fn moments(job: &mut Job, bodies: &Bodies, all: Vec<((u64, usize), Acting<f64>)>) {
    let plane = bodies.dim() == 2;
    for ((node, component), a) in all {
        let Some(name) = bodies.references.get(&node).cloned() else {
            let message = format!(
                "a moment on node {}, which cannot turn",
                job.deck.label(node)
            );
            job.error(
                a.place,
                message,
                "moments act on reference nodes of *COUPLING and *RIGID BODY of nodes",
            );
            continue;
        };
        if plane && component != 5 || job.deck.properties.transforms.contains_key(&node) {
            let message = "a moment out of the plane, or in the local axes of a *TRANSFORM";
            job.error(
                a.place,
                message,
                "moments act about the axes of the model, in the plane about z",
            );
            continue;
        }
        let mut value = [0.0; 3];
        value[component - 3] = a.what;
        let value = if plane { &value[2..] } else { &value[..] };
        let kind = LoadKind::Moment(Moment {
            value: value.to_vec(),
        });
        let wanted = format!("moment-{}", a.label);
        add_load(job, &wanted, name, a.place, &a.when(), kind);
    }
}

/// The node of a rigid body that lies where its reference node is.
fn stand_in(job: &Job, bodies: &Bodies, node: u64) -> Option<u64> {
    let index = job
        .deck
        .connectors
        .rigid
        .iter()
        .position(|r| r.reference == Some(node))?;
    let body = bodies.all.iter().position(|b| b.rigid == Some(index))?;
    let x = job.deck.nodes[&node];
    let size = bodies
        .mesh
        .points
        .iter()
        .flatten()
        .fold(0.0, |m: f64, c| m.max(c.abs()));
    let mut mine = bodies
        .of_node
        .iter()
        .filter(|(_, b)| **b == body)
        .map(|(n, _)| *n);
    mine.find(|n| stickslip::math::distance(job.deck.nodes[n], x) <= 1e-9 * size)
}

/// Pressures by body and face.
type Pressures = BTreeMap<(usize, FacetRef), Given<f64>>;

/// Faces by body.
type Faces = BTreeMap<usize, Vec<FacetRef>>;

/// The faces, the size and the name of a load that is a pressure.
fn loaded(
    job: &mut Job,
    bodies: &Bodies,
    load: &Distributed,
    place: Place,
) -> Option<(Faces, f64, String)> {
    match load {
        Distributed::Pressure(faces, value) => {
            let parts = SurfaceParts::Faces(faces.iter().map(|(e, f)| (*e, Some(*f))).collect());
            Some((bodies.faces(&parts), *value, "pressure".to_string()))
        }
        Distributed::Surface(name, value) => match job.deck.surfaces.get(name) {
            Some(s) if matches!(s.parts, SurfaceParts::Nodes(_)) => {
                job.error(
                    place,
                    format!("the surface {name} consists of nodes"),
                    "a pressure acts on faces of elements",
                );
                None
            }
            Some(s) => Some((bodies.faces(&s.parts), *value, name.clone())),
            None => None,
        },
        _ => None,
    }
}

/// The pressures of each step; none if two of them cannot be added up.
fn pressures_by_step(job: &mut Job, bodies: &Bodies) -> Option<Vec<Pressures>> {
    let (mut state, mut by_step) = (Pressures::new(), Vec::new());
    for (i, step) in job.deck.steps.iter().enumerate() {
        // As forces: the first pressure of a step on a face replaces what was there, further ones add to it.
        let mut touched = BTreeSet::new();
        if job.part.begins_anew() {
            state.clear();
        }
        for action in job.part.actions(step) {
            let Action::Distributed {
                load,
                amplitude,
                place,
                ..
            } = action
            else {
                if *action == Action::ClearDistributed {
                    state.clear();
                }
                continue;
            };
            let Some((faces, value, label)) = loaded(job, bodies, load, *place) else {
                continue;
            };
            for (body, list) in faces {
                for facet in list {
                    let again = !touched.insert((body, facet));
                    let before = state.get(&(body, facet)).filter(|_| again);
                    if before.is_some_and(|b| b.amplitude != *amplitude) {
                        two_courses(job, *place);
                        return None;
                    }
                    let given = Given {
                        what: value + before.map_or(0.0, |b| b.what),
                        amplitude: amplitude.clone(),
                        place: *place,
                        label: label.clone(),
                        step: i,
                    };
                    state.insert((body, facet), given);
                }
            }
        }
        by_step.push(state.clone());
    }
    Some(by_step)
}

fn pressures(job: &mut Job, bodies: &Bodies, sets: &mut Sets) {
    let Some(by_step) = pressures_by_step(job, bodies) else {
        return;
    };
    type Alike = (When, u64);
    let mut groups: BTreeMap<Alike, (Faces, Place, String)> = BTreeMap::new();
    for ((body, facet), a) in collect(&by_step) {
        let key = (a.when(), a.what.to_bits());
        let group = groups
            .entry(key)
            .or_insert((Faces::new(), a.place, a.label));
        group.1 = group.1.min(a.place);
        group.0.entry(body).or_default().push(facet);
    }
    let mut ordered: Vec<_> = groups.into_iter().collect();
    ordered.sort_by_key(|(_, (_, place, _))| *place);
    for ((when, value), (faces, place, label)) in ordered {
        for (_, set) in sets.facets(bodies, &problem_name(&job.fresh::<Load>(&label)), &faces) {
            let value = f64::from_bits(value);
            let kind = LoadKind::Pressure(Pressure { value });
            add_load(job, &label, set, place, &when, kind);
        }
    }
}

fn initial(job: &mut Job, bodies: &Bodies, sets: &mut Sets) {
    let mut nodes: BTreeMap<(bool, u64), ([f64; 3], Place, String)> = BTreeMap::new();
    for i in &job.deck.start.initial {
        for node in job.nodes(&i.target) {
            let entry = nodes.entry((i.velocity, node)).or_insert((
                [0.0; 3],
                i.place,
                label(job.deck, &i.target),
            ));
            entry.0[i.component] = i.value;
        }
    }
    type Nodes = (Vec<u64>, Place, String);
    let mut groups: BTreeMap<(bool, [u64; 3]), Nodes> = BTreeMap::new();
    for ((velocity, node), (v, place, label)) in nodes {
        if bodies.of_node.contains_key(&node) {
            let key = (velocity, v.map(|c| (c + 0.0).to_bits()));
            groups
                .entry(key)
                .or_insert((Vec::new(), place, label))
                .0
                .push(node);
        }
    }
    for ((velocity, value), (nodes, place, label)) in groups {
        let set = sets.points(bodies, &problem_name(&label), &nodes);
        let name = job.fresh::<Initial>(&problem_name(&label));
        let value = value.map(f64::from_bits)[..bodies.dim()].to_vec();
        let (velocity, displacement) = match velocity {
            true => (Some(value), None),
            false => (None, Some(value)),
        };
        let start = Initial {
            set,
            velocity,
            displacement,
            ..Initial::default()
        };
        job.add(name, place, start);
    }
}
