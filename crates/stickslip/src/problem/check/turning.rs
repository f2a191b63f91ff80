//! Bodies that turn by any angle, and what they cannot do yet.

use super::super::{BodyRotation, Problem, SpaceKind};
use super::findings::Findings;
use super::names;
use crate::body::loads::LoadKind;
use crate::model::Solution;

pub(super) fn check(problem: &Problem, findings: &mut Findings) {
    check_free(problem, findings);
    check_cells(problem, findings);
    let turning: Vec<(&String, &str)> = (problem.body.iter())
        .filter_map(|(name, body)| Some((name, body.rotation.reference()?)))
        .collect();
    let Some((first, _)) = turning.first() else {
        return;
    };
    for (name, reference) in &turning {
        let key = ["body", name.as_str(), "rotation", "with"];
        let what = "reference points";
        names::one_of(findings, &key, Some(reference), what, &problem.reference);
        if problem.model.space == SpaceKind::Axisymmetric {
            let message = "around an axis of symmetry nothing turns";
            findings.add(&key, message, "model the body in 3D, or remove the key");
        }
    }
    // A rigid body may move.
    let mut elastic = turning
        .iter()
        .filter(|(name, _)| !problem.body[*name].rigid);
    let deforms = elastic.next().map(|(name, _)| name.as_str());
    at_rest_only(problem, first, deforms, findings);
    if problem.solver.method == Solution::Multigrid {
        findings.add(
            &["solver", "method"],
            format!("body `{first}` turns by any angle, and multigrid does not know of that"),
            "take \"condensed\" or \"sparse\"",
        );
    }
    for (name, initial) in &problem.initial {
        if initial.displacement.is_some() || initial.result.is_some() {
            findings.add(
                &["initial", name],
                format!("body `{first}` turns by any angle: displacements to start from are not known in its frame"),
                "begin with a step that leads there",
            );
        }
    }
}

/// Steps that bodies which turn by any angle are not known to: the `first` of them, and the first that `deforms`, as a rigid one may move.
fn at_rest_only(problem: &Problem, first: &str, deforms: Option<&str>, findings: &mut Findings) {
    for (i, step) in problem.step.iter().enumerate() {
        let i = i.to_string();
        let kinds = [
            ("dynamic", step.dynamic.is_some() && deforms.is_some()),
            ("steady", step.steady.is_some()),
            ("modes", step.modes.is_some()),
            ("complex-modes", step.complex_modes.is_some()),
            ("harmonic", step.harmonic.is_some()),
        ];
        for (kind, _) in kinds.into_iter().filter(|(_, given)| *given) {
            let body = deforms.unwrap_or(first);
            findings.add(
                &["step", &i, kind],
                format!(
                    "body `{body}` turns by any angle, which is known to quasi-static steps alone"
                ),
                "leave this step out, or `rotation` of the body",
            );
        }
    }
}

/// Bodies whose cells have frames of their own.
fn check_cells(problem: &Problem, findings: &mut Findings) {
    let all = problem.body.iter();
    let turning = all.filter(|(_, body)| body.rotation == BodyRotation::Corotational);
    let names: Vec<&String> = turning.map(|(name, _)| name).collect();
    let Some(first) = names.first() else {
        return;
    };
    for name in &names {
        sound(problem, name, findings);
    }
    at_rest_only(problem, first, Some(first.as_str()), findings);
    let method = problem.solver.method;
    if matches!(method, Solution::Multigrid | Solution::Condensed) {
        findings.add(
            &["solver", "method"],
            format!(
                "body `{first}` turns cell by cell, so that what it resists with is not linear"
            ),
            "take \"sparse\", or leave the key out",
        );
    }
    let heated = problem.temperature.keys().next();
    let warm = (problem.initial.iter()).find(|(_, i)| i.temperature.is_some());
    let keys = heated.map(|name| ["temperature", name.as_str()]);
    if let Some(key) = keys.or(warm.map(|(name, _)| ["initial", name.as_str()])) {
        findings.add(
            &key,
            format!("body `{first}` turns cell by cell, and temperatures do not turn with cells"),
            "leave temperatures out, or `rotation` of the body",
        );
    }
    for (name, interface) in &problem.interface {
        if interface.kinematics.as_dyn().frozen() {
            findings.add(
                &["interface", name, "kinematics"],
                format!("pairs are those of the start, and body `{first}` turns by any angle"),
                "leave the key out",
            );
        }
    }
    for (name, load) in &problem.load {
        let centrifugal = matches!(load.kind, LoadKind::Centrifugal(_));
        if centrifugal || (load.follow && !matches!(load.kind, LoadKind::Pressure(_))) {
            findings.add(
                &[
                    "load",
                    name,
                    if centrifugal { "centrifugal" } else { "follow" },
                ],
                format!("body `{first}` turns cell by cell, and no load follows it but a pressure"),
                "give the load its direction in space, or take `rotation = \"large\"`",
            );
        }
    }
    let other = |b: &&super::super::Body| b.rotation == BodyRotation::Large;
    let with = (problem.body.values()).find_map(|b| b.rotation.reference());
    if with.is_some() || problem.body.values().any(|b| other(&b)) {
        findings.add(
            &["body", first.as_str(), "rotation"],
            "it turns cell by cell, and another body as a whole",
            "let all bodies turn in one way",
        );
    }
}

/// What a body cannot be whose cells have frames.
fn sound(problem: &Problem, name: &str, findings: &mut Findings) {
    let key = ["body", name, "rotation"];
    if problem.model.space == SpaceKind::Axisymmetric {
        let message = "around an axis of symmetry nothing turns";
        findings.add(&key, message, "model the body in 3D, or remove the key");
    }
    if problem.body[name].rigid {
        let message = "a rigid body has no cells that turn against each other";
        findings.add(
            &key,
            message,
            "take `rotation = \"large\"`, or make it elastic: it may be stiff",
        );
    }
}

/// Bodies with frames of their own.
fn check_free(problem: &Problem, findings: &mut Findings) {
    let free: Vec<&String> = (problem.body.iter())
        .filter_map(|(name, body)| (body.rotation == BodyRotation::Large).then_some(name))
        .collect();
    let Some(first) = free.first() else {
        return;
    };
    for name in &free {
        let key = ["body", name.as_str(), "rotation"];
        if problem.model.space == SpaceKind::Axisymmetric {
            let message = "around an axis of symmetry nothing turns";
            findings.add(&key, message, "model the body in 3D, or remove the key");
        }
    }
    for (i, step) in problem.step.iter().enumerate() {
        let kinds = [
            ("steady", step.steady.is_some()),
            ("modes", step.modes.is_some()),
            ("complex-modes", step.complex_modes.is_some()),
            ("harmonic", step.harmonic.is_some()),
        ];
        for (kind, _) in kinds.into_iter().filter(|(_, given)| *given) {
            findings.add(
                &["step", &i.to_string(), kind],
                format!(
                    "body `{first}` turns freely by any angle, which such a step does not know of"
                ),
                "leave this step out, or `rotation` of the body",
            );
        }
    }
    let warm = problem
        .initial
        .iter()
        .find(|(_, i)| i.temperature.is_some());
    if let Some((name, _)) = warm {
        findings.add(
            &["initial", name, "temperature"],
            format!(
                "body `{first}` turns freely by any angle, and temperatures do not turn with it"
            ),
            "leave temperatures out, or `rotation` of the body",
        );
    }
    let mut elastic = problem.body.values().filter(|b| !b.rigid);
    let with = elastic.find_map(|b| b.rotation.reference());
    if let Some(with) = with
        && let Some(first) = free.iter().find(|name| !problem.body[**name].rigid)
    {
        findings.add(
            &["body", first.as_str(), "rotation"],
            format!("it turns freely, and another body with `{with}`"),
            "let all bodies turn in one way",
        );
    }
}
