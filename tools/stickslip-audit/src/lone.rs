//! Equilibrium of each body by itself, without its stiffness: what contact, loads and supports do to it cancels, and contact carries no more than loads, and supports away
//! from the contact surfaces, give. A support of a point of a contact surface could take up any force that contact makes there; the balance of nodes does not see that.

use std::collections::BTreeSet;

use crate::case::{Case, Space, text_of};
use crate::figure::Report;
use crate::loads;
use crate::mesh::Mesh;
use crate::results::{Results, State};
use crate::side::{Pair, Side};
use crate::vec3::{Vec3, add, along, cross, norm, scale, sub};

/// The sum of contact forces of a body, relative to the sum of their sizes, up to which it is a remainder of forces that cancel.
const REMAINDER: f64 = 0.05;

/// Forces on a body that are known: of loads with their names, and whether anything else acts on it.
struct Body {
    /// Nodes.
    points: BTreeSet<usize>,
    /// Loads and their forces at the factor 1.
    loads: Vec<(String, toml::Table, Vec<Vec3>)>,
    /// What else acts on it, if something does.
    unknown: Option<String>,
}

/// Checks all bodies at all states at rest.
pub fn check(results: &Results, pairs: &[Pair], report: &mut Report) {
    let (case, mesh) = (&results.case, &results.mesh);
    let touching: BTreeSet<usize> = pairs.iter().flat_map(surfaces).collect();
    // A body that only hands forces on has resultants that are rounding.
    let gross = |state: &State| {
        state
            .grid
            .vector("CFORCE")
            .iter()
            .map(|f| norm(*f))
            .sum::<f64>()
    };
    let gross = results
        .states
        .iter()
        .map(gross)
        .fold(f64::MIN_POSITIVE, f64::max);
    for (index, name) in mesh.names.iter().enumerate() {
        let body = Body::new(case, mesh, index);
        if let Some(why) = &body.unknown {
            report.skip(format!("the equilibrium of {name}: {why}"));
            continue;
        }
        one(results, name, &body, &touching, gross, report);
    }
}

/// The points of both sides of an interface.
fn surfaces(pair: &Pair) -> Vec<usize> {
    let of = |side: &Side| match side {
        Side::Body { points, .. } => points.iter().copied().collect(),
        Side::Rigid(_) => Vec::new(),
    };
    let mut all = of(&pair.secondary);
    all.extend(of(&pair.primary));
    all
}

impl Body {
    fn new(case: &Case, mesh: &Mesh, index: usize) -> Body {
        let points = mesh.of_body(index);
        let name = &mesh.names[index];
        let mut body = Body {
            points,
            loads: Vec::new(),
            unknown: None,
        };
        let keys = case.of("body", name);
        // The fields have no reactions at points of rigid bodies.
        let rigid = keys
            .and_then(|k| k.get("rigid"))
            .and_then(toml::Value::as_bool);
        if rigid == Some(true) && supported(case, mesh, &body.points) {
            body.unknown = Some("it is rigid, and supports hold it".into());
        }
        if keys.is_some_and(|k| k.contains_key("rotation")) {
            body.unknown = Some("it turns by any angle".into());
        }
        let bound = |set: &str| {
            mesh.set(case, set)
                .is_some_and(|set| set.iter().any(|p| body.points.contains(p)))
        };
        for (coupling, table) in case.named("coupling") {
            let mut sets: Vec<&str> = Vec::new();
            for keys in table.iter().filter_map(|(_, v)| v.as_table()) {
                sets.extend(
                    ["set", "from", "to"]
                        .iter()
                        .filter_map(|k| text_of(keys, k)),
                );
                let terms = keys.get("terms").and_then(toml::Value::as_array);
                let terms = terms
                    .into_iter()
                    .flatten()
                    .filter_map(toml::Value::as_table);
                sets.extend(terms.filter_map(|t| text_of(t, "set")));
            }
            if sets.into_iter().any(bound) {
                body.unknown = Some(format!("coupling {coupling} acts on it"));
            }
        }
        let material = keys
            .and_then(|k| text_of(k, "material"))
            .and_then(|m| case.of("material", m));
        let kind = material.and_then(|m| m.iter().find_map(|(_, v)| v.as_table()));
        let density = kind
            .and_then(|m| crate::case::number(m, "density"))
            .unwrap_or(0.0);
        for (mass, table) in case.named("mass") {
            let set = text_of(table, "set").and_then(|set| mesh.set(case, set));
            if set.is_none_or(|set| set.iter().any(|p| body.points.contains(p))) {
                body.unknown = Some(format!("mass {mass} is heavy"));
            }
        }
        for (load, table) in case.named("load") {
            let Some(set) = text_of(table, "set") else {
                continue;
            };
            if case.of("reference", set).is_some() {
                continue;
            }
            if table.contains_key("spring") {
                if mesh
                    .set(case, set)
                    .is_none_or(|s| s.iter().any(|p| body.points.contains(p)))
                {
                    body.unknown = Some(format!("springs {load} act on it"));
                }
                continue;
            }
            match loads::forces(case, mesh, table, &|_| density) {
                Some(forces) => body.loads.push((load.to_string(), table.clone(), forces)),
                None => {
                    body.unknown = Some(format!(
                        "load {load} is on a set that only the mesh file knows"
                    ))
                }
            }
        }
        body
    }

    /// Sum and moment about a point of forces on its nodes.
    fn sum(
        &self,
        forces: &[Vec3],
        about: Vec3,
        places: &[Vec3],
        keep: &dyn Fn(usize) -> bool,
    ) -> [Vec3; 2] {
        let mut out = [[0.0; 3]; 2];
        for p in self.points.iter().copied().filter(|p| keep(*p)) {
            out[0] = add(out[0], forces[p]);
            out[1] = add(out[1], cross(sub(places[p], about), forces[p]));
        }
        out
    }
}

fn one(
    results: &Results,
    name: &str,
    body: &Body,
    touching: &BTreeSet<usize>,
    gross: f64,
    report: &mut Report,
) {
    let case = &results.case;
    let ring = case.space == Space::Ring;
    let points = &results.mesh.points;
    let count = body.points.len().max(1) as f64;
    let centre = scale(
        1.0 / count,
        body.points.iter().fold([0.0; 3], |s, p| add(s, points[*p])),
    );
    let size = body
        .points
        .iter()
        .map(|p| norm(sub(points[*p], centre)))
        .fold(f64::MIN_POSITIVE, f64::max);
    let all = |_: usize| true;
    let away = |p: usize| !touching.contains(&p);
    let mut rows = Vec::new();
    let mut largest = gross;
    let resting = |s: &&State| !case.steps[case.step_at(s.t)].dynamic() && s.row.is_some();
    for state in results.states.iter().filter(resting) {
        let mut external = vec![[0.0; 3]; points.len()];
        for (load, table, forces) in &body.loads {
            let factor = case.load_factor(load, table, state.t);
            for (o, f) in external.iter_mut().zip(forces) {
                *o = along(*o, factor, *f);
            }
        }
        // All forces where points have come: a body that is carried along turns nothing.
        let places = state.places();
        let (contact, reaction) = (state.grid.vector("CFORCE"), state.grid.vector("RF"));
        let mut parts = [
            body.sum(&external, centre, &places, &all),
            body.sum(&contact, centre, &places, &all),
            body.sum(&reaction, centre, &places, &all),
            body.sum(&reaction, centre, &places, &away),
        ];
        if ring {
            // What is radial cancels all around.
            parts
                .iter_mut()
                .for_each(|p| (p[0][0], p[1]) = (0.0, [0.0; 3]));
        }
        largest = parts.iter().map(|p| norm(p[0])).fold(largest, f64::max);
        let borne: f64 = body.points.iter().map(|p| norm(contact[*p])).sum();
        rows.push((state.t, parts, borne));
    }
    for (t, [external, contact, reaction, far], borne) in rows {
        // The reaction of a support that is released fades over the step, and no column of the results holds it.
        if released(results, t) {
            continue;
        }
        let rest = |k: usize| norm(add(add(external[k], contact[k]), reaction[k]));
        report.note("body-balance", name, rest(0) / largest, t);
        report.note("body-moment", name, rest(1) / (largest * size), t);
        let given = norm(external[0]).max(norm(far[0]));
        let carried = norm(contact[0]);
        // Where nothing else acts, and no support is near, contact forces cancel: that is the balance. What is left of forces that nearly cancel, as those of two
        // interfaces that press a body between them, says nothing of either.
        let near = norm(sub(reaction[0], far[0]));
        let whole = carried > REMAINDER * borne && carried > 1e-6 * largest;
        if given > 0.0 && whole && near > 1e-3 * carried {
            report.note("beyond-loads", name, carried / given, t);
        }
    }
}

/// Whether a support acts on some of the points.
pub fn supported(case: &Case, mesh: &Mesh, points: &BTreeSet<usize>) -> bool {
    let sets = case.named("support");
    let mut sets = sets
        .iter()
        .filter_map(|(_, table)| mesh.set(case, text_of(table, "set")?));
    sets.any(|set| set.iter().any(|p| points.contains(p)))
}

/// Whether a support was released at the start of the step of a time.
fn released(results: &Results, t: f64) -> bool {
    let steps = &results.case.steps;
    let step = results.case.step_at(t);
    let supports = results.case.named("support");
    step > 0
        && supports.iter().any(|(name, _)| {
            steps[step - 1].lists("supports", name) && !steps[step].lists("supports", name)
        })
}
