//! Wear that is faster than any, and wear that is explicit, which is stable below a length of increments only.

use super::super::finding::{DoctorCause, Finding};
use super::super::friction::friction_coefficient;
use super::super::suspect::Suspect;
use super::common::{roles, sides};
use crate::assess::view::View;
use crate::contact::interface::{InterfaceDefinition, Primary};
use crate::contact::law::wear::Feedback;
use crate::contact::look;
use crate::model::cycling::Jump;
use crate::model::definition::Model;
use crate::model::scene::Scene;
use crate::number::figure;
use crate::registry::Family;

/// Modulus over hardness of the softest metals: lead, tin and annealed aluminium have 400 to 1000, steels 50 to 200, polymers and ceramics 10 to 40.
const SOFTEST_METAL: f64 = 1e3;

/// Rates of wear that are those of no surface. Archard's `K = k H` is the part of its contacts in which a surface loses a particle of the size of the contact
/// ([Archard 1953](crate::references::archard_1953)), and no part is above one: a rate `k` is below `1 / H`, and that below `1000 / E`.
pub(crate) fn fast(scene: &Scene) -> Vec<Finding> {
    let interfaces = scene.contact.interfaces.iter();
    interfaces
        .filter_map(|i| too_fast(scene.model, i))
        .collect()
}

fn too_fast(model: &Model, interface: &InterfaceDefinition) -> Option<Finding> {
    let shear = friction_coefficient(interface).unwrap_or(1.0);
    let rates = interface.laws.wear.as_dyn().fastest();
    let [own, other] = sides(model, interface);
    let [ours, theirs] = roles(interface);
    let worn = [(rates[0], own, ours), (rates[1], other, theirs)];
    worn.into_iter().find_map(|(rate, body, side)| {
        let name = body?;
        let body = model.bodies.iter().find(|b| b.name == name)?;
        let c = body.elastic.parts().first()?.stiffness;
        let (m, g) = (c[0][0], c[3][3]);
        let young = g * (3.0 * m - 4.0 * g) / (m - g);
        let rate = rate.per_path(shear);
        let part = rate * young / SOFTEST_METAL;
        (part > 1.0 && part.is_finite()).then(|| {
            let kind = interface.laws.wear.kind();
            DoctorCause::LawOutOfRange.warning(format!(
                "interface {}: its {side}, body {name}, wears by {rate} of depth over pressure and path. Times its hardness that is Archard's dimensionless coefficient, which is a probability: with a modulus of {young} the rate of no surface is above {}",
                interface.name,
                figure(SOFTEST_METAL / young), rate = figure(rate), young = figure(young)))
            .blame(Suspect::key(format!("interface.{}.wear.{kind}", interface.name), figure(rate)))
            .blame(super::super::places::body(model, &name, format!("modulus {}", figure(young))))
            .advise("a coefficient without unit, 1e-7 to 1e-2, is that of `wear.archard-hardness`, with the hardness beside it; that of `wear.archard` is divided by the hardness: 1e-17 to 1e-12 per pascal for metals")
            .advise("mm³/(N m), as tables have it, is 1e-9 per pascal, and 1e-3 per megapascal")
        })
    })
}

/// The longest way `[m]` that an increment may slide, times the cycles that it stands for, where wear is explicit.
pub(crate) fn longest_way(model: &Model, interface: &InterfaceDefinition) -> Option<f64> {
    if interface.laws.feedback != Feedback::Explicit {
        return None;
    }
    let shear = friction_coefficient(interface).unwrap_or(0.0);
    look::explicit_limit(interface, modulus(model, interface)?, shear)
}

pub(super) fn check(view: &View, interface: &InterfaceDefinition) -> Option<Finding> {
    let limit = longest_way(view.model, interface)?;
    let name = &interface.name;
    let jumps = view
        .model
        .steps
        .iter()
        .filter_map(|s| match s.cycles?.jump {
            Jump::Fixed(jump) if jump > 1 => Some((&s.name, jump)),
            _ => None,
        });
    let jumps: Vec<String> = jumps
        .map(|(step, n)| {
            format!(
                ", in step {step}, where each stands for {n} cycles, by {}",
                figure(limit / n as f64)
            )
        })
        .collect();
    Some(
        DoctorCause::ExplicitWear.note(format!(
            "interface {name}: wear is explicit, and stable as long as no increment slides by more than about {limit}{}",
            jumps.concat(),
            limit = figure(limit),
        ))
        .blame(Suspect::key(format!("interface.{name}.wear-feedback"), ""))
        .advise("`wear-feedback = \"implicit\"`, the default, has no such limit"),
    )
}

/// The plane modulus of both bodies together, of isotropic ones `E / (1 - ν²) = 4 G (M - G) / M` with the constrained modulus `M` and the shear modulus `G`.
fn modulus(model: &Model, interface: &InterfaceDefinition) -> Option<f64> {
    let of = |node: Option<&usize>| -> Option<f64> {
        let mut bodies = model.elastic();
        let body = bodies.find(|b| node.is_some_and(|n| b.points.contains(n)))?;
        let c = body.elastic.parts().first()?.stiffness;
        let (m, g) = (c[0][0], c[3][3]);
        Some(4.0 * g * (m - g) / m)
    };
    let (theirs, own) = interface.nodes.split_at(interface.primary_nodes);
    let own = of(own.first());
    let theirs = match interface.primary {
        Primary::Rigid(..) => None,
        Primary::Facets(_) => of(theirs.first()),
    };
    let soft: f64 = [own, theirs].into_iter().flatten().map(f64::recip).sum();
    (soft > 0.0).then(|| 1.0 / soft)
}
