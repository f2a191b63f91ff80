//! Friction beyond what is plausible, beyond the limit of unique solutions, or without any pressure to feed it.

use super::super::coupling::local_limit;
use super::super::diagnose::friction_coefficient;
use super::super::finding::{DoctorCause, Finding, Guilty, Severity};
use super::{Measured, forced, median, secondary, travel};
use crate::contact::interface::{Interface, Primary};
use crate::contact::law::normal::NormalModel;
use crate::simulation::run::Simulation;

/// Coefficients of friction of dry surfaces end here.
const LARGE: f64 = 1.5;

/// Ratio of the slopes of neighbouring pieces of a tabulated law that is hard on the iteration.
const KINK: f64 = 300.0;

/// Part of a unit normal that counts as the direction of a component.
const ALONG: f64 = 0.1;

pub(super) fn check(
    simulation: &Simulation,
    interface: &Interface,
    measured: &Measured,
) -> Vec<Finding> {
    let mut out = Vec::new();
    let name = &interface.name;
    if let Some(mu) = friction_coefficient(interface) {
        let limit = coupling(simulation, interface, measured);
        if mu > LARGE {
            out.push(
                Finding::new(
                    DoctorCause::LargeFriction,
                    Severity::Warning,
                    format!("interface {name}: the coefficient of friction is {mu:.3}; dry surfaces rarely exceed 1"),
                )
                .blame(Guilty::interface(name, format!("friction {mu:.3}")))
                .blame(Guilty::key(format!("interface.{name}.friction"), ""))
                .advise("check the coefficient: above the coupling limit of the bodies there may be several solutions, or none"),
            );
        }
        if let Some((limit, i)) = limit.filter(|l| mu > l.0) {
            out.push(
                Finding::new(
                    DoctorCause::CoulombNonUniqueness,
                    Severity::Warning,
                    format!(
                        "interface {name}: the coefficient of friction, {mu:.3}, is above the coupling limit of most of its points, {limit:.3}: there \
                         may be several solutions, or none"
                    ),
                )
                .blame(Guilty::interface(name, format!("friction {mu:.3}")))
                .blame(secondary(interface, i, format!("k_t / |k_tn| = {limit:.3}")))
                .advise(format!("a coefficient of friction below {limit:.3}"))
                .advise("small increments, a regularised slip rule, or a dynamic step"),
            );
        }
        out.extend(without_pressure(simulation, interface, measured));
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
            .filter(|k| k.1 > KINK)
        {
            out.push(
                Finding::new(
                    DoctorCause::LawTangentJump,
                    Severity::Warning,
                    format!("interface {name}: the slope of the normal law changes by a factor {ratio:.0} at row {row} of its table"),
                )
                .blame(Guilty::interface(name, "normal law with a kink"))
                .blame(Guilty::key(
                    format!("interface.{name}.normal.tabular.table.{row}"),
                    format!("penetration {:.3e}", law.table[row][0]),
                ))
                .advise("check the units of this row, or smooth the table by more rows"),
            );
        }
    }
    out
}

/// The median of the coupling limit over the points that are nearest to contact, with all other points held, and the point with the smallest.
fn coupling(
    simulation: &Simulation,
    interface: &Interface,
    measured: &Measured,
) -> Option<(f64, usize)> {
    let mut limits: Vec<(usize, f64)> = Vec::new();
    for (i, beside) in measured.nearest.iter().enumerate() {
        let &[node] = interface.points[i].nodes.as_slice() else {
            continue;
        };
        let Some(beside) = beside else {
            continue;
        };
        let point = interface.nodes[node];
        if simulation.model.links.of_point(point).is_some() {
            continue;
        }
        if let Some(limit) = local_limit(simulation, point, beside.normal) {
            limits.push((i, limit));
        }
    }
    let (worst, _) = *limits.iter().min_by(|a, b| a.1.total_cmp(&b.1))?;
    Some((median(limits.iter().map(|l| l.1).collect()), worst))
}

/// Friction where nothing that is prescribed has a part along the normal.
fn without_pressure(
    simulation: &Simulation,
    interface: &Interface,
    measured: &Measured,
) -> Option<Finding> {
    let model = &simulation.model;
    let overlaps = measured.gaps.iter().zip(&interface.points);
    let overlaps = overlaps.into_iter().any(|(g, p)| *g < -1e-6 * p.size);
    let moves = matches!(&interface.primary, Primary::Rigid(_, motion) if motion.rotation.is_some()
        || !motion.translation.is_empty());
    if forced(model) || overlaps || moves || !model.initials.is_empty() || travel(model) == 0.0 {
        return None;
    }
    let mut along = [false; 3];
    for n in measured.nearest.iter().flatten() {
        for (along, c) in along.iter_mut().zip(n.normal) {
            *along |= c.abs() > ALONG;
        }
    }
    let pressed = model.supports.iter().any(|s| {
        let mut entries = s.entries.iter().filter(|e| !e.hold && e.value != 0.0);
        entries.any(|e| along[model.dofs.locate(e.dof).1])
    });
    (!pressed).then(|| {
        Finding::new(
            DoctorCause::FrictionWithoutPressure,
            Severity::Warning,
            format!(
                "interface {} has friction, but nothing presses it together: all that is prescribed moves along it",
                interface.name
            ),
        )
        .blame(Guilty::interface(&interface.name, "carries no pressure"))
        .advise("prescribe a displacement or a load along its normal, in the same step or one before")
    })
}
