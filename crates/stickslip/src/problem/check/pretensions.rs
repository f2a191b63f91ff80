//! Cuts through bolts, and what steps do with them.

use super::super::key;
use super::super::nearest::suggest;
use super::super::{Problem, Section, SpaceKind, Tension};
use super::findings::Findings;
use crate::math::normalize;

pub(super) fn check(problem: &Problem, findings: &mut Findings) {
    for (name, pretension) in &problem.pretension {
        let table = ["pretension", name.as_str()];
        match (&pretension.section, &pretension.of) {
            (Section::Plane(plane), of) => {
                let key = |last| ["pretension", name.as_str(), "plane", last];
                findings.vector(problem, &key("point"), &plane.point);
                normal(problem, findings, &key("normal"), &plane.normal);
                if of.is_none() {
                    let first = problem.body.keys().next();
                    let help = first.map_or(String::new(), |body| format!("add of = \"{body}\""));
                    let message =
                        format!("the pretension `{name}` does not say which body it cuts");
                    findings.add(&table, message, help);
                } else if problem.set.contains_key(of.as_deref().unwrap_or_default()) {
                    findings.add(
                        &["pretension", name, "of"],
                        "a set of points has no cells that could be cut",
                        "name a body, or a set of cells of its mesh: body.set",
                    );
                }
            }
            (Section::Facets(facets), of) => {
                let key = |last| ["pretension", name.as_str(), "facets", last];
                if let Some(n) = &facets.normal {
                    normal(problem, findings, &key("normal"), n);
                }
                if !facets.set.contains('.') {
                    let help = "write body.set, a set of facets of a mesh";
                    findings.add(&key("set"), "a cut runs along facets inside a mesh", help);
                }
                if of.is_some() {
                    let message = "facets are of a body by themselves";
                    findings.add(&["pretension", name, "of"], message, "remove the key");
                }
            }
        }
        body(problem, findings, name);
    }
    for (i, step) in problem.step.iter().enumerate() {
        let i = key::entry(i);
        for (name, tension) in &step.pretension {
            let key = ["step", i.as_str(), "pretension", name.as_str()];
            if !problem.pretension.contains_key(name) {
                let names: Vec<&str> = problem.pretension.keys().map(String::as_str).collect();
                let message = format!("`{name}` is not among the pretensions");
                findings.add(&key, message, suggest(name, "pretensions", &names));
            }
            self::tension(problem, findings, &key, tension);
        }
    }
}

/// A normal has a direction; with axial symmetry along the axis.
fn normal(problem: &Problem, findings: &mut Findings, key: &[&str], given: &[f64]) {
    findings.vector(problem, key, given);
    let n = std::array::from_fn(|i| given.get(i).copied().unwrap_or(0.0));
    if normalize(n).is_none() {
        findings.add(key, "the normal is zero", "");
    } else if problem.model.space == SpaceKind::Axisymmetric && n[0] != 0.0 {
        let help = "write normal = [0, 1]: around an axis a bolt is cut across the axis";
        findings.add(key, "the normal is not along the axis", help);
    }
}

/// A rigid body cannot be drawn together.
fn body(problem: &Problem, findings: &mut Findings, name: &str) {
    let pretension = &problem.pretension[name];
    let (of, key) = match &pretension.section {
        Section::Plane(_) => (pretension.of.as_deref(), vec!["pretension", name, "of"]),
        Section::Facets(f) => (
            Some(f.set.as_str()),
            vec!["pretension", name, "facets", "set"],
        ),
    };
    let of = of.and_then(|of| of.split('.').next()).unwrap_or_default();
    if problem.body.get(of).is_some_and(|b| b.rigid) {
        let message = format!("`{of}` is rigid: its sides cannot be drawn together");
        findings.add(&key, message, "make the bolt elastic");
    }
}

/// A step does one thing with a pretension.
fn tension(problem: &Problem, findings: &mut Findings, key: &[&str], tension: &Tension) {
    let Tension {
        force,
        shortening,
        hold,
        amplitude,
    } = tension;
    let given = [force.is_some(), shortening.is_some(), *hold];
    match given.iter().filter(|g| **g).count() {
        1 => {}
        0 => findings.add(
            key,
            "nothing is done",
            "give force, shortening, or hold = true",
        ),
        _ => findings.add(
            key,
            "`force`, `shortening` and `hold` exclude each other",
            "keep one of them: the force follows from the shortening, and the other way round",
        ),
    }
    let Some(name) = amplitude else { return };
    let key = [key, &["amplitude"]].concat();
    if *hold {
        let message = "what is held follows no amplitude";
        findings.add(&key, message, "remove the key, or `hold`");
    }
    if !problem.amplitude.contains_key(name) {
        let names: Vec<&str> = problem.amplitude.keys().map(String::as_str).collect();
        let message = format!("`{name}` is not among the amplitudes");
        findings.add(&key, message, suggest(name, "amplitudes", &names));
    }
}
