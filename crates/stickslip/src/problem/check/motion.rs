//! What dynamic steps need.

use super::super::Problem;
use super::Findings;
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
    let mut t = 0.0;
    for (i, step) in problem.step.iter().enumerate() {
        let start = t;
        t += step.duration;
        let Some(dynamic) = &step.dynamic else {
            continue;
        };
        let i = i.to_string();
        let scheme = &dynamic.scheme;
        let key = ["step", &i, "dynamic", "scheme", scheme.kind()];
        findings.faults(&key, scheme.as_dyn().faults());
        covered(problem, findings, step, (start, t));
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

/// In motion a table that ends too early would hold its last value silently.
fn covered(
    problem: &Problem,
    findings: &mut Findings,
    step: &super::super::Step,
    (start, end): (f64, f64),
) {
    fn on(list: &Option<Vec<String>>, name: &str) -> bool {
        list.as_ref().is_none_or(|l| l.iter().any(|n| n == name))
    }
    let mut used: Vec<&String> = Vec::new();
    for (name, load) in &problem.load {
        if on(&step.loads, name) {
            used.extend(&load.amplitude);
        }
    }
    for (name, support) in &problem.support {
        if on(&step.supports, name) {
            used.extend(&support.amplitude);
        }
    }
    for (name, coupling) in &problem.coupling {
        if on(&step.couplings, name) {
            used.extend(&coupling.amplitude);
        }
    }
    used.sort();
    used.dedup();
    let within = |rows: &[f64]| {
        let first = rows.first().copied().unwrap_or(0.0);
        let last = rows.last().copied().unwrap_or(0.0);
        let slack = 1e-9 * (end - start);
        first <= start + slack && last >= end - slack
    };
    let mut report = |key: &[&str], rows: Vec<f64>| {
        if rows.len() > 1 && !within(&rows) {
            let message = format!(
                "the table goes from {} to {}, the dynamic step from {start} to {end}",
                rows[0],
                rows[rows.len() - 1]
            );
            findings.add(
                key,
                message,
                "add rows until it covers the time of the step",
            );
        }
    };
    for name in used {
        if let Some(amplitude) = problem.amplitude.get(name) {
            let rows = amplitude.table.iter().map(|r| r[0]).collect();
            report(&["amplitude", name, "table"], rows);
        }
    }
    for (name, interface) in &problem.interface {
        if let Some(table) = &interface.primary_velocity_table
            && on(&step.interfaces, name)
        {
            let rows = table.iter().filter_map(|r| r.first().copied()).collect();
            report(&["interface", name, "primary-velocity-table"], rows);
        }
    }
}
