//! `*EQUATION`, springs and masses.

use std::collections::BTreeSet;

use super::bodies::Bodies;
use super::job::Job;
use super::sets::Sets;
use super::{supports, toml};
use crate::axes;
use crate::card::Place;
use crate::numbering::Numbering;

pub(super) fn write(job: &mut Job, bodies: &Bodies, sets: &mut Sets) {
    let ground = ground(job, bodies);
    equations(job, bodies, sets, &ground);
    springs(job, bodies, sets, &ground);
    masses(job, bodies, sets);
}

/// A term of an equation or a spring.
type Term = (u64, [f64; 3]);

/// Terms as the problem writes them.
fn terms(bodies: &Bodies, sets: &mut Sets, numbering: &Numbering, terms: &[Term]) -> String {
    let mut out = Vec::new();
    for (node, factors) in terms {
        let label = toml::name(&format!("node-{}", numbering.label(*node)));
        let set = sets.points(bodies, &label, &[*node]);
        for (c, f) in ["x", "y", "z"][..bodies.dim()].iter().zip(factors) {
            if *f != 0.0 {
                out.push(format!(
                    "{{ set = {}, component = \"{c}\", factor = {} }}",
                    toml::text(&set),
                    toml::number(*f)
                ));
            }
        }
    }
    format!("[{}]", out.join(", "))
}

fn along(job: &Job, node: u64, component: usize, factor: f64) -> [f64; 3] {
    let local = job
        .deck
        .transforms
        .get(&node)
        .and_then(|t| axes::at_node(t, job.deck.nodes[&node]));
    match local {
        Some(axes) => axes[component].map(|c| c * factor),
        None => std::array::from_fn(|i| if i == component { factor } else { 0.0 }),
    }
}

/// Nodes of no cell that are held in every step: the ground.
fn ground(job: &Job, bodies: &Bodies) -> BTreeSet<u64> {
    let states = supports::by_step(job);
    let still = |n: &u64| {
        let held = |s: &supports::State, c| s.get(&(*n, c)).is_some_and(|v| v.value == 0.0);
        states.iter().all(|s| (0..bodies.dim()).all(|c| held(s, c)))
    };
    let named = states.first().into_iter().flat_map(|s| s.keys());
    let mut out: BTreeSet<u64> = named.map(|(n, _)| *n).collect();
    out.retain(|n| !bodies.of_node.contains_key(n) && still(n));
    out
}

/// Whether all nodes move with a body; it is an error if not.
fn on_bodies(
    job: &mut Job,
    bodies: &Bodies,
    nodes: impl IntoIterator<Item = u64>,
    place: Place,
) -> bool {
    for n in nodes {
        if !bodies.of_node.contains_key(&n) {
            job.error(
                place,
                format!("node {} belongs to no body", job.deck.label(n)),
                "only nodes of solid and plane elements move",
            );
            return false;
        }
    }
    true
}

fn equations(job: &mut Job, bodies: &Bodies, sets: &mut Sets, ground: &BTreeSet<u64>) {
    for (i, e) in job.deck.equations.iter().enumerate() {
        let nodes: Vec<Vec<u64>> = e.terms.iter().map(|t| job.nodes(&t.target)).collect();
        // Sets are paired one by one, in the order of the deck.
        let count = nodes.iter().map(Vec::len).max().unwrap_or(0);
        if nodes.iter().any(|n| n.len() != count && n.len() != 1) {
            job.error(
                e.place,
                "the sets of the equation have different numbers of nodes",
                "each set has as many nodes as the first, or one",
            );
            continue;
        }
        for k in 0..count {
            let list: Vec<Term> = (e.terms.iter().zip(&nodes))
                .map(|(t, n)| {
                    let node = if n.len() == 1 { n[0] } else { n[k] };
                    (node, along(job, node, t.component, t.factor))
                })
                .filter(|t| !ground.contains(&t.0))
                .collect();
            if !on_bodies(job, bodies, list.iter().map(|t| t.0), e.place) {
                break;
            }
            let name = job.fresh("coupling", &format!("equation-{}", i + 1));
            let terms = terms(bodies, sets, &job.deck.numbering, &list);
            job.table("coupling", &name, e.place);
            job.out.line(&format!("equation = {{ terms = {terms} }}"));
        }
    }
}

fn springs(job: &mut Job, bodies: &Bodies, sets: &mut Sets, ground: &BTreeSet<u64>) {
    let deck = job.deck;
    for s in &deck.springs {
        for id in deck.element_sets.get(&s.set).into_iter().flatten() {
            let e = &deck.elements[id];
            let moving = e.nodes.iter().copied().filter(|n| !ground.contains(n));
            let moving: Vec<u64> = moving.collect();
            if moving.is_empty() || !on_bodies(job, bodies, moving.iter().copied(), e.place) {
                continue;
            }
            let name = job.fresh(
                "coupling",
                &toml::name(&format!("spring-{}", deck.label(*id))),
            );
            let stiffness = toml::number(s.stiffness);
            let direction = |k: usize| {
                s.directions
                    .get(k)
                    .or(s.directions.first())
                    .copied()
                    .unwrap_or(0)
            };
            let line = match e.kind.as_str() {
                "SPRINGA" if moving.len() < 2 => {
                    // To the ground: along the line to it.
                    let [a, b] = [e.nodes[0], e.nodes[1]].map(|n| deck.nodes[&n]);
                    let Some(line) = stickslip::math::normalize(stickslip::math::sub(b, a)) else {
                        job.error(
                            e.place,
                            format!("spring {id} has no length"),
                            "use SPRING2 with directions",
                        );
                        continue;
                    };
                    format!(
                        "spring = {{ terms = {}, stiffness = {stiffness} }}",
                        terms(bodies, sets, &deck.numbering, &[(moving[0], line)])
                    )
                }
                "SPRINGA" => {
                    let label = |n: u64| toml::name(&format!("node-{}", deck.label(n)));
                    let a = sets.points(bodies, &label(e.nodes[0]), &e.nodes[..1]);
                    let b = sets.points(bodies, &label(e.nodes[1]), &e.nodes[1..2]);
                    format!(
                        "axial-spring = {{ from = {}, to = {}, stiffness = {stiffness} }}",
                        toml::text(&a),
                        toml::text(&b)
                    )
                }
                "SPRING1" => {
                    let list = [(e.nodes[0], along(job, e.nodes[0], direction(0), 1.0))];
                    format!(
                        "spring = {{ terms = {}, stiffness = {stiffness} }}",
                        terms(bodies, sets, &deck.numbering, &list)
                    )
                }
                "SPRING2" => {
                    let list = [
                        (e.nodes[0], along(job, e.nodes[0], direction(0), 1.0)),
                        (e.nodes[1], along(job, e.nodes[1], direction(1), -1.0)),
                    ];
                    let list: Vec<Term> =
                        list.into_iter().filter(|t| moving.contains(&t.0)).collect();
                    format!(
                        "spring = {{ terms = {}, stiffness = {stiffness} }}",
                        terms(bodies, sets, &deck.numbering, &list)
                    )
                }
                _ => {
                    job.error(
                        s.place,
                        format!("element {} ({}) is no spring", deck.label(*id), e.kind),
                        "*SPRING is for SPRINGA, SPRING1 and SPRING2",
                    );
                    continue;
                }
            };
            job.table("coupling", &name, e.place);
            job.out.line(&line);
        }
    }
}

fn masses(job: &mut Job, bodies: &Bodies, sets: &mut Sets) {
    let deck = job.deck;
    for (set, mass, place) in &deck.masses {
        let ids = deck.element_sets.get(set).into_iter().flatten();
        let nodes: Vec<u64> = ids
            .filter_map(|id| deck.elements[id].nodes.first().copied())
            .collect();
        if !on_bodies(job, bodies, nodes.iter().copied(), *place) {
            continue;
        }
        let name = job.fresh("mass", &toml::name(set));
        let set = sets.points(bodies, &toml::name(&format!("{set}-nodes")), &nodes);
        job.table("mass", &name, *place);
        job.out.line(&format!("set = {}", toml::text(&set)));
        job.out.line(&format!("mass = {}", toml::number(*mass)));
    }
}
