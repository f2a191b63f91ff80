//! Bodies that turn by any angle, and what they cannot do yet.

use super::super::{Problem, SpaceKind};
use super::findings::Findings;
use super::names;
use crate::model::Solution;

pub(super) fn check(problem: &Problem, findings: &mut Findings) {
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
    for (i, step) in problem.step.iter().enumerate() {
        let i = i.to_string();
        let kinds = [
            ("dynamic", step.dynamic.is_some()),
            ("steady", step.steady.is_some()),
            ("modes", step.modes.is_some()),
            ("complex-modes", step.complex_modes.is_some()),
        ];
        for (kind, _) in kinds.into_iter().filter(|(_, given)| *given) {
            findings.add(
                &["step", &i, kind],
                format!(
                    "body `{first}` turns by any angle, which is known to quasi-static steps alone"
                ),
                "leave this step out, or `rotation` of the body",
            );
        }
    }
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
