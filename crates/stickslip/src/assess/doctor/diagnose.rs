//! From an attempt that failed to a finding.

use super::finding::{DoctorCause, Finding};
use super::friction::friction_coefficient;
use super::motions::{FloatingBody, Row, floating, rows};
use super::record::Counters;
use super::released::let_go;
use super::signs::{prescribed_slip, signs, too_large_slip};
use super::suspect::{LocationKind, Severity, Suspect};
use super::{balance, check, coupling, places};
use crate::assess::view::View;
use crate::body::Formulation;
use crate::contact::interface::ContactView;
use crate::contact::look;
use crate::contact::look::Opposite;
use crate::contact::response::Status;
use crate::error::RunError;
use crate::math::Vec3;
use crate::model::definition::Model;
use crate::model::rigid::drivers;
use crate::number::{digits, figure};
use crate::shape::ElementKind;
use crate::system::{Cause, Evidence, StepFailure};
use crate::time::Trial;

/// Guilty points whose stiffness is looked at.
const LOOKED_AT: usize = 5;

/// What to try where memory is short.
pub(crate) const MORE_MEMORY: &str = "a coarser mesh away from the contact, `solver.method = \"multigrid\"` in 3D, or a machine with more memory";

/// A finding about an attempt that failed, the `attempt`-th of its increment.
pub(crate) fn diagnose(
    view: &View,
    trial: &Trial,
    attempt: usize,
    counters: Counters,
    failure: &StepFailure,
) -> Finding {
    let evidence: Vec<&Evidence> = failure
        .culprits
        .iter()
        .filter_map(|c| c.evidence.as_deref())
        .collect();
    let root = root(view, &failure.cause);
    let mut finding = root.unwrap_or_else(|| match failure.cause {
        Cause::Singular => singular(view, trial, failure),
        Cause::LinearSolver | Cause::Interior => linear(view, trial),
        Cause::NotConverged => not_converged(view, trial, &evidence),
        Cause::NotFinite => DoctorCause::NotFinite
            .warning("")
            .advise("smaller increments; look for a stiffness or a load that is far too large"),
        Cause::CollapsedCell => DoctorCause::CollapsedCell
            .warning("")
            .advise("repair the mesh there, or take smaller increments"),
        Cause::TooFar => DoctorCause::TooFar.note(""),
        Cause::Reach => DoctorCause::BeyondReach.note(""),
        Cause::Memory => DoctorCause::Stopped.error("").advise(MORE_MEMORY),
        Cause::Engine => DoctorCause::Stopped.error(""),
        Cause::Event | Cause::Interrupted => DoctorCause::Stopped.note(""),
    });
    finding = with_drivers(finding, view, trial);
    if finding.message.is_empty() {
        finding.message = failure.message.clone();
    } else {
        finding.message = format!("{}: {}", finding.message, failure.message);
    }
    // What the friction problem does not settle comes first: it knows all points together.
    let otherwise = failure.otherwise.as_deref();
    let first = otherwise.map_or(&[][..], |o| &o.culprits);
    let mut named: Vec<&Evidence> = Vec::new();
    for culprit in first.iter().chain(&failure.culprits) {
        let Some(e) = culprit.evidence.as_deref() else {
            continue;
        };
        let known = |n: &&Evidence| n.interface == e.interface && n.position == e.position;
        if !named.iter().any(known) {
            named.push(e);
            finding = finding.blame(point(e, culprit.what.clone()));
        }
    }
    if let Some(otherwise) = otherwise {
        finding.message = format!("{}; {}", finding.message, otherwise.message);
    }
    // What helps against the failure does not help against the mistake that led to it.
    if !finding.cause.is_mistake() {
        finding.advice.extend(otherwise.map(|o| o.help.clone()));
        finding.advice.extend(failure.help.clone());
    }
    finding.tried = tried(view, trial, attempt, counters);
    finding.step = Some(view.step_name().to_string());
    finding.time = Some(trial.from);
    finding
}

/// A mistake in the model that keeps any system from being solved.
fn root(view: &View, cause: &Cause) -> Option<Finding> {
    match cause {
        Cause::TooFar
        | Cause::Reach
        | Cause::Event
        | Cause::Interrupted
        | Cause::Memory
        | Cause::Engine => {
            return None;
        }
        Cause::Singular
        | Cause::LinearSolver
        | Cause::Interior
        | Cause::NotConverged
        | Cause::CollapsedCell => {}
        Cause::NotFinite => {
            // Laws of the families are finite wherever they are asked.
            let own = view.contact.interfaces.iter().find(|i| i.laws.user.any());
            let faulty = own.map(|i| {
                DoctorCause::FaultyLaw.warning(format!(
                    "interface {}: a function that is used as a law gives something that is not finite, or a negative limit of friction",
                    i.name
                ))
                .blame(Suspect::interface(&i.name, "laws from functions"))
                .advise("try the function at the gaps, pressures and speeds of the last increment")
            });
            return check::roots(view).into_iter().next().or(faulty);
        }
    }
    check::roots(view).into_iter().next()
}

/// A run that ended for a reason of which there is no finding yet.
pub(crate) fn stopped(view: &View, error: &RunError) -> Finding {
    if let Some(mut finding) = check::roots(view).into_iter().next() {
        finding.severity = Severity::Error;
        finding.message = format!("{}: {}", finding.message, error.message);
        finding.step = Some(view.step_name().to_string());
        finding.time = Some(error.time);
        return finding;
    }
    let culprits = error.culprits.iter().cloned();
    let mut finding = (DoctorCause::Stopped.error(error.message.clone()))
        .blame_all(culprits.map(|culprit| Suspect::key("", culprit)));
    finding.advice.extend(error.help.clone());
    finding.step = Some(view.step_name().to_string());
    finding.time = Some(error.time);
    finding
}

/// The evidence as a place.
fn point(e: &Evidence, remark: String) -> Suspect {
    Suspect {
        what: LocationKind::Node,
        id: e.node,
        ..Suspect::interface(&e.interface, remark)
    }
    .at(e.position)
}

fn tried(view: &View, trial: &Trial, attempt: usize, counters: Counters) -> Vec<String> {
    let now = &view.solver.newton.statistics;
    let count = |now: usize, then: usize| now.saturating_sub(then);
    let mut tried = vec![format!(
        "increment {} to {}, attempt {attempt}: {} Newton iterations with line search",
        digits(trial.from, 6),
        digits(trial.to, 6),
        count(now.iterations, counters.iterations)
    )];
    match count(now.augmentations, counters.augmentations) {
        0 => {}
        n => tried.push(format!("{n} updates of the multipliers")),
    }
    if now.fallbacks > counters.fallbacks {
        tried.push("the increment as a friction problem".to_string());
    }
    tried
}

/// What contact holds in the state of the last evaluation.
fn contact_rows(view: &View, t: f64) -> Vec<Row> {
    let mut out = Vec::new();
    let histories = &view.frame.contacts.interfaces;
    for (interface, history) in view.contact.interfaces.iter().zip(histories) {
        if !interface.schedule.active(t) {
            continue;
        }
        let mut opposite = Opposite::new(interface, t);
        for (i, status) in look::statuses(interface, history).into_iter().enumerate() {
            if status != Status::Open {
                let normal = look::evidence(interface, i).normal;
                rows(interface, &mut opposite, i, normal, status, &mut out);
            }
        }
    }
    out
}

fn singular(view: &View, trial: &Trial, failure: &StepFailure) -> Finding {
    let free = floating(view, trial.to, &contact_rows(view, trial.to));
    let by_contact = floating(view, trial.to, &[]);
    if !by_contact.is_empty()
        && let Some(finding) = balance::unbalanced(view, trial.to)
    {
        return finding;
    }
    if !free.is_empty() {
        // A body that contact cannot hold because its sides look the wrong way needs no other support.
        let turned = check::opposed(view);
        return turned.unwrap_or_else(|| free_mode(view, trial, &free, "is held by nothing"));
    }
    let model = view.model;
    // A body in pieces is held only where its supports are.
    if let Some(finding) = check::disconnected(model).into_iter().next() {
        return finding;
    }
    // The points that were in contact at the end may not be those with which the system was singular.
    match by_contact.is_empty() {
        true => near_singular(view, failure),
        false => free_mode(view, trial, &by_contact, "is held by contact alone"),
    }
}

fn near_singular(view: &View, failure: &StepFailure) -> Finding {
    let model = view.model;
    let mut finding = DoctorCause::NearSingularOperator
        .warning("the system is singular although every body is held")
        .advise(singular_help(model, failure.dof));
    if let Some(dof) = failure.dof {
        let (point, component) = model.dofs.locate(dof);
        if point < model.mesh.points.len() {
            let direction = ["x", "y", "z"][component];
            finding = finding.blame(places::node(model, point, format!("direction {direction}")));
        }
    }
    finding
}

/// What to do where the stiffness is singular at a dof though every body is held.
pub(crate) fn singular_help(model: &Model, dof: Option<usize>) -> String {
    let point = dof.map(|dof| model.dofs.locate(dof).0);
    let mut bodies = model.elastic().filter(|body| {
        let mut kinds =
            (body.elastic.parts().iter()).map(|part| model.mesh.blocks[part.block].kind);
        point.is_some_and(|p| body.points.contains(&p))
            && body.elastic.formulation() == Formulation::Reduced
            && kinds.any(|kind| matches!(kind, ElementKind::Quad8 | ElementKind::Hex20))
    });
    match bodies.next() {
        Some(body) => format!(
            "body {} has reduced integration, with which few quadratic cells have motions without strain: `body.{}.formulation = \"standard\"`, or more cells",
            body.name, body.name
        ),
        None => "look for cells that hang on one node or edge, for supports of too few points, and for materials of very different stiffness".to_string(),
    }
}

/// Bodies that move as a whole, what drives them, and how far they are from what might hold them.
fn free_mode(view: &View, trial: &Trial, free: &[FloatingBody], how: &str) -> Finding {
    let model = view.model;
    let index = |l: &FloatingBody| model.bodies.iter().position(|b| b.name == l.body);
    let touching = free.iter().filter_map(index);
    if let Some(body) = touching.into_iter().find(|&b| view.touches(b)) {
        return lost(view, free, body);
    }
    let mut finding = DoctorCause::FreeRigidMode
        .warning("a body is free to move as a rigid body")
        .blame_all(free.iter().map(|l| l.place(model, how)));
    for (interface, accepted) in view.contact.interfaces.iter().zip(view.contacts()) {
        let Some((i, gap)) = smallest_gap(accepted, trial.from) else {
            continue;
        };
        let e = look::evidence(interface, i);
        if gap > 0.0 {
            finding = finding.blame(point(
                &e,
                format!(
                    "gap {gap}, the smallest at the last state",
                    gap = figure(gap)
                ),
            ));
        }
    }
    finding
        .advise("support these motions, or hold them by weak springs (`[load.NAME] spring`)")
        .advise("move the bodies until they touch, or prescribe a displacement instead of a force")
}

/// Bodies that were in contact and move as a whole all the same.
fn lost(view: &View, free: &[FloatingBody], body: usize) -> Finding {
    let model = view.model;
    let name = &model.bodies[body].name;
    let own = free.iter().find(|l| l.body == *name);
    let motion = own.map_or("", |l| l.motion.as_str());
    let resisted = free
        .iter()
        .map(|l| l.place(model, "is not resisted any more"));
    DoctorCause::SlidesAway.warning(format!(
        "body {name} slides, rolls or lifts off as a whole ({motion}): contact and friction do not hold it"
    ))
    .blame_all(resisted)
    .advise("no equilibrium was found: lower what drives the body, raise friction or support the motion")
    .advise("make the step dynamic if the body is meant to slide or take off")
}

/// A finding about a body that moves as a whole with what drives it, if it is not there yet.
fn with_drivers(finding: Finding, view: &View, trial: &Trial) -> Finding {
    let moves = matches!(
        finding.cause,
        DoctorCause::SlidesAway | DoctorCause::FreeRigidMode
    );
    let mut suspects = finding.suspects.iter();
    if !moves || suspects.any(|g| g.what == LocationKind::Key) {
        return finding;
    }
    let mut suspects = finding.suspects.iter();
    let named = suspects
        .find(|g| g.what == LocationKind::Body)
        .map(|g| &g.name);
    let mut bodies = view.model.bodies.iter();
    match named.and_then(|name| bodies.position(|b| b.name == *name)) {
        Some(body) => driven(finding, view, body, trial),
        None => finding,
    }
}

/// With the loads, supports and obstacles that drive a body, and the supports that held it in the step before.
fn driven(finding: Finding, view: &View, body: usize, trial: &Trial) -> Finding {
    let drivers = drivers::drivers(view, body, trial.to).into_iter();
    let finding = finding.blame_all(drivers.map(|d| Suspect::key(d.key, d.what)));
    let free: Vec<String> = (finding.suspects.iter())
        .filter(|g| g.what == LocationKind::Body)
        .map(|g| g.name.clone())
        .collect();
    let gone = let_go(view, &free).into_iter();
    gone.fold(finding, |f, gone| {
        f.blame(Suspect::key(gone.key, gone.what))
            .advise(gone.advice)
    })
}

/// The point nearest to the primary at the last accepted state, or as meshed where there is none, and its gap.
fn smallest_gap(interface: ContactView, t: f64) -> Option<(usize, f64)> {
    let accepted = look::initial_gaps(interface);
    let finite = accepted.into_iter().enumerate();
    let accepted = finite.filter(|(_, g)| g.is_finite());
    if let Some(found) = accepted.min_by(|a, b| a.1.total_cmp(&b.1)) {
        return Some(found);
    }
    let mut opposite = Opposite::new(interface.definition, t);
    let gaps = interface.points.iter().enumerate().filter_map(|(i, p)| {
        let nearest = opposite.nearest(p.position(&interface.reference))?;
        Some((i, nearest.gap))
    });
    gaps.min_by(|a, b| a.1.total_cmp(&b.1))
}

fn linear(view: &View, trial: &Trial) -> Finding {
    let free = floating(view, trial.to, &contact_rows(view, trial.to));
    if !free.is_empty() {
        return free_mode(view, trial, &free, "is held by nothing");
    }
    let moves = view.step().is_some_and(|s| s.dynamic.is_some());
    let beyond = || balance::at_limit(view, trial.to);
    if let Some(finding) = (!moves).then(beyond).flatten() {
        return finding;
    }
    let weak = floating(view, trial.to, &[]);
    if weak.is_empty() {
        return DoctorCause::LinearSolver
            .warning("")
            .advise("set `solver.method = \"sparse\"`");
    }
    DoctorCause::NearSingularOperator
        .warning("bodies are held by contact alone, and hardly by that")
        .advise("support these motions, or hold them by weak springs (`[load.NAME] spring`)")
        .blame_all(
            weak.iter()
                .map(|l| l.place(view.model, "is held by contact alone")),
        )
}

fn not_converged(view: &View, trial: &Trial, evidence: &[&Evidence]) -> Finding {
    let dynamic = view.model.steps[view.frame.step].dynamic.is_some();
    if !dynamic {
        let free = floating(view, trial.to, &contact_rows(view, trial.to));
        if !free.is_empty()
            && let Some(finding) = balance::unbalanced(view, trial.to)
        {
            return finding;
        }
        if let Some(first) = free.first() {
            let finding = DoctorCause::SlidesAway.warning(format!(
                "body {} slides or tips off as a whole ({}): contact and friction do not balance the loads",
                first.body, first.motion
            ))
            .advise("no equilibrium exists: lower the load, raise friction or support the motion")
            .advise("make the step dynamic if the body is meant to take off");
            let gone = |l: &FloatingBody| l.place(view.model, "is not resisted any more");
            return finding.blame_all(free.iter().map(gone));
        }
    }
    if !dynamic && let Some(finding) = balance::at_limit(view, trial.to) {
        return finding;
    }
    if let Some((mu, limit, e)) = beyond_coupling(view, evidence) {
        return DoctorCause::CoulombNonUniqueness.warning(format!(
            "the coefficient of friction, {mu:.3}, is above the coupling limit {limit:.3} of interface {}: there may be several \
             solutions, or none",
            e.interface
        ))
        .blame(point(
            e,
            format!("k_t / |k_tn| = {limit:.3}, friction {mu:.3}"),
        ))
        .advise(format!("a coefficient of friction below {limit:.3}"))
        .advise("a dynamic step: inertia decides between solutions")
        .advise("a regularised slip rule (`slip.regularised`)");
    }
    let signs = signs(evidence);
    let told = signs
        .as_ref()
        .is_some_and(|f| f.cause != DoctorCause::Chatter);
    let to_and_fro = signs.clone().filter(|_| !told);
    let prescribed = match told {
        true => None,
        false => prescribed_slip(view, trial),
    };
    let prescribed = prescribed.map(|(slip, interface)| too_large_slip(slip, &interface));
    check::same_body(view)
        .or(prescribed)
        .or(signs.filter(|_| told))
        .or_else(|| check::suspects(view.model, dynamic).into_iter().next())
        .or(to_and_fro)
        .unwrap_or_else(|| DoctorCause::NotConverged.warning(""))
}

/// The first suspect point at which friction is above the coupling limit: coefficient, limit, point.
fn beyond_coupling<'a>(view: &View, evidence: &[&'a Evidence]) -> Option<(f64, f64, &'a Evidence)> {
    let found = evidence.iter().take(LOOKED_AT).filter_map(|e| {
        let interfaces = &view.contact.interfaces;
        let interface = interfaces.iter().find(|i| i.name == e.interface)?;
        let own = friction_coefficient(interface)?;
        let now = if e.pressure > 0.0 {
            e.limit / e.pressure
        } else {
            0.0
        };
        let mu = own.max(now);
        let &[point] = e.points.as_slice() else {
            return None;
        };
        let normal: Vec3 = e.normal;
        let limit = coupling::limit(view, point, normal)?;
        (mu >= limit).then_some((mu, limit, *e))
    });
    found.min_by(|a, b| (a.1).total_cmp(&b.1))
}
