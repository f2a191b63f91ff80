//! `*EQUATION`, springs and masses.

use std::collections::BTreeSet;

use stickslip::body::couplings::{self, AxialSpring, CouplingKind, Dashpot, Equation, Gap, Spring};
use stickslip::problem::{Coupling, Mass};

use super::bodies::Bodies;
use super::job::Job;
use super::names::problem_name;
use super::sets::Sets;
use super::supports::{self, COMPONENTS};
use crate::axes;
use crate::card::Place;
use crate::deck::Action;

pub(super) fn write(job: &mut Job, bodies: &Bodies, sets: &mut Sets) {
    let ground = ground(job, bodies);
    equations(job, bodies, sets, &ground);
    springs(job, bodies, sets, &ground);
    gaps(job, bodies, sets, &ground);
    masses(job, bodies, sets);
}

/// A term of an equation or a spring.
pub(super) type Term = (u64, [f64; 6]);

/// Terms as the problem has them, without those of the ground.
fn terms(
    job: &Job,
    bodies: &Bodies,
    sets: &mut Sets,
    ground: &BTreeSet<u64>,
    terms: &[Term],
) -> Vec<couplings::Term> {
    let mut out = Vec::new();
    for (node, factors) in terms.iter().filter(|t| !ground.contains(&t.0)) {
        let label = problem_name(&format!("node-{}", job.deck.label(*node)));
        let set = sets.points(bodies, &label, &[*node]);
        let turned = bodies.references.get(node).cloned().unwrap_or_default();
        for (i, (component, factor)) in COMPONENTS.into_iter().zip(*factors).enumerate() {
            // What the plane does not have is not there.
            let there = i < bodies.dim() || i == 5 || i > 2 && bodies.dim() == 3;
            if factor != 0.0 && there {
                out.push(couplings::Term {
                    set: if i < 3 { set.clone() } else { turned.clone() },
                    component,
                    factor,
                });
            }
        }
    }
    out
}

/// Displacements along a direction, times a factor.
fn straight([x, y, z]: [f64; 3], factor: f64) -> [f64; 6] {
    [x * factor, y * factor, z * factor, 0.0, 0.0, 0.0]
}

fn along(job: &Job, node: u64, component: usize, factor: f64) -> [f64; 6] {
    let axis = along_axes(job, node, component % 3, factor);
    let mut out = [0.0; 6];
    let first = component - component % 3;
    out[first..first + 3].copy_from_slice(&axis);
    out
}

fn along_axes(job: &Job, node: u64, component: usize, factor: f64) -> [f64; 3] {
    let local = job
        .deck
        .properties
        .transforms
        .get(&node)
        .and_then(|t| axes::at_node(t, job.deck.nodes[&node]));
    match local {
        Some(axes) => axes[component].map(|c| c * factor),
        None => std::array::from_fn(|i| if i == component { factor } else { 0.0 }),
    }
}

/// Nodes of no cell that are held in every step: the ground.
pub(super) fn ground(job: &Job, bodies: &Bodies) -> BTreeSet<u64> {
    let states = supports::by_step(job);
    let still = |n: &u64| {
        let held = |s: &supports::State, c| s.get(&(*n, c)).is_some_and(|v| v.value == 0.0);
        states.iter().all(|s| (0..bodies.dim()).all(|c| held(s, c)))
    };
    let named = states.first().into_iter().flat_map(|s| s.keys());
    let mut out: BTreeSet<u64> = named.map(|(n, _)| *n).collect();
    let own = |n: &u64| bodies.of_node.contains_key(n) || bodies.references.contains_key(n);
    out.retain(|n| !own(n) && still(n));
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
        if !bodies.of_node.contains_key(&n) && !bodies.references.contains_key(&n) {
            job.error(
                place,
                format!("node {} belongs to no body", job.deck.label(n)),
                "only nodes of solid and plane elements and reference nodes move",
            );
            return false;
        }
    }
    true
}

/// The steps in which the equation of a dependent displacement, a node and its direction, has not been removed.
fn held(job: &Job, node: u64, component: usize) -> Vec<bool> {
    let mut on = true;
    let removes = |a: &Action| match a {
        Action::RemoveEquations { target: None, .. } => true,
        Action::RemoveEquations {
            target: Some(t),
            components,
            ..
        } => components.contains(&component) && job.nodes(t).contains(&node),
        _ => false,
    };
    let steps = job.deck.steps.iter();
    let after = steps.map(|s| {
        on &= !s.actions.iter().any(removes);
        on
    });
    after.collect()
}

fn equations(job: &mut Job, bodies: &Bodies, sets: &mut Sets, ground: &BTreeSet<u64>) {
    for (i, e) in job.deck.connectors.equations.iter().enumerate() {
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
                    let (node, component) = supports::turned(job, node, t.component);
                    (node, along(job, node, component, t.factor))
                })
                .filter(|t| !ground.contains(&t.0))
                .collect();
            let turns = |t: &&Term| t.1[3..].iter().any(|f| *f != 0.0);
            let stiff = |t: &&Term| !bodies.references.contains_key(&t.0);
            if let Some((n, _)) = list.iter().filter(turns).find(stiff) {
                let message = format!("node {} cannot turn", job.deck.label(*n));
                job.error(
                    e.place,
                    message,
                    "only reference nodes have directions 4 to 6",
                );
                break;
            }
            if !on_bodies(job, bodies, list.iter().map(|t| t.0), e.place) {
                break;
            }
            let dependent = match (e.terms.first(), nodes.first()) {
                (Some(t), Some(n)) => (if n.len() == 1 { n[0] } else { n[k] }, t.component),
                _ => continue,
            };
            let name = equation(
                job,
                bodies,
                sets,
                &format!("equation-{}", i + 1),
                e.place,
                &list,
            );
            let steps = held(job, dependent.0, dependent.1);
            if steps.contains(&false) {
                job.acts::<Coupling>(name, steps);
            }
        }
    }
}

/// An element between one or two nodes, of which some may be the ground.
struct Link<'a> {
    element: u64,
    kind: &'a str,
    nodes: &'a [u64],
    place: Place,
}

/// The elements of a set that act on something that moves.
fn links<'a>(
    job: &mut Job<'a>,
    bodies: &Bodies,
    set: &str,
    ground: &BTreeSet<u64>,
) -> Vec<Link<'a>> {
    let deck = job.deck;
    let mut out = Vec::new();
    for id in deck.element_sets.get(set).into_iter().flatten() {
        let e = &deck.elements[id];
        let moving: Vec<u64> = e
            .nodes
            .iter()
            .copied()
            .filter(|n| !ground.contains(n))
            .collect();
        if !moving.is_empty() && on_bodies(job, bodies, moving, e.place) {
            out.push(Link {
                element: *id,
                kind: &e.kind,
                nodes: &e.nodes,
                place: e.place,
            });
        }
    }
    out
}

/// The direction from the first node of an element to the second; it is an error if they lie at the same place.
fn line(job: &mut Job, link: &Link, help: &str) -> Option<[f64; 3]> {
    let [a, b] = [link.nodes[0], link.nodes[1]].map(|n| job.deck.nodes[&n]);
    let line = stickslip::math::normalize(stickslip::math::sub(b, a));
    if line.is_none() {
        let label = job.deck.label(link.element);
        let message = format!(
            "the nodes of element {label} ({}) lie at the same place",
            link.kind
        );
        job.error(link.place, message, help);
    }
    line
}

/// The elongation of a spring or dashpot as terms.
fn elongation(job: &mut Job, link: &Link, directions: &[usize]) -> Option<Vec<Term>> {
    let direction = |k: usize| {
        directions
            .get(k)
            .or(directions.first())
            .copied()
            .unwrap_or(0)
    };
    let along = |k: usize, factor| {
        let node = link.nodes[k];
        (node, along(job, node, direction(k), factor))
    };
    match link.kind {
        "SPRING1" | "DASHPOT1" => Some(vec![along(0, 1.0)]),
        "SPRING2" | "DASHPOT2" => Some(vec![along(0, 1.0), along(1, -1.0)]),
        _ => {
            let help = "use SPRING2 or DASHPOT2, with directions";
            let line = line(job, link, help)?;
            Some(vec![
                (link.nodes[0], straight(line, -1.0)),
                (link.nodes[1], straight(line, 1.0)),
            ])
        }
    }
}

/// Adds a coupling; its name.
pub(super) fn couple(job: &mut Job, wanted: &str, place: Place, kind: CouplingKind) -> String {
    let name = job.fresh::<Coupling>(wanted);
    let amplitude = None;
    job.add(&name, place, Coupling { amplitude, kind });
    name
}

/// The name of the coupling that an element is.
fn name_of(job: &Job, what: &str, link: &Link) -> String {
    problem_name(&format!("{what}-{}", job.deck.label(link.element)))
}

/// It is an error if an element is not of a kind that its card is for.
fn is_of(job: &mut Job, link: &Link, kinds: &[&str], card: &str, place: Place) -> bool {
    let known = kinds.contains(&link.kind);
    if !known {
        let label = job.deck.label(link.element);
        job.error(
            place,
            format!("element {label} ({}) is none of {card}", link.kind),
            &format!("{card} is for {}", kinds.join(", ")),
        );
    }
    known
}

/// An equation between displacements; its name.
pub(super) fn equation(
    job: &mut Job,
    bodies: &Bodies,
    sets: &mut Sets,
    name: &str,
    place: Place,
    list: &[Term],
) -> String {
    let terms = terms(job, bodies, sets, &BTreeSet::new(), list);
    let equation = Equation { terms, value: 0.0 };
    couple(job, name, place, CouplingKind::Equation(equation))
}

fn springs(job: &mut Job, bodies: &Bodies, sets: &mut Sets, ground: &BTreeSet<u64>) {
    let deck = job.deck;
    for s in &deck.connectors.springs {
        for link in links(job, bodies, &s.set, ground) {
            let kinds = ["SPRINGA", "SPRING1", "SPRING2"];
            if !is_of(job, &link, &kinds, "*SPRING", s.place) {
                continue;
            }
            let stiffness = s.stiffness;
            let both = link.nodes.iter().all(|n| !ground.contains(n));
            let kind = if link.kind == "SPRINGA" && both {
                let label = |n: u64| problem_name(&format!("node-{}", deck.label(n)));
                let [from, to] = [0, 1].map(|k| {
                    let node = link.nodes[k];
                    sets.points(bodies, &label(node), &[node])
                });
                CouplingKind::AxialSpring(AxialSpring {
                    from,
                    to,
                    stiffness,
                })
            } else if let Some(list) = elongation(job, &link, &s.directions) {
                let terms = terms(job, bodies, sets, ground, &list);
                CouplingKind::Spring(Spring { terms, stiffness })
            } else {
                continue;
            };
            couple(job, &name_of(job, "spring", &link), link.place, kind);
        }
    }
    for s in &deck.connectors.dashpots {
        for link in links(job, bodies, &s.set, ground) {
            let kinds = ["DASHPOTA", "DASHPOT1", "DASHPOT2"];
            if !is_of(job, &link, &kinds, "*DASHPOT", s.place) {
                continue;
            }
            if let Some(list) = elongation(job, &link, &s.directions) {
                let terms = terms(job, bodies, sets, ground, &list);
                let coefficient = s.stiffness;
                let kind = CouplingKind::Dashpot(Dashpot { terms, coefficient });
                couple(job, &name_of(job, "dashpot", &link), link.place, kind);
            }
        }
    }
}

fn gaps(job: &mut Job, bodies: &Bodies, sets: &mut Sets, ground: &BTreeSet<u64>) {
    let deck = job.deck;
    for g in &deck.connectors.gaps {
        for link in links(job, bodies, &g.set, ground) {
            if !is_of(job, &link, &["GAPUNI"], "*GAP", g.place) {
                continue;
            }
            let given = (g.direction != [0.0; 3]).then_some(g.direction);
            let help = "give *GAP the direction in which the gap opens";
            let Some(along) = given.or_else(|| line(job, &link, help)) else {
                continue;
            };
            let list = vec![
                (link.nodes[0], straight(along, -1.0)),
                (link.nodes[1], straight(along, 1.0)),
            ];
            if bodies.dim() == 2 && along[0] == 0.0 && along[1] == 0.0 {
                job.error(
                    g.place,
                    "a gap along z in the plane",
                    "gaps open along x and y",
                );
                continue;
            }
            let kind = CouplingKind::Gap(Gap {
                terms: terms(job, bodies, sets, ground, &list),
                clearance: g.clearance,
                stiffness: g.stiffness,
            });
            couple(job, &name_of(job, "gap", &link), link.place, kind);
        }
    }
}

fn masses(job: &mut Job, bodies: &Bodies, sets: &mut Sets) {
    let deck = job.deck;
    for (set, mass, place) in &deck.connectors.masses {
        let ids = deck.element_sets.get(set).into_iter().flatten();
        let nodes: Vec<u64> = ids
            .filter_map(|id| deck.elements[id].nodes.first().copied())
            .collect();
        if !on_bodies(job, bodies, nodes.iter().copied(), *place) {
            continue;
        }
        let (alone, of_bodies): (Vec<u64>, Vec<u64>) =
            nodes.into_iter().partition(|n| bodies.refers(*n));
        let mut groups: Vec<Vec<u64>> = alone.into_iter().map(|n| vec![n]).collect();
        if !of_bodies.is_empty() {
            groups.push(of_bodies);
        }
        for nodes in groups {
            let name = job.fresh::<Mass>(&problem_name(set));
            let set = sets.points(bodies, &problem_name(&format!("{set}-nodes")), &nodes);
            let mass = *mass;
            job.add(name, *place, Mass { set, mass });
        }
    }
}
