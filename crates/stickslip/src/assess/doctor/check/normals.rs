//! Surfaces that do not face each other.

use super::super::finding::{DoctorCause, Finding};
use super::super::places::{body as whole, secondary};
use super::super::suspect::{LocationKind, Suspect};
use super::common::{roles, sides};
use super::measured::Measured;
use crate::assess::view::View;
use crate::contact::interface::{InterfaceDefinition, Primary};
use crate::contact::look::FACING_COSINE;
use crate::math::dot;
use crate::number::figure;

/// Part of the points of a body inside an obstacle from which the obstacle is inside out: where most of a body is, it
/// was meant to be. It decides what is said, and no result.
const INSIDE_OUT: f64 = 0.5;

pub(super) fn check(
    view: &View,
    interface: &InterfaceDefinition,
    measured: &Measured,
) -> Option<Finding> {
    let best = measured.nearest.iter().enumerate().filter_map(|(i, n)| {
        let n = n.as_ref()?;
        Some((i, dot(n.normal, interface.points[i].normal)))
    });
    let (i, cosine) = best.min_by(|a, b| a.1.total_cmp(&b.1))?;
    let [ours, theirs] = sides(view.model, interface);
    let ours = ours.unwrap_or_default();
    let [own, other] = roles(interface);
    let what = match &theirs {
        Some(body) => format!("the {other} on body {body}"),
        None => "the obstacle".to_string(),
    };
    if cosine > FACING_COSINE {
        let how = match cosine > -FACING_COSINE {
            true => "look the same way",
            false => "stand at right angles",
        };
        let remark = format!("cosine between the outward normals {cosine:.2}; -1 is face to face");
        let mut finding = DoctorCause::NormalsNotOpposed
            .warning(format!(
                "interface {}: the {own} on body {ours} and {what} {how}: they cannot touch",
                interface.name
            ))
            .blame(Suspect::interface(
                &interface.name,
                "its sides do not face each other",
            ))
            .blame(secondary(interface, i, remark));
        if let Primary::Facets(facets) = &interface.primary
            && let Some(facet) = facets.first()
        {
            let x = crate::contact::look::coordinates(interface, facet);
            finding = finding.blame(
                Suspect {
                    what: LocationKind::Facet,
                    name: theirs.clone().unwrap_or_default(),
                    id: Some(facet.cell),
                    body: theirs,
                    interface: Some(interface.name.clone()),
                    remark: format!("a facet of the {other}"),
                    ..Suspect::default()
                }
                .at(x[0]),
            );
        }
        return Some(finding.advise(match interface.rigid() {
            true => "turn the normal of the obstacle round, or name the surface that faces it",
            false => "name the surfaces that face each other; `stickslip check` lists the sets of each body",
        }));
    }
    through(view, interface, measured).or_else(|| inside_out(view, interface, &ours))
}

/// Two surfaces of one body with its material between them.
pub(super) fn through(
    view: &View,
    interface: &InterfaceDefinition,
    measured: &Measured,
) -> Option<Finding> {
    let [own, other] = sides(view.model, interface);
    if own.is_none() || own != other {
        return None;
    }
    let ours = own.unwrap_or_default();
    // Inside a body the other surface lies behind, by its thickness.
    let gaps = measured.gaps.iter().zip(&interface.points).enumerate();
    let behind = gaps.filter(|(_, (gap, point))| gap.is_finite() && **gap < -point.size);
    let behind: Vec<(usize, f64)> = behind.map(|(i, (gap, _))| (i, *gap)).collect();
    let (i, gap) = *behind.first()?;
    if behind.len() as f64 <= INSIDE_OUT * measured.gaps.len() as f64 {
        return None;
    }
    let name = &interface.name;
    Some(
        DoctorCause::NormalsNotOpposed.warning(format!(
            "interface {name}: secondary and primary are surfaces of one body, {ours}, which lies between them: {} points face away from the primary, {} behind them, so the surfaces cannot touch",
            behind.len(),
            figure(-gap)))
        .blame(Suspect::interface(name, "both sides on one body"))
        .blame(secondary(interface, i, format!("the other side is {} behind it, through the body", figure(-gap))))
        .advise("name the surface of the other body that this one meets; a body that meets itself needs two surfaces that face each other"),
    )
}

/// A body most of which lies within the obstacle it is meant to rest on.
fn inside_out(view: &View, interface: &InterfaceDefinition, ours: &str) -> Option<Finding> {
    let model = view.model;
    if !interface.rigid() {
        return None;
    }
    let body = model.bodies.iter().find(|b| b.name == ours)?;
    let mut opposite = crate::contact::look::Opposite::new(interface, view.frame.state.t);
    let points = &model.mesh.points[body.points.clone()];
    let inside = points.iter().filter(|x| {
        let nearest = opposite.nearest(**x);
        nearest.is_some_and(|n| n.gap < 0.0)
    });
    let share = inside.count() as f64 / points.len().max(1) as f64;
    (share > INSIDE_OUT).then(|| {
        DoctorCause::NormalsNotOpposed.warning(format!(
            "interface {}: {:.0} % of body {ours} lies inside the obstacle: its normal points the wrong way, or the body is on the wrong side",
            interface.name,
            100.0 * share
        ))
        .blame(Suspect::interface(&interface.name, "its obstacle is inside out"))
        .blame(whole(model, ours, "inside the obstacle"))
        .advise("turn the normal of the obstacle round (`inside` for a hole), or move the body to the other side")
    })
}
