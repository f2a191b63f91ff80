//! What dynamic steps need.

use super::super::Problem;
use super::super::key;
use super::findings::Findings;
use crate::registry::Family;

pub(super) fn check(problem: &Problem, findings: &mut Findings) {
    if problem.step.iter().all(|s| s.dynamic.is_none()) {
        for name in problem.initial.keys() {
            if problem.initial[name].velocity.is_some() || problem.initial[name].spin.is_some() {
                findings.add(
                    &["initial", name],
                    "no step is dynamic: a velocity has no meaning",
                    "add `dynamic = {}` to a step",
                );
            }
        }
        return;
    }
    densities(problem, findings);
    for (i, step) in problem.step.iter().enumerate() {
        let Some(dynamic) = &step.dynamic else {
            continue;
        };
        let i = key::entry(i);
        let scheme = &dynamic.scheme;
        let key = ["step", &i, "dynamic", "scheme", scheme.kind()];
        findings.faults(&key, scheme.as_dyn().faults());
    }
    for (name, initial) in &problem.initial {
        let Some(wanted) = &initial.step else {
            continue;
        };
        let named = problem
            .step
            .iter()
            .find(|s| s.name.as_ref() == Some(wanted));
        match named {
            None => findings.add(
                &["initial", name, "step"],
                format!("there is no step `{wanted}`"),
                "give the name of a dynamic step",
            ),
            Some(step) if step.dynamic.is_none() => findings.add(
                &["initial", name, "step"],
                format!("the step `{wanted}` is not dynamic"),
                "",
            ),
            Some(_) => {}
        }
    }
}

/// A body without mass cannot be accelerated.
fn densities(problem: &Problem, findings: &mut Findings) {
    // Rigid bodies need a density in any case.
    for (name, body) in problem.body.iter().filter(|(_, b)| !b.rigid) {
        for material in body.material.iter().chain(body.regions.values()) {
            let Some(model) = problem.material.get(material) else {
                continue;
            };
            if model.as_dyn().density() <= 0.0 {
                findings.add(
                    &["material", material, model.kind()],
                    format!(
                        "body `{name}` moves in a dynamic step, but its material has no density"
                    ),
                    "give `density`, the mass per volume in the units of the other values",
                );
            }
        }
    }
}
