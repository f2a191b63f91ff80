//! From an attempt that failed to a finding.

use super::finding::{DoctorCause, Finding, Guilty, Severity, What};
use super::motions::{Loose, Row, loose, rows};
use super::surfaces::Opposite;
use super::{Chart, check};
use super::{balance, coupling};
use crate::contact::interface::{Interface, Primary};
use crate::contact::law::friction::FrictionPoint;
use crate::contact::response::Status;
use crate::error::RunError;
use crate::math::{Vec3, add_scaled, dot, norm, sub};
use crate::simulation::run::Simulation;
use crate::system::{Cause, Evidence, StepFailure};
use crate::time::Trial;

/// Status changes of a point in one attempt that count as chatter.
const CHATTER: f64 = 4.0;

/// How often a point has left the edge of the primary that has lost its projection.
const LEFT: f64 = 2.0;

/// Slip over an increment relative to the facet that is too large.
const FAR: f64 = 0.5;

/// Guilty points whose stiffness is looked at.
const LOOKED_AT: usize = 5;

/// A finding about an attempt that failed, the `attempt`-th of its increment.
pub(in crate::simulation) fn diagnose(
    simulation: &Simulation,
    (trial, attempt, chart): (&Trial, usize, Chart),
    failure: &StepFailure,
) -> Finding {
    let evidence: Vec<&Evidence> = failure
        .culprits
        .iter()
        .filter_map(|c| c.evidence.as_deref())
        .collect();
    let mut finding = match failure.cause {
        Cause::Singular => singular(simulation, trial, failure),
        Cause::LinearSolver => linear(simulation, trial),
        Cause::NotConverged => not_converged(simulation, trial, &evidence),
        Cause::NotFinite => Finding::new(DoctorCause::NotFinite, Severity::Warning, "")
            .advise("smaller increments; look for a stiffness or a load that is far too large"),
        Cause::CollapsedCell => Finding::new(DoctorCause::CollapsedCell, Severity::Warning, "")
            .advise("repair the mesh there, or take smaller increments"),
        Cause::TooFar => Finding::new(DoctorCause::TooFar, Severity::Note, ""),
        Cause::Reach => Finding::new(DoctorCause::BeyondReach, Severity::Note, ""),
        Cause::Event => Finding::new(DoctorCause::Stopped, Severity::Note, ""),
    };
    if finding.message.is_empty() {
        finding.message = failure.message.clone();
    } else {
        finding.message = format!("{}: {}", finding.message, failure.message);
    }
    for (culprit, e) in failure.culprits.iter().zip(&evidence) {
        finding = finding.blame(point(e, culprit.what.clone()));
    }
    finding.advice.extend(failure.help.clone());
    finding.tried = tried(simulation, trial, attempt, chart);
    finding.step = Some(simulation.step_name().to_string());
    finding.time = Some(trial.from);
    finding
}

/// A run that ended for a reason of which there is no finding yet.
pub(in crate::simulation) fn stopped(simulation: &Simulation, error: &RunError) -> Finding {
    let mut finding = Finding::new(DoctorCause::Stopped, Severity::Error, error.message.clone());
    for culprit in &error.culprits {
        finding = finding.blame(Guilty::key("", culprit.clone()));
    }
    finding.advice.extend(error.help.clone());
    finding.step = Some(simulation.step_name().to_string());
    finding.time = Some(error.time);
    finding
}

/// The evidence as a place.
fn point(e: &Evidence, remark: String) -> Guilty {
    Guilty {
        what: What::Node,
        name: e.interface.clone(),
        id: e.node,
        interface: Some(e.interface.clone()),
        body: None,
        position: None,
        remark,
    }
    .at(e.position)
}

fn tried(simulation: &Simulation, trial: &Trial, attempt: usize, chart: Chart) -> Vec<String> {
    let now = &simulation.newton.statistics;
    let count = |now: usize, then: usize| now.saturating_sub(then);
    let mut tried = vec![format!(
        "increment {:.6e} to {:.6e}, attempt {attempt}: {} Newton iterations with line search",
        trial.from,
        trial.to,
        count(now.iterations, chart.iterations)
    )];
    match count(now.augmentations, chart.augmentations) {
        0 => {}
        n => tried.push(format!("{n} updates of the multipliers")),
    }
    match count(now.continuations, chart.continuations) {
        0 => {}
        n => tried.push(format!(
            "{n} continuations from soft stick to the law itself"
        )),
    }
    tried
}

/// What contact holds in the state of the last evaluation.
fn contact_rows(simulation: &Simulation, t: f64) -> Vec<Row> {
    let mut out = Vec::new();
    for interface in &simulation.model.interfaces {
        if !interface.schedule.active(t) {
            continue;
        }
        let mut opposite = Opposite::new(interface, t);
        for (i, status) in interface.statuses().into_iter().enumerate() {
            if status != Status::Open {
                let normal = interface.evidence(i).normal;
                rows(interface, &mut opposite, (i, normal, status), &mut out);
            }
        }
    }
    out
}

fn singular(simulation: &Simulation, trial: &Trial, failure: &StepFailure) -> Finding {
    let free = loose(simulation, trial.to, &contact_rows(simulation, trial.to));
    let by_contact = loose(simulation, trial.to, &[]);
    if !by_contact.is_empty()
        && let Some(finding) = balance::unbalanced(simulation, trial.to)
    {
        return finding;
    }
    if !free.is_empty() {
        return free_mode(simulation, trial, &free, "is held by nothing");
    }
    let model = &simulation.model;
    // A body in pieces is held only where its supports are.
    if let Some(finding) = check::disconnected(model).into_iter().next() {
        return finding;
    }
    // The points that were in contact at the end may not be those with which the system was singular.
    match by_contact.is_empty() {
        true => near_singular(simulation, failure),
        false => free_mode(simulation, trial, &by_contact, "is held by contact alone"),
    }
}

fn near_singular(simulation: &Simulation, failure: &StepFailure) -> Finding {
    let model = &simulation.model;
    let mut finding = Finding::new(
        DoctorCause::NearSingularOperator,
        Severity::Warning,
        "the system is singular although every body is held",
    )
    .advise(
        "look for cells that hang on one node or edge, for supports of too few points, and for materials of very different stiffness",
    );
    if let Some(dof) = failure.dof {
        let (point, component) = model.dofs.locate(dof);
        if point < model.mesh.points.len() {
            let direction = ["x", "y", "z"][component];
            finding = finding.blame(node(simulation, point, format!("direction {direction}")));
        }
    }
    finding
}

/// A point of the mesh.
fn node(simulation: &Simulation, point: usize, remark: String) -> Guilty {
    let model = &simulation.model;
    let body = model.bodies.iter().find(|b| b.points.contains(&point));
    let name = body.map_or(String::new(), |b| b.name.clone());
    Guilty {
        what: What::Node,
        id: Some(model.mesh.point_ids[point]),
        body: Some(name.clone()),
        name,
        remark,
        ..Guilty::default()
    }
    .at(model.mesh.points[point])
}

/// Bodies that move as a whole, and how far they are from what might hold them.
fn free_mode(simulation: &Simulation, trial: &Trial, free: &[Loose], how: &str) -> Finding {
    let mut finding = Finding::new(
        DoctorCause::FreeRigidMode,
        Severity::Warning,
        "a body is free to move as a rigid body",
    );
    for l in free {
        let remark = format!("{} {how}", l.motion);
        finding = finding.blame(check::body(&simulation.model, &l.body, remark));
    }
    for interface in &simulation.model.interfaces {
        let Some((i, gap)) = smallest_gap(interface, trial.from) else {
            continue;
        };
        let e = interface.evidence(i);
        if gap > 0.0 {
            finding = finding.blame(point(&e, format!("gap {gap:.3e}, the smallest")));
        }
    }
    finding
        .advise("support these motions, or hold them by weak springs (`[load.NAME] spring`)")
        .advise("move the bodies until they touch, or prescribe a displacement instead of a force")
}

/// The point nearest to the primary in the reference configuration, and its gap.
fn smallest_gap(interface: &Interface, t: f64) -> Option<(usize, f64)> {
    let mut opposite = Opposite::new(interface, t);
    let gaps = interface.points.iter().enumerate().filter_map(|(i, p)| {
        let nearest = opposite.nearest(p.position(&interface.reference))?;
        Some((i, nearest.gap))
    });
    gaps.min_by(|a, b| a.1.total_cmp(&b.1))
}

fn linear(simulation: &Simulation, trial: &Trial) -> Finding {
    let free = loose(simulation, trial.to, &contact_rows(simulation, trial.to));
    if !free.is_empty() {
        return free_mode(simulation, trial, &free, "is held by nothing");
    }
    let weak = loose(simulation, trial.to, &[]);
    if weak.is_empty() {
        return Finding::new(DoctorCause::LinearSolver, Severity::Warning, "")
            .advise("set `solver.method = \"sparse\"`");
    }
    let mut finding = Finding::new(
        DoctorCause::NearSingularOperator,
        Severity::Warning,
        "bodies are held by contact alone, and hardly by that",
    )
    .advise("support these motions, or hold them by weak springs (`[load.NAME] spring`)");
    for l in weak {
        let remark = format!("{} is held by contact alone", l.motion);
        finding = finding.blame(check::body(&simulation.model, &l.body, remark));
    }
    finding
}

fn not_converged(simulation: &Simulation, trial: &Trial, evidence: &[&Evidence]) -> Finding {
    let of = |cause, message: String| Finding::new(cause, Severity::Warning, message);
    let dynamic = simulation.model.steps[simulation.step].dynamic.is_some();
    if !dynamic {
        let free = loose(simulation, trial.to, &contact_rows(simulation, trial.to));
        if !free.is_empty()
            && let Some(finding) = balance::unbalanced(simulation, trial.to)
        {
            return finding;
        }
        if let Some(first) = free.first() {
            let mut finding = of(
                DoctorCause::SlidesAway,
                format!(
                    "body {} slides or tips off as a whole ({}): contact and friction do not balance the loads",
                    first.body, first.motion
                ),
            )
            .advise("no equilibrium exists: lower the load, raise friction or support the motion")
            .advise("make the step dynamic if the body is meant to take off");
            for l in &free {
                let remark = format!("{} is not resisted any more", l.motion);
                finding = finding.blame(check::body(&simulation.model, &l.body, remark));
            }
            return finding;
        }
    }
    if let Some((mu, limit, e)) = beyond_coupling(simulation, evidence) {
        return of(
            DoctorCause::CoulombNonUniqueness,
            format!(
                "the coefficient of friction, {mu:.3}, is above the coupling limit {limit:.3} of interface {}: there may be several \
                 solutions, or none",
                e.interface
            ),
        )
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
    let prescribed = match told {
        true => None,
        false => prescribed_slip(simulation, trial),
    };
    let prescribed = prescribed.map(|(slip, interface)| too_large_slip(slip, &interface));
    prescribed
        .or(signs)
        .unwrap_or_else(|| of(DoctorCause::NotConverged, String::new()))
}

/// What the guilty points show by themselves, the rarest sign first.
fn signs(evidence: &[&Evidence]) -> Option<Finding> {
    let worst = |measure: &dyn Fn(&Evidence) -> f64| {
        let all = evidence.iter().map(|e| (measure(e), *e));
        all.max_by(|a, b| a.0.total_cmp(&b.0))
    };
    let of = |cause, message: String| Finding::new(cause, Severity::Warning, message);
    if let Some((kink, e)) = worst(&|e| e.kink).filter(|w| w.0 > 1.0) {
        let finding = of(
            DoctorCause::LawTangentJump,
            format!(
                "the normal law of interface {} has a kink where points are: its slope changes by a factor {kink:.1}",
                e.interface
            ),
        );
        return Some(
            finding.advise("smooth the table of the law by more rows, or take smaller increments"),
        );
    }
    if let Some((left, e)) = worst(&|e| e.left as f64).filter(|w| w.0 >= LEFT) {
        let finding = of(
            DoctorCause::LostProjection,
            format!(
                "points of interface {} leave the outer edge of the primary and come back, up to {left} times",
                e.interface
            ),
        );
        return Some(
            finding
                .advise("let the primary surface reach farther than the secondary, or swap the two sides")
                .advise("smaller increments"),
        );
    }
    let slid = |e: &Evidence| match e.facet > 0.0 {
        true => e.slip / e.facet,
        false => 0.0,
    };
    if let Some((slip, e)) = worst(&slid).filter(|w| w.0 > FAR) {
        return Some(too_large_slip(slip, &e.interface));
    }
    let (flips, e) = worst(&|e| e.flips as f64).filter(|w| w.0 >= CHATTER)?;
    let finding = of(
        DoctorCause::Chatter,
        format!(
            "points of interface {} go to and fro, the worst with {flips} changes of status ({})",
            e.interface,
            e.course.join(" → ")
        ),
    );
    Some(
        finding
            .advise("smaller increments")
            .advise("a finer mesh at these points, or a compliant normal law"),
    )
}

fn too_large_slip(slip: f64, interface: &str) -> Finding {
    Finding::new(
        DoctorCause::TooLargeSlip,
        Severity::Warning,
        format!("points of interface {interface} slide over {slip:.2} facets in one increment"),
    )
    .blame(Guilty::interface(interface, format!("{slip:.2} facets")))
    .advise(format!(
        "increments that are {} times smaller, so that a point slides over half a facet at most",
        (2.0 * slip).ceil()
    ))
}

/// The largest slip that supports prescribe over the increment, in facets, and its interface; `None` where it is small.
fn prescribed_slip(simulation: &Simulation, trial: &Trial) -> Option<(f64, String)> {
    let model = &simulation.model;
    let constraints = simulation.constraints(trial.to);
    let before = simulation.constraints(trial.from);
    let moved = |local: usize, interface: &Interface| -> Option<Vec3> {
        let point = interface.nodes[local];
        let body = model.bodies.iter().find(|b| b.points.contains(&point))?;
        // The mean over the supported points of its body.
        let mut sum = [0.0; 3];
        for (c, sum) in sum.iter_mut().enumerate().take(model.dofs.dim) {
            let dofs = body.points.clone().map(|p| model.dofs.of(p, c));
            let fixed = dofs.filter(|&d| constraints.fixed[d] && before.fixed[d]);
            let changes: Vec<f64> = fixed
                .map(|d| constraints.values[d] - before.values[d])
                .collect();
            *sum = changes.iter().sum::<f64>() / changes.len().max(1) as f64;
        }
        Some(sum)
    };
    let slips = model.interfaces.iter().filter_map(|interface| {
        let Primary::Facets(facets) = &interface.primary else {
            return None;
        };
        let (point, facet) = (interface.points.first()?, facets.first()?);
        let ours = moved(*point.nodes.first()?, interface)?;
        let theirs = moved(*facet.nodes.first()?, interface)?;
        let slip = sub(ours, theirs);
        let along = add_scaled(slip, -dot(slip, point.normal), point.normal);
        let size = super::surfaces::spacing(interface, facet);
        Some((norm(along) / size, interface.name.clone()))
    });
    let largest = slips.max_by(|a, b| a.0.total_cmp(&b.0));
    largest.filter(|s| s.0 > FAR)
}

/// The first guilty point at which friction is above the coupling limit: coefficient, limit, point.
fn beyond_coupling<'a>(
    simulation: &Simulation,
    evidence: &[&'a Evidence],
) -> Option<(f64, f64, &'a Evidence)> {
    let found = evidence.iter().take(LOOKED_AT).filter_map(|e| {
        let interfaces = &simulation.model.interfaces;
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
        let limit = coupling::limit(simulation, point, normal)?;
        (mu >= limit).then_some((mu, limit, *e))
    });
    found.min_by(|a, b| (a.1).total_cmp(&b.1))
}

/// The coefficient of friction of an interface at rest, under a pressure that strains the cells beneath by a thousandth; `None` where the limit
/// does not depend on pressure.
pub(super) fn friction_coefficient(interface: &Interface) -> Option<f64> {
    let law = interface.laws.friction.as_dyn();
    if !law.frictional() || law.needs_penetration() {
        return None;
    }
    let point = interface.points.first()?;
    let pressure = 1e-3 * point.stiffness * point.size;
    let limit = law.limit(&FrictionPoint {
        pressure,
        penetration: 0.0,
        speed: 0.0,
        sticking: true,
    });
    (pressure > 0.0).then(|| limit.value / pressure)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_points_tell_what_went_wrong() {
        let quiet = Evidence {
            interface: "base".into(),
            facet: 1e-3,
            kink: 1.0,
            ..Evidence::default()
        };
        let cause = |e: Evidence| signs(&[&quiet, &e]).map(|f| (f.cause, f.message));
        assert_eq!(cause(quiet.clone()), None);
        let flips = Evidence {
            flips: 7,
            course: vec!["open", "stick", "open", "stick"],
            ..quiet.clone()
        };
        let (found, message) = cause(flips.clone()).expect("a sign");
        assert_eq!(found, DoctorCause::Chatter);
        assert!(
            message.contains("7 changes of status (open → stick → open → stick)"),
            "{message}"
        );
        let slid = Evidence {
            slip: 2.5e-3,
            ..flips.clone()
        };
        assert_eq!(cause(slid).expect("a sign").0, DoctorCause::TooLargeSlip);
        let lost = Evidence {
            left: 2,
            ..flips.clone()
        };
        assert_eq!(cause(lost).expect("a sign").0, DoctorCause::LostProjection);
        let kinked = Evidence {
            kink: 50.0,
            ..flips
        };
        assert_eq!(
            cause(kinked).expect("a sign").0,
            DoctorCause::LawTangentJump
        );
    }
}
