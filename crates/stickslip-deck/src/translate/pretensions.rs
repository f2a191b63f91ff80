//! `*PRE-TENSION SECTION`: cuts, and what `*CLOAD` and `*BOUNDARY` of their nodes do with them.

use std::collections::BTreeMap;

use stickslip::problem::{self, FacetSection, Section, Tension};

use super::bodies::Bodies;
use super::job::Job;
use super::names::problem_name;
use super::sets::Sets;
use super::{courses, loads, supports};
use crate::deck::{Pretension, SurfaceParts};

/// Writes the pretensions; their names by node.
pub(super) fn write(job: &mut Job, bodies: &Bodies, sets: &mut Sets) -> BTreeMap<u64, String> {
    let deck = job.deck;
    let mut names = BTreeMap::new();
    for p in &deck.connectors.pretensions {
        let Some(set) = section(job, bodies, sets, p) else {
            continue;
        };
        let name = job.fresh::<problem::Pretension>(&problem_name(&p.surface));
        let normal = p.normal.map(|n| n[..bodies.dim()].to_vec());
        let cut = problem::Pretension {
            of: None,
            section: Section::Facets(FacetSection { set, normal }),
        };
        job.add(&name, p.place, cut);
        names.insert(p.node, name);
    }
    let forces = loads::forces_by_step(job).unwrap_or_default();
    let held = supports::by_step(job);
    for (node, name) in &names {
        steps(job, *node, name, &forces, &held);
    }
    names
}

/// The faces that are cut, under their name; none if they cannot be.
fn section(job: &mut Job, bodies: &Bodies, sets: &mut Sets, p: &Pretension) -> Option<String> {
    let deck = job.deck;
    let surface = deck.surfaces.get(&p.surface)?;
    if bodies.of_node.contains_key(&p.node) {
        job.error(
            p.place,
            format!("node {} is one of a body", deck.label(p.node)),
            "the node of a pretension is one of its own: its first direction is the shortening",
        );
        return None;
    }
    if matches!(surface.parts, SurfaceParts::Nodes(_)) {
        job.error(
            p.place,
            format!("the surface {} consists of nodes", p.surface),
            "a section runs along faces of elements: *SURFACE, TYPE=ELEMENT",
        );
        return None;
    }
    let faces = bodies.faces(&surface.parts);
    let given = faces.values().filter(|list| !list.is_empty());
    if given.count() != 1 {
        job.error(
            p.place,
            format!("the surface {} is not inside one body", p.surface),
            "a section runs along faces that two elements of one connected body share",
        );
        return None;
    }
    let wanted = problem_name(&p.surface);
    sets.facets(bodies, &wanted, &faces)
        .pop()
        .map(|(_, set)| set)
}

/// What the steps do with a pretension: what `*BOUNDARY` prescribes, or else the force.
fn steps(job: &mut Job, node: u64, name: &str, forces: &[loads::Forces], held: &[supports::State]) {
    across(job, node, forces, held);
    // A course is one table for all steps in which it is followed.
    let mut tables: BTreeMap<(bool, String), String> = BTreeMap::new();
    for (i, state) in held.iter().enumerate() {
        let force = forces.get(i).and_then(|f| f.get(&(node, 0)));
        let (what, value, amplitude, given, place) = match (state.get(&(node, 0)), force) {
            (Some(v), _) if v.fixed => {
                let hold = Tension {
                    hold: true,
                    ..Tension::default()
                };
                job.problem.step[i].pretension.insert(name.into(), hold);
                continue;
            }
            (Some(v), _) => ("shortening", v.value, &v.amplitude, v.step == i, v.place),
            (None, Some(f)) => ("force", f.what, &f.amplitude, f.step == i, f.place),
            (None, None) => ("force", 0.0, &None, true, job.deck.steps[i].place),
        };
        let abrupt = courses::abrupt(&job.deck.steps[i]) && given && value != 0.0;
        if abrupt && amplitude.is_none() {
            job.error(
                place,
                format!(
                    "what draws the pretension {name} acts at once in step {}",
                    i + 1
                ),
                "give it an AMPLITUDE, or let it grow by *STEP, AMPLITUDE=RAMP",
            );
            continue;
        }
        let course = amplitude.as_ref().map(|a| {
            let own = what == "force";
            let known = tables.entry((own, a.clone()));
            let course = known.or_insert_with(|| {
                let follows = |k: usize| match own {
                    true => {
                        let f = forces.get(k).and_then(|f| f.get(&(node, 0)));
                        f.map(|f| (f.amplitude.as_ref(), f.step))
                    }
                    false => held[k]
                        .get(&(node, 0))
                        .map(|v| (v.amplitude.as_ref(), v.step)),
                };
                let mine = |k: usize| follows(k).filter(|(b, _)| *b == Some(a));
                let active: Vec<bool> = (0..held.len()).map(|k| mine(k).is_some()).collect();
                let kept = (0..held.len()).map(|k| mine(k).is_some_and(|(_, step)| step < k));
                let kept: Vec<bool> = kept.collect();
                courses::amplitude(job, a, &active, &kept, name)
            });
            course.clone()
        });
        let drawn = what == "force";
        let tension = Tension {
            force: drawn.then_some(value),
            shortening: (!drawn).then_some(value),
            hold: false,
            amplitude: course,
        };
        job.problem.step[i].pretension.insert(name.into(), tension);
    }
}

/// Only the first direction of the node has a meaning.
fn across(job: &mut Job, node: u64, forces: &[loads::Forces], held: &[supports::State]) {
    let of_forces = forces.iter().flat_map(|f| f.range((node, 1)..(node, 6)));
    let of_forces = of_forces.map(|((_, c), f)| (*c, f.what, f.place));
    let of_held = held.iter().flat_map(|s| s.range((node, 1)..(node, 6)));
    let of_held = of_held.map(|((_, c), v)| (*c, v.value, v.place));
    let wrong = of_forces.chain(of_held).find(|(_, value, _)| *value != 0.0);
    if let Some((component, _, place)) = wrong {
        job.error(
            place,
            format!(
                "node {} is that of a pretension and has no direction {}",
                job.deck.label(node),
                component + 1
            ),
            "use direction 1, along the bolt: *CLOAD prescribes the force, *BOUNDARY the shortening",
        );
    }
}
