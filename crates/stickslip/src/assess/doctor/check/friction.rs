//! Friction beyond what is plausible, beyond the limit of unique solutions, or without any pressure to feed it.

use super::super::coupling::local_limit;
use super::super::finding::{DoctorCause, Finding};
use super::super::friction::friction_coefficient;
use super::super::places::secondary;
use super::super::suspect::Suspect;
use super::common::{forced, median};
use super::driven;
use super::measured::Measured;
use crate::assess::view::View;
use crate::contact::interface::{InterfaceDefinition, Primary};
use crate::contact::law::normal::NormalModel;
use crate::math::{Vec3, dot, norm, sub};
use crate::model::definition::Step;
use crate::model::scene::Scene;
use crate::number::figure;
use crate::tolerance::NEGLIGIBLE;

pub(super) fn check(
    view: &View,
    interface: &InterfaceDefinition,
    measured: &Measured,
) -> Vec<Finding> {
    let mut out = Vec::new();
    let name = &interface.name;
    if let Some(mu) = friction_coefficient(interface) {
        let limit = coupling(view, interface, measured);
        // Coefficients of friction of dry surfaces end here.
        if mu > 1.5 {
            out.push(
                DoctorCause::LargeFriction.warning(format!("interface {name}: the coefficient of friction is {mu:.3}; dry surfaces rarely exceed 1"))
                    .blame(Suspect::interface(name, format!("friction {mu:.3}")))
                    .blame(Suspect::key(format!("interface.{name}.friction"), ""))
                    .advise("check the coefficient: above the coupling limit of the bodies there may be several solutions, or none"),
            );
        }
        if let Some((limit, i)) = limit.filter(|l| mu > l.0) {
            out.push(
                DoctorCause::CoulombNonUniqueness.warning(format!(
                    "interface {name}: the coefficient of friction, {mu:.3}, is above the coupling limit of most of its points, {limit:.3}: there \
                     may be several solutions, or none"
                ))
                .blame(Suspect::interface(name, format!("friction {mu:.3}")))
                .blame(secondary(interface, i, format!("k_t / |k_tn| = {limit:.3}")))
                .advise(format!("a coefficient of friction below {limit:.3}"))
                .advise("small increments, a regularised slip rule, or a dynamic step"),
            );
        }
    }
    if let NormalModel::Tabular(law) = &interface.laws.normal {
        let slopes: Vec<f64> = law
            .table
            .windows(2)
            .map(|w| (w[1][1] - w[0][1]) / (w[1][0] - w[0][0]))
            .collect();
        let kinks = slopes.windows(2).enumerate().map(|(i, s)| {
            let ratio = s[1] / s[0];
            (i + 1, ratio.max(1.0 / ratio))
        });
        if let Some((row, ratio)) = kinks
            .max_by(|a, b| a.1.total_cmp(&b.1))
            // A larger ratio of the slopes of neighbouring pieces of a tabulated law is hard on the iteration.
            .filter(|k| k.1 > 300.0)
        {
            out.push(
                DoctorCause::LawTangentJump.warning(format!("interface {name}: the slope of the normal law changes by a factor {ratio:.0} at row {row} of its table"))
                    .blame(Suspect::interface(name, "normal law with a kink"))
                    .blame(Suspect::key(
                        format!("interface.{name}.normal.tabular.table.{row}"),
                        format!("penetration {}", figure(law.table[row][0])),
                    ))
                    .advise("check the units of this row, or smooth the table by more rows"),
            );
        }
    }
    out
}

/// The median of the coupling limit over the points that are nearest to contact, with all other points held, and the point with the smallest.
fn coupling(
    view: &View,
    interface: &InterfaceDefinition,
    measured: &Measured,
) -> Option<(f64, usize)> {
    let mut limits: Vec<(usize, f64)> = Vec::new();
    for (i, beside) in measured.nearest.iter().enumerate() {
        let Some(node) = interface.points[i].node() else {
            continue;
        };
        let Some(beside) = beside else {
            continue;
        };
        let point = interface.nodes[node];
        if view.model.links.of_point(point).is_some() {
            continue;
        }
        if let Some(limit) = local_limit(view, point, beside.normal) {
            limits.push((i, limit));
        }
    }
    let (worst, _) = *limits.iter().min_by(|a, b| a.1.total_cmp(&b.1))?;
    Some((median(limits.iter().map(|l| l.1).collect()), worst))
}

/// Friction on an interface that slides while nothing has pressed it together, in the whole analysis or before a later step does.
pub(super) fn pressureless(
    view: &View,
    interface: &InterfaceDefinition,
    measured: &Measured,
) -> Option<Finding> {
    friction_coefficient(interface)?;
    let model = view.model;
    let closed = measured.gaps.iter().zip(&interface.points);
    let overlaps = closed.into_iter().any(|(g, p)| *g < -1e-6 * p.size);
    if forced(view) || overlaps || !model.actions.initials.is_empty() {
        return None;
    }
    let nearest = measured.gaps.iter().enumerate();
    let nearest = nearest.filter(|g| g.1.is_finite());
    let (i, _) = nearest.min_by(|a, b| a.1.total_cmp(b.1))?;
    let normals: Vec<Vec3> = measured
        .nearest
        .iter()
        .flatten()
        .map(|n| n.normal)
        .collect();
    let x = interface.points[i].position(&interface.reference);
    let mut slid: Option<&str> = None;
    for step in model
        .steps
        .iter()
        .filter(|s| interface.schedule.active(s.end))
    {
        let moved = moved(view, interface, x, step)?;
        let presses = |m: &Vec3| {
            normals
                .iter()
                .any(|n| dot(*m, *n).abs() > NEGLIGIBLE * norm(*m))
        };
        if moved.iter().any(presses) {
            return slid.map(|early| too_early(interface, early, &step.name));
        }
        let size = interface.points[i].size;
        if moved.iter().any(|m| norm(*m) > 1e-6 * size) {
            slid = slid.or(Some(&step.name));
        }
    }
    slid.map(|_| {
        DoctorCause::FrictionWithoutPressure.warning(format!(
            "interface {} has friction but no pressure: all prescribed motions are parallel to it",
            interface.name
        ))
        .blame(Suspect::interface(&interface.name, "carries no pressure"))
        .advise("prescribe a displacement or a load along its normal, in the same step or one before")
    })
}

/// Motions of the secondary relative to the primary that are prescribed within a step, both moved as wholes; `None` where it does not follow from
/// supports and obstacles: bodies that are strained between supports bulge, and loose ones are pressed by others.
fn moved(
    scene: &Scene,
    interface: &InterfaceDefinition,
    x: Vec3,
    step: &Step,
) -> Option<Vec<Vec3>> {
    let model = scene.model;
    let owners = driven::owners(model);
    let start = model.steps.first().map_or(0.0, |s| s.start);
    let mut times = vec![step.end];
    times.extend(
        step.milestones
            .iter()
            .filter(|t| **t > step.start && **t < step.end),
    );
    let mut out = Vec::new();
    for t in times {
        let prescribed = driven::prescribed(model, &owners, t);
        let mut sides = [[0.0; 3]; 2];
        for (moved, side) in sides.iter_mut().zip(driven::pair(model, interface)) {
            let Some(b) = side else {
                if let Primary::Rigid(_, motion) = &interface.primary {
                    let there = motion.pose(start).inward(x);
                    *moved = sub(motion.pose(t).outward(there), x);
                }
                continue;
            };
            for c in 0..model.dofs.dim {
                let component = prescribed[b][c];
                let pushed = component.count == 0 && driven::meets_others(scene, interface, b);
                if component.uneven || pushed {
                    return None;
                }
                moved[c] = component.mean;
            }
        }
        out.push(sub(sides[0], sides[1]));
    }
    Some(out)
}

fn too_early(interface: &InterfaceDefinition, early: &str, late: &str) -> Finding {
    let name = &interface.name;
    DoctorCause::FrictionWithoutPressure.warning(format!(
        "interface {name} slides in step {early}, but is pressed together only in step {late}: until then friction has no pressure and resists nothing"
    ))
    .blame(Suspect::interface(name, format!("carries no pressure in step {early}")))
    .blame(Suspect::key("step", format!("{early} before {late}")))
    .advise("press first, then slide: change the order of the steps, or their lists of supports")
}
