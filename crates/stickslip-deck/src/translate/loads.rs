//! `*CLOAD`, `*DLOAD`, `*DSLOAD` and `*INITIAL CONDITIONS`.

use std::collections::{BTreeMap, BTreeSet};

use stickslip::mesh::FacetRef;

use super::bodies::Bodies;
use super::sets::Sets;
use super::{Job, steps, supports, toml};
use crate::deck::{Action, Distributed, SurfaceParts, Target};
use crate::source::Place;

/// A value that acts in some of the steps.
#[derive(Debug, Clone)]
pub(super) struct Acting<T> {
    pub what: T,
    amplitude: Option<String>,
    pub place: Place,
    pub label: String,
    steps: Vec<bool>,
    /// Steps to which it comes from the one before, without being given anew.
    kept: Vec<bool>,
    /// Steps in which a value with an amplitude takes its place: it ends at once, instead of falling over the step.
    ends: Vec<bool>,
}

impl<T> Acting<T> {
    /// When it acts.
    pub fn when(&self) -> When {
        When {
            amplitude: self.amplitude.clone(),
            steps: self.steps.clone(),
            kept: self.kept.clone(),
            ends: self.ends.clone(),
        }
    }
}

/// When a load acts.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct When {
    amplitude: Option<String>,
    steps: Vec<bool>,
    kept: Vec<bool>,
    ends: Vec<bool>,
}

/// A value as a step gives it, or the step before.
#[derive(Debug, Clone)]
pub(super) struct Given<T> {
    pub what: T,
    pub amplitude: Option<String>,
    pub place: Place,
    /// What it was given for.
    pub label: String,
    /// The step that gives it.
    pub step: usize,
}

/// Values by step to values with their steps, equal ones together.
pub(super) fn collect<K: Ord + Clone, T: Clone + PartialEq>(
    by_step: &[BTreeMap<K, Given<T>>],
) -> Vec<(K, Acting<T>)> {
    let mut out: Vec<(K, Acting<T>)> = Vec::new();
    let mut at: BTreeMap<K, Vec<usize>> = BTreeMap::new();
    for (i, state) in by_step.iter().enumerate() {
        for (key, given) in state {
            let known = at.entry(key.clone()).or_default();
            let alike = |a: &Acting<T>| a.what == given.what && a.amplitude == given.amplitude;
            let same = known.iter().copied().find(|&j| alike(&out[j].1));
            let index = same.unwrap_or_else(|| {
                known.push(out.len());
                let acting = Acting {
                    what: given.what.clone(),
                    amplitude: given.amplitude.clone(),
                    place: given.place,
                    label: given.label.clone(),
                    steps: vec![false; by_step.len()],
                    kept: vec![false; by_step.len()],
                    ends: vec![false; by_step.len()],
                };
                out.push((key.clone(), acting));
                out.len() - 1
            });
            out[index].1.steps[i] = true;
            // Without an amplitude it is the same, given anew or not.
            out[index].1.kept[i] = given.step < i && given.amplitude.is_some();
        }
    }
    for (key, acting) in &mut out {
        for (i, state) in by_step.iter().enumerate().skip(1) {
            let replaced = state.get(key).is_some_and(|v| v.amplitude.is_some());
            acting.ends[i] = replaced && acting.steps[i - 1] && !acting.steps[i];
        }
    }
    out
}

pub(super) fn write(job: &mut Job, bodies: &Bodies, sets: &mut Sets) {
    forces(job, bodies, sets);
    pressures(job, bodies, sets);
    super::volumes::write(job, bodies, sets);
    initial(job, bodies, sets);
}

/// Loads that are given several times in a step add up. CalculiX has one amplitude for the sum.
pub(super) fn two_courses(job: &mut Job, place: Place) {
    job.error(
        place,
        "what is loaded here is loaded in the same step with another amplitude",
        "loads that add up have one amplitude: write one line with one amplitude for the sum",
    );
}

/// Opens the table of a load and writes what all have in common.
pub(super) fn open(job: &mut Job, name: &str, set: &str, place: Place, when: &When) {
    let name = job.fresh("load", &toml::name(name));
    // From the first step on, where steps change without amplitudes as they usually do not.
    let unusual = when.amplitude.is_none() && steps::unusual(job.deck);
    let factor = match (&when.amplitude, unusual || when.ends.contains(&true)) {
        (None, false) => None,
        (Some(a), false) => Some(steps::amplitude(job, a, (&when.steps, &when.kept), &name)),
        (a, true) => Some(steps::ending(
            job,
            a.as_ref(),
            (&when.steps, &when.kept, &when.ends),
            &name,
        )),
    };
    let steps = when.steps.iter().zip(&when.ends).map(|(a, b)| *a || *b);
    let mut steps: Vec<bool> = steps.collect();
    if unusual {
        let first = steps.iter().position(|on| *on).unwrap_or(0);
        steps[first..].fill(true);
    }
    job.table("load", &name, place);
    job.out.line(&format!("set = {}", toml::text(set)));
    if let Some(factor) = factor {
        job.out
            .line(&format!("amplitude = {}", toml::text(&factor)));
    }
    job.active.push(("loads", name, steps));
}

fn label(target: &Target) -> String {
    match target {
        Target::Set(name) => name.clone(),
        Target::One(n) => format!("node-{n}"),
    }
}

fn forces(job: &mut Job, bodies: &Bodies, sets: &mut Sets) {
    type State = BTreeMap<(u64, usize), Given<f64>>;
    let (mut state, mut by_step) = (State::new(), Vec::new());
    for (i, step) in job.deck.steps.iter().enumerate() {
        // The first force of a step replaces what was there, further ones add to it.
        let mut touched = BTreeSet::new();
        for action in &step.actions {
            match action {
                Action::ClearForces => state.clear(),
                Action::Force {
                    target,
                    component,
                    value,
                    amplitude,
                    place,
                } => {
                    for node in job.nodes(target) {
                        let again = !touched.insert((node, *component));
                        let before = state.get(&(node, *component)).filter(|_| again);
                        if before.is_some_and(|b| b.amplitude != *amplitude) {
                            two_courses(job, *place);
                            return;
                        }
                        let given = Given {
                            what: value + before.map_or(0.0, |b| b.what),
                            amplitude: amplitude.clone(),
                            place: *place,
                            label: label(target),
                            step: i,
                        };
                        state.insert((node, *component), given);
                    }
                }
                _ => {}
            }
        }
        by_step.push(state.clone());
    }
    // Directions of one node that act alike are one force, nodes with the same force one load.
    let mut nodes: BTreeMap<(u64, When), ([f64; 3], Place, String)> = BTreeMap::new();
    for ((node, component), a) in collect(&by_step) {
        let entry = nodes
            .entry((node, a.when()))
            .or_insert(([0.0; 3], a.place, a.label));
        entry.0[component] = a.what;
    }
    type Alike = (When, [u64; 3]);
    let mut groups: BTreeMap<Alike, (Vec<u64>, Place, String)> = BTreeMap::new();
    for ((node, when), (force, place, label)) in nodes {
        let mut at = node;
        if !bodies.of_node.contains_key(&node) {
            match stand_in(job, bodies, node) {
                Some(n) => at = n,
                None => {
                    job.error(place, format!("the force on node {node} acts on no body"), "the reference node of a rigid body is loaded where it coincides with a node of the body; otherwise load its nodes");
                    continue;
                }
            }
        }
        let force = match job
            .deck
            .transforms
            .get(&node)
            .and_then(|t| supports::axes(t, job.deck.nodes[&node]))
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
        let key = (when, force.map(|f: f64| (f + 0.0).to_bits()));
        groups
            .entry(key)
            .or_insert((Vec::new(), place, label))
            .0
            .push(at);
    }
    let mut ordered: Vec<_> = groups.into_iter().collect();
    ordered.sort_by_key(|(_, (_, place, _))| *place);
    for ((when, force), (nodes, place, label)) in ordered {
        let set = sets.points(bodies, &toml::name(&label), &nodes);
        open(job, &format!("force-{label}"), &set, place, &when);
        let value = toml::numbers(&force.map(f64::from_bits)[..bodies.dim()]);
        job.out
            .line(&format!("nodal-force = {{ value = {value} }}"));
    }
}

/// The node of a rigid body that lies where its reference node is.
fn stand_in(job: &Job, bodies: &Bodies, node: u64) -> Option<u64> {
    let index = job
        .deck
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

fn pressures(job: &mut Job, bodies: &Bodies, sets: &mut Sets) {
    type State = BTreeMap<(usize, FacetRef), Given<f64>>;
    let (mut state, mut by_step) = (State::new(), Vec::new());
    for (i, step) in job.deck.steps.iter().enumerate() {
        // As forces: the first pressure of a step on a face replaces what was there, further ones add to it.
        let mut touched = BTreeSet::new();
        for action in &step.actions {
            let Action::Distributed {
                load,
                amplitude,
                place,
            } = action
            else {
                if *action == Action::ClearDistributed {
                    state.clear();
                }
                continue;
            };
            let (faces, value, label) = match load {
                Distributed::Pressure(faces, value) => {
                    let parts =
                        SurfaceParts::Faces(faces.iter().map(|(e, f)| (*e, Some(*f))).collect());
                    (bodies.faces(&parts), *value, "pressure".to_string())
                }
                Distributed::Surface(name, value) => match job.deck.surfaces.get(name) {
                    Some(s) if matches!(s.parts, SurfaceParts::Nodes(_)) => {
                        job.error(
                            *place,
                            format!("the surface {name} consists of nodes"),
                            "a pressure acts on faces of elements",
                        );
                        continue;
                    }
                    Some(s) => (bodies.faces(&s.parts), *value, name.clone()),
                    None => continue,
                },
                _ => continue,
            };
            for (body, list) in faces {
                for facet in list {
                    let again = !touched.insert((body, facet));
                    let before = state.get(&(body, facet)).filter(|_| again);
                    if before.is_some_and(|b| b.amplitude != *amplitude) {
                        two_courses(job, *place);
                        return;
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
    type Alike = (When, u64);
    type Faces = BTreeMap<usize, Vec<FacetRef>>;
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
        for (_, set) in sets.facets(bodies, &toml::name(&job.fresh("load", &label)), &faces) {
            open(job, &label, &set, place, &when);
            job.out.line(&format!(
                "pressure = {{ value = {} }}",
                toml::number(f64::from_bits(value))
            ));
        }
    }
}

fn initial(job: &mut Job, bodies: &Bodies, sets: &mut Sets) {
    let mut nodes: BTreeMap<(bool, u64), ([f64; 3], Place, String)> = BTreeMap::new();
    for i in &job.deck.initial {
        for node in job.nodes(&i.target) {
            let entry =
                nodes
                    .entry((i.velocity, node))
                    .or_insert(([0.0; 3], i.place, label(&i.target)));
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
        let set = sets.points(bodies, &toml::name(&label), &nodes);
        let name = job.fresh("initial", &toml::name(&label));
        job.table("initial", &name, place);
        job.out.line(&format!("set = {}", toml::text(&set)));
        let key = if velocity { "velocity" } else { "displacement" };
        job.out.line(&format!(
            "{key} = {}",
            toml::numbers(&value.map(f64::from_bits)[..bodies.dim()])
        ));
    }
}
