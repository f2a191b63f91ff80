//! Normal laws that are far softer or stiffer than the bodies, and functions that are no laws.

use super::super::finding::{DoctorCause, Finding};
use super::super::suspect::Suspect;
use super::common::{diameter, median};
use crate::contact::interface::InterfaceDefinition;
use crate::contact::law::friction::{FrictionLaw, FrictionPoint};
use crate::contact::law::normal::NormalLaw;
use crate::model::scene::Scene;
use crate::number::{digits, figure};
use crate::registry::Family;

/// Gaps and pressures at which functions are tried, relative to the height of the cells beneath and to their modulus.
const TRIED: [f64; 4] = [1e-6, 1e-5, 1e-4, 1e-3];

/// What is wrong with the laws of all interfaces.
pub(crate) fn check(scene: &Scene) -> Vec<Finding> {
    let model = scene.model;
    let bodies = model.elastic();
    let largest = bodies.fold(0.0_f64, |m, b| {
        m.max(diameter(&model.mesh.points[b.points.clone()]))
    });
    let elastic = scene.contact.interfaces.iter().filter(|i| !i.laws.tied);
    elastic
        .filter_map(|i| {
            let own = function(i);
            own.or_else(|| stiffness(i, largest))
        })
        .collect()
}

/// Median stiffness `[Pa/m]` and height `[m]` of the cells beneath.
fn beneath(interface: &InterfaceDefinition) -> Option<(f64, f64)> {
    let stiffness = median(interface.points.iter().map(|p| p.stiffness).collect());
    let size = median(interface.points.iter().map(|p| p.size).collect());
    (stiffness > 0.0 && size > 0.0 && stiffness.is_finite()).then_some((stiffness, size))
}

fn stiffness(interface: &InterfaceDefinition, largest: f64) -> Option<Finding> {
    let law = interface.laws.normal_law();
    law.pressure(0.0)?;
    if interface.laws.user.normal.is_some() {
        return None;
    }
    let (beneath, size) = beneath(interface)?;
    // Laws are compared at the pressure that strains the cells beneath by a thousandth.
    let pressure = 1e-3 * beneath * size;
    let at = law.gap(pressure);
    let (depth, stiffness) = (-at.value, -1.0 / at.slope);
    let name = &interface.name;
    let kind = interface.laws.normal.kind();
    let new = |message: String, remark: String| {
        DoctorCause::LawOutOfRange.warning(message)
            .blame(Suspect::interface(name, remark))
            .blame(Suspect::key(format!("interface.{name}.normal.{kind}"), ""))
            .advise("check the parameters and units of the normal law: they have to suit the moduli, in Pa and m or in MPa and mm")
    };
    // A law with a deeper penetration at that pressure, relative to the largest body, is far too soft.
    if depth > 10.0 * largest && largest > 0.0 {
        return Some(new(
            format!(
                "interface {name}: the normal law is far too soft: at a pressure that strains the bodies by a thousandth, {pressure}, surfaces penetrate by \
                 {depth}, {:.1} times the largest body",
                depth / largest,
                pressure = figure(pressure),
                depth = figure(depth)
            ),
            format!("penetration {}", figure(depth)),
        ));
    }
    let ratio = stiffness / beneath;
    // An infinite ratio included, not a NaN.
    // A law with 1e10 times the stiffness of the cells beneath is far too stiff: of the sixteen digits of a double six are left for the forces.
    (ratio > 1e10).then(|| {
        new(
            format!(
                "interface {name}: at a pressure of {pressure} the normal law is {ratio} times as stiff as the cells beneath: rounding errors exceed its \
                 penetration",
                ratio = digits(ratio, 2),
                pressure = figure(pressure),
            ),
            format!("stiffness {}", figure(stiffness)),
        )
        .advise("surfaces that do not penetrate are `normal.unilateral = {}`")
    })
}

/// Laws of the program, tried at a few places.
fn function(interface: &InterfaceDefinition) -> Option<Finding> {
    let (stiffness, size) = beneath(interface)?;
    let own = &interface.laws.user;
    let name = &interface.name;
    let new = |message: String, remark: String| {
        DoctorCause::FaultyLaw.warning(message)
            .blame(Suspect::interface(name, remark))
            .advise("a normal law gives pressures from gaps, positive and falling as the gap opens; a limit of friction is positive or zero")
    };
    if let Some(law) = &own.friction {
        for part in TRIED {
            let pressure = part * stiffness * size;
            let limit = law.limit(&FrictionPoint::at_rest(law, pressure));
            if limit.value.is_nan() || limit.value < 0.0 {
                return Some(new(
                    format!(
                        "interface {name}: the function of friction gives the limit {} at a pressure of {pressure}; a limit is not negative",
                        digits(limit.value, 5),
                        pressure = digits(pressure, 5)
                    ),
                    format!("limit {}", digits(limit.value, 5)),
                ));
            }
        }
    }
    let law = own.normal.as_ref()?;
    for part in TRIED {
        let pressure = |gap: f64| law.pressure(gap).map_or(f64::NAN, |s| s.value);
        let (inside, outside) = (pressure(-part * size), pressure(part * size));
        if inside.is_nan() || outside.is_nan() || inside < 0.0 || outside < 0.0 {
            return Some(new(
                format!(
                    "interface {name}: the function of pressure gives {inside} at a gap of {} and {outside} at {}; pressures are not negative",
                    digits(-part * size, 5),
                    digits(part * size, 5),
                    inside = digits(inside, 5),
                    outside = digits(outside, 5)
                ),
                "pressure that is none".into(),
            ));
        }
        if outside > inside {
            return Some(new(
                format!(
                    "interface {name}: the function of pressure grows with the gap, from {inside} at {} to {outside} at {}; gaps are positive \
                     where surfaces are apart",
                    digits(-part * size, 5),
                    digits(part * size, 5),
                    inside = digits(inside, 5),
                    outside = digits(outside, 5)
                ),
                "pressure that grows with the gap".into(),
            ));
        }
    }
    None
}
