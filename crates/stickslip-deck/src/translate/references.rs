//! Reference points of the problem: reference nodes of couplings and rigid sets of nodes, and nodes without a body that springs, masses and equations move.

use std::collections::{BTreeMap, BTreeSet};

use stickslip::body::couplings::{CouplingKind, Distributing, Kinematic, SetWeight, Weights};
use stickslip::math::{add, norm, scale, sub};

use stickslip::problem::Reference;

use super::bodies::Bodies;
use super::job::Job;
use super::links::{self, couple};
use super::names::problem_name;
use super::sets::Sets;
use super::supports::{self, COMPONENTS};
use crate::card::Place;
use crate::deck::{Action, Deck, NodeCoupling, SurfaceParts, Tied, Way};
use stickslip::number::figure;

/// Names the nodes that are reference points.
pub(super) fn find(job: &mut Job, bodies: &mut Bodies) {
    let deck = job.deck;
    let mut nodes: BTreeSet<u64> = deck
        .connectors
        .couplings
        .iter()
        .map(|c| c.reference)
        .collect();
    for index in bodies.rigid_nodes.keys() {
        match deck.connectors.rigid[*index].reference {
            Some(n) => nodes.extend([n]),
            None => job.error(
                deck.connectors.rigid[*index].place,
                "the rigid set of nodes has no reference node",
                "give REF NODE: what the nodes follow",
            ),
        }
    }
    nodes.extend(constrained(job, bodies));
    let ground = links::ground(job, bodies);
    let loose = loose(job, bodies);
    nodes.extend(loose.difference(&ground));
    for n in nodes {
        let wanted = problem_name(&format!("node-{}", deck.label(n)));
        let taken = |name: &str| bodies.all.iter().any(|b| b.name == name);
        let mut name = wanted.clone();
        while taken(&name) || bodies.references.values().any(|v| *v == name) {
            name += "-r";
        }
        bodies.references.insert(n, name);
    }
}

/// Nodes that multi-point constraints make reference points: those that beams start from, and those without a body.
fn constrained(job: &Job, bodies: &Bodies) -> BTreeSet<u64> {
    let mut out = BTreeSet::new();
    for c in &job.deck.connectors.constraints {
        let loose = c.nodes.iter().filter(|n| !bodies.of_node.contains_key(n));
        out.extend(loose);
        if c.kind == "BEAM" {
            out.extend(c.nodes.get(1));
        }
    }
    out
}

/// Nodes without a body that something moves.
fn loose(job: &Job, bodies: &Bodies) -> BTreeSet<u64> {
    let deck = job.deck;
    let sections = deck
        .connectors
        .springs
        .iter()
        .chain(&deck.connectors.dashpots);
    let sets = sections.map(|s| &s.set);
    let sets = sets.chain(deck.connectors.gaps.iter().map(|g| &g.set));
    let sets = sets.chain(deck.connectors.masses.iter().map(|(set, ..)| set));
    let elements = sets.filter_map(|s| deck.element_sets.get(s)).flatten();
    let mut nodes: BTreeSet<u64> = (elements.filter_map(|e| deck.elements.get(e)))
        .flat_map(|e| e.nodes.iter().copied())
        .collect();
    for e in &deck.connectors.equations {
        nodes.extend(e.terms.iter().flat_map(|t| job.nodes(&t.target)));
    }
    // The reference node of a body that is rigid as a whole stands for that.
    let whole = |n: &u64| {
        let of = |r: &crate::deck::Rigid| [r.reference, r.rotation].contains(&Some(*n));
        let index = deck.connectors.rigid.iter().position(of);
        index.is_some_and(|i| !bodies.rigid_nodes.contains_key(&i))
    };
    nodes.retain(|n| !bodies.of_node.contains_key(n) && !whole(n));
    nodes
}

/// The nodes whose results are those of reference points: by name, and whether their displacements are rotations.
pub(super) fn printed(deck: &Deck, bodies: &Bodies) -> BTreeMap<u64, (String, bool)> {
    let own = bodies.references.iter().filter(|(n, _)| bodies.refers(**n));
    let mut out: BTreeMap<u64, (String, bool)> =
        own.map(|(n, name)| (*n, (name.clone(), false))).collect();
    for r in &deck.connectors.rigid {
        if let (Some(reference), Some(rotation)) = (r.reference, r.rotation)
            && let Some(name) = bodies.references.get(&reference)
        {
            out.insert(rotation, (name.clone(), true));
        }
    }
    out
}

/// The tables of reference points and of what is tied to them.
pub(super) fn write(job: &mut Job, bodies: &Bodies, sets: &mut Sets) {
    let deck = job.deck;
    for (node, name) in &bodies.references {
        let place = (deck.connectors.couplings.iter())
            .find(|c| c.reference == *node)
            .map_or(Place::default(), |c| c.place);
        let point = Reference {
            point: deck.nodes[node][..bodies.dim()].to_vec(),
            mass: None,
            inertia: None,
        };
        job.add(name, place, point);
        // A node of a body that others refer to.
        if bodies.of_node.contains_key(node) {
            let set = sets.points(bodies, &format!("{name}-point"), &[*node]);
            follow(job, &format!("{name}-point"), place, set, name);
        }
    }
    for (index, nodes) in &bodies.rigid_nodes {
        let rigid = &deck.connectors.rigid[*index];
        let Some(reference) = rigid.reference else {
            continue;
        };
        let label = rigid.nodes.clone().unwrap_or_else(|| "RIGID".into());
        let set = sets.points(bodies, &problem_name(&label), nodes);
        let name = format!("rigid-{}", problem_name(&label));
        let reference = &bodies.references[&reference];
        follow(job, &name, rigid.place, set, reference);
    }
    for coupling in &deck.connectors.couplings {
        coupled(job, bodies, sets, coupling);
    }
}

/// A coupling by which points follow a reference point.
pub(super) fn follow(job: &mut Job, name: &str, place: Place, set: String, reference: &str) {
    let reference = reference.into();
    let all = Kinematic {
        set,
        reference,
        components: None,
    };
    couple(job, name, place, CouplingKind::Kinematic(all));
}

fn coupled(job: &mut Job, bodies: &Bodies, sets: &mut Sets, coupling: &NodeCoupling) {
    let NodeCoupling {
        name,
        place,
        reference,
        ..
    } = coupling;
    let Some(way) = coupling.way else {
        let help = "*KINEMATIC or *DISTRIBUTING in the next line says how";
        job.error(
            *place,
            format!("coupling {name} does not say how it ties"),
            help,
        );
        return;
    };
    let reference = bodies.references[reference].clone();
    let label = problem_name(name);
    let Some((set, weights)) = tied(job, bodies, sets, coupling) else {
        return;
    };
    if way == Way::Distributing {
        refuse_left_out(job, coupling);
        warn_of_arm(job, bodies, coupling);
        let mean = Distributing {
            set,
            reference,
            weights,
        };
        couple(job, &label, *place, CouplingKind::Distributing(mean));
        return;
    }
    let dim = bodies.dim();
    let chosen = &coupling.components[..dim];
    if !chosen.contains(&true) {
        let message = format!("coupling {name} ties no displacement");
        job.error(
            *place,
            message,
            "nodes of bodies have directions 1 to 3 alone",
        );
        return;
    }
    let all = chosen.iter().all(|c| *c);
    if coupling.orientation.is_some() && !all {
        job.error(
            *place,
            format!("coupling {name} ties some of the directions of an *ORIENTATION"),
            "tie all directions, or those along the axes of the model",
        );
        return;
    }
    let some = COMPONENTS.into_iter().zip(chosen).filter(|(_, c)| **c);
    let some = some.map(|(component, _)| component).collect();
    let tied = Kinematic {
        set,
        reference,
        components: (!all).then_some(some),
    };
    couple(job, &label, *place, CouplingKind::Kinematic(tied));
}

/// Where a reference node lies beside the centre of the nodes of a `*DISTRIBUTING COUPLING`, its force has an arm in Abaqus, and here; in CalculiX the
/// place of the node does not matter.
fn warn_of_arm(job: &mut Job, bodies: &Bodies, coupling: &NodeCoupling) {
    let Tied::Nodes(list) = &coupling.tied else {
        return;
    };
    let (mut sum, mut total, mut size) = ([0.0; 3], 0.0, 0.0_f64);
    let point = job.deck.nodes[&coupling.reference];
    for (target, weight) in list {
        for node in own(bodies, coupling, &job.nodes(target)) {
            let arm = sub(job.deck.nodes[&node], point);
            sum = add(sum, scale(*weight, arm));
            total += weight;
            size = size.max(norm(arm));
        }
    }
    let arm = norm(sum) / total;
    if total > 0.0 && arm > 1e-3 * size {
        let message = format!(
            "coupling {}: the reference node lies {arm} from the centre of its nodes: a force there has that arm, as in Abaqus; in CalculiX the place of the node does not matter",
            coupling.name,
            arm = figure(arm)
        );
        let help = "for what CalculiX does, put the node where the centre is";
        job.warn(coupling.place, message, help);
    }
}

/// It is an error if something acts on the reference node of a distributing coupling in a direction that its list leaves out: the point follows the mean
/// motion in all of them.
fn refuse_left_out(job: &mut Job, coupling: &NodeCoupling) {
    let steps = job.deck.steps.iter().flat_map(|s| &s.actions);
    let forces = steps.filter_map(|a| match a {
        Action::Force {
            target, component, ..
        } if job.nodes(target).contains(&coupling.reference) => Some(*component),
        _ => None,
    });
    let states = supports::by_step(job);
    let held = (states.iter().flat_map(|s| s.keys()))
        .filter(|(n, _)| *n == coupling.reference)
        .map(|(_, component)| *component);
    let acts: BTreeSet<usize> = forces.chain(held).collect();
    let turned = coupling.orientation.is_some();
    if turned && !acts.is_empty() {
        let message = format!(
            "coupling {}: something acts on the reference node of a *DISTRIBUTING with an *ORIENTATION: along its axes in CalculiX, and along those of the model in Abaqus",
            coupling.name
        );
        let help = "leave ORIENTATION out, and give what acts along the axes of the model";
        job.error(coupling.place, message, help);
        return;
    }
    let left_out = |c: &&usize| coupling.components.get(**c) == Some(&false);
    if let Some(component) = acts.iter().find(left_out) {
        let message = format!(
            "coupling {}: *DISTRIBUTING leaves out direction {}, in which something acts on its reference node",
            coupling.name,
            component + 1
        );
        let help = "list the direction, or leave the list out: the node follows the mean motion in all directions";
        job.error(coupling.place, message, help);
    }
}

/// The set that is tied, and the weights of its points.
fn tied(
    job: &mut Job,
    bodies: &Bodies,
    sets: &mut Sets,
    coupling: &NodeCoupling,
) -> Option<(String, Weights)> {
    let (place, name) = (coupling.place, problem_name(&coupling.name));
    let nothing = |job: &mut Job, what: &str| {
        let message = format!("coupling {} ties {what}", coupling.name);
        job.error(
            place,
            message,
            "name a surface or nodes of solid or plane elements",
        );
    };
    match &coupling.tied {
        Tied::Surface(surface) => {
            let Some(found) = job.deck.surfaces.get(surface) else {
                nothing(job, &format!("the surface {surface}, which is not there"));
                return None;
            };
            if let SurfaceParts::Nodes(nodes) = &found.parts {
                let own = own(bodies, coupling, nodes);
                if own.is_empty() {
                    nothing(job, "no node of a body");
                    return None;
                }
                let set = sets.points(bodies, &problem_name(surface), &own);
                return Some((set, Weights::Uniform));
            }
            let by = bodies.faces(&found.parts);
            let facets = sets.facets(bodies, &problem_name(surface), &by);
            match facets.as_slice() {
                [] => {
                    nothing(job, "no face of a body");
                    None
                }
                [(_, one)] => Some((one.clone(), Weights::Area)),
                // The points of faces of several bodies.
                _ => {
                    let names = facets.into_iter().map(|(_, name)| name).collect();
                    Some((sets.union(&name, names), Weights::Area))
                }
            }
        }
        Tied::Nodes(list) => {
            let mut by_weight: BTreeMap<u64, Vec<u64>> = BTreeMap::new();
            for (target, weight) in list {
                let nodes = job.nodes(target);
                let own = own(bodies, coupling, &nodes);
                by_weight.entry(weight.to_bits()).or_default().extend(own);
            }
            let all: Vec<u64> = by_weight.values().flatten().copied().collect();
            if all.is_empty() {
                nothing(job, "no node of a body");
                return None;
            }
            let set = sets.points(bodies, &format!("{name}-nodes"), &all);
            if by_weight.len() == 1 {
                return Some((set, Weights::Uniform));
            }
            let mut parts = Vec::new();
            for (i, (weight, nodes)) in by_weight.iter().enumerate() {
                parts.push(SetWeight {
                    set: sets.points(bodies, &format!("{name}-nodes-{}", i + 1), nodes),
                    weight: f64::from_bits(*weight),
                });
            }
            Some((set, Weights::Sets(parts)))
        }
    }
}

/// Nodes of bodies, without the reference node.
fn own(bodies: &Bodies, coupling: &NodeCoupling, nodes: &[u64]) -> Vec<u64> {
    let own = |n: &&u64| bodies.of_node.contains_key(n) && **n != coupling.reference;
    nodes.iter().filter(own).copied().collect()
}
