//! Bodies that turn by any angle, and what the [table of capabilities](crate::model::capability) says of all bodies and laws.

use super::super::key;
use super::super::{Body, BodyRotation, Cycles, Problem, SpaceKind};
use super::findings::Findings;
use super::names;
use crate::body::loads::LoadKind;
use crate::model::capability::{Feature, Subject, limit};
use crate::model::{Jump, Solution};
use crate::time::scheme::Method;

pub(super) fn check(problem: &Problem, findings: &mut Findings) {
    references(problem, findings);
    one_way(problem, findings);
    capabilities(problem, findings);
}

/// How a body is described.
fn subject(body: &Body) -> Subject {
    match (&body.rotation, body.rigid) {
        (BodyRotation::Small, false) => Subject::Linear,
        (BodyRotation::Small, true) => Subject::Rigid,
        (BodyRotation::With(_), false) => Subject::Axle,
        (BodyRotation::With(_), true) => Subject::RigidAxle,
        (BodyRotation::Large, false) => Subject::Free,
        (BodyRotation::Large, true) => Subject::RigidFree,
        (BodyRotation::Corotational, _) => Subject::Cells,
    }
}

/// A feature that a problem uses, and the key where it does; of an axis of symmetry the key is that of the body.
struct Use {
    feature: Feature,
    key: Option<Vec<String>>,
}

/// Says of each feature that is used which body or law does not go with it.
fn capabilities(problem: &Problem, findings: &mut Findings) {
    let bodies = (problem.body.iter()).map(|(name, body)| (subject(body), "body", name));
    let laws = problem.interface.iter().filter_map(|(name, interface)| {
        let states = interface.friction.as_dyn().states();
        (!states.is_empty()).then_some((Subject::FrictionState, "interface", name))
    });
    let subjects: Vec<_> = bodies.chain(laws).collect();
    for used in uses(problem) {
        let found = subjects
            .iter()
            .find_map(|s| Some((s, limit(s.0, used.feature)?)));
        if let Some(((_, table, name), limit)) = found {
            let own = || {
                ["body", name.as_str(), "rotation"]
                    .map(String::from)
                    .to_vec()
            };
            let key = used.key.unwrap_or_else(own);
            let key: Vec<&str> = key.iter().map(String::as_str).collect();
            let message = format!("{table} `{name}` {}", limit.why);
            findings.add(&key, message, limit.help);
        }
    }
}

/// The features that a problem uses, as far as its tables say. Supports, couplings and springs are judged where the points are known on which they act.
fn uses(problem: &Problem) -> Vec<Use> {
    let mut uses = Vec::new();
    let mut add = |feature: Feature, key: &[&str]| {
        let key = match feature {
            Feature::Axisymmetric => None,
            _ => Some(key.iter().map(|k| k.to_string()).collect()),
        };
        uses.push(Use { feature, key });
    };
    if problem.model.space == SpaceKind::Axisymmetric {
        add(Feature::Axisymmetric, &[]);
    }
    for (i, step) in problem.step.iter().enumerate() {
        let i = key::entry(i);
        let motion = step
            .dynamic
            .as_ref()
            .map(|d| match d.scheme.as_dyn().method() {
                Method::Explicit { .. } => Feature::Explicit,
                Method::Implicit(_) => Feature::Implicit,
            });
        let kinds = [
            ("dynamic", motion),
            ("steady", step.steady.as_ref().map(|_| Feature::Steady)),
            ("modes", step.modes.as_ref().map(|_| Feature::Modes)),
            (
                "complex-modes",
                step.complex_modes.as_ref().map(|_| Feature::ComplexModes),
            ),
            (
                "harmonic",
                step.harmonic.as_ref().map(|_| Feature::Harmonic),
            ),
        ];
        let every = |cycles: &Cycles| cycles.jump == Jump::Fixed(1);
        if step.cycles.as_ref().is_some_and(|c| !every(c)) {
            add(Feature::CycleJumps, &["step", &i, "cycles"]);
        }
        for (key, feature) in kinds {
            if let Some(feature) = feature {
                add(feature, &["step", &i, key]);
            }
        }
    }
    match problem.solver.method {
        Solution::Condensed => add(Feature::Condensed, &["solver", "method"]),
        Solution::Multigrid => add(Feature::Multigrid, &["solver", "method"]),
        Solution::Sparse => add(Feature::Sparse, &["solver", "method"]),
        _ => {}
    }
    for name in problem.temperature.keys() {
        add(Feature::Temperature, &["temperature", name]);
    }
    for (name, initial) in &problem.initial {
        if initial.temperature.is_some() {
            add(
                Feature::InitialTemperature,
                &["initial", name, "temperature"],
            );
        }
        if initial.displacement.is_some() || initial.result.is_some() {
            add(Feature::InitialDisplacement, &["initial", name]);
        }
    }
    for (name, load) in &problem.load {
        if matches!(load.kind, LoadKind::Centrifugal(_)) {
            add(Feature::Centrifugal, &["load", name, "centrifugal"]);
        } else if load.follow && !matches!(load.kind, LoadKind::Pressure(_)) {
            add(Feature::Following, &["load", name, "follow"]);
        }
    }
    // Bodies that turn as wholes are judged where it is known which interfaces they have.
    let cells = problem.body.values().any(|b| subject(b) == Subject::Cells);
    for (name, interface) in problem.interface.iter().filter(|_| cells) {
        if interface.kinematics.as_dyn().frozen() {
            add(Feature::SmallSliding, &["interface", name, "kinematics"]);
        }
    }
    uses
}

/// Reference points that carry bodies have to exist.
fn references(problem: &Problem, findings: &mut Findings) {
    for (name, body) in &problem.body {
        if let Some(reference) = body.rotation.reference() {
            let key = ["body", name.as_str(), "rotation", "with"];
            let what = "reference points";
            names::one_of(findings, &key, Some(reference), what, &problem.reference);
        }
    }
}

/// Elastic bodies turn in one way, and cells are those of an elastic body.
fn one_way(problem: &Problem, findings: &mut Findings) {
    let of = |wanted: Subject| {
        let mut all = problem.body.iter();
        all.find_map(|(name, body)| (subject(body) == wanted).then_some(name))
    };
    let with = |rigid: bool| {
        let mut all = problem.body.values().filter(|b| rigid || !b.rigid);
        all.find_map(|b| b.rotation.reference())
    };
    let help = "let all bodies turn in one way";
    if let Some(name) = of(Subject::Cells)
        && (with(true).is_some() || of(Subject::Free).or(of(Subject::RigidFree)).is_some())
    {
        let message = "it turns cell by cell, and another body as a whole";
        findings.add(&["body", name, "rotation"], message, help);
    }
    if let (Some(name), Some(with)) = (of(Subject::Free), with(false)) {
        let message = format!("it turns freely, and another body with `{with}`");
        findings.add(&["body", name, "rotation"], message, help);
    }
    for (name, body) in &problem.body {
        if body.rigid && body.rotation == BodyRotation::Corotational {
            findings.add(
                &["body", name, "rotation"],
                "a rigid body has no cells that turn against each other",
                "take `rotation = \"large\"`, or make it elastic: it may be stiff",
            );
        }
    }
}
