//! Wear that is explicit is stable below a length of increments only.

use super::super::cause::DoctorCause;
use super::super::finding::{Finding, Guilty, Severity};
use super::super::friction::friction_coefficient;
use crate::assess::view::View;
use crate::contact::interface::{Interface, Primary};
use crate::contact::law::wear::Feedback;
use crate::model::cycling::Jump;
use crate::model::definition::Model;

/// The longest way `[m]` that an increment may slide, times the cycles that it stands for, where wear is explicit.
pub(crate) fn longest_way(model: &Model, interface: &Interface) -> Option<f64> {
    if interface.laws.feedback != Feedback::Explicit {
        return None;
    }
    let shear = friction_coefficient(interface).unwrap_or(0.0);
    interface.explicit_limit(modulus(model, interface)?, shear)
}

pub(super) fn check(view: &View, interface: &Interface) -> Option<Finding> {
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
                ", in step {step}, where each stands for {n} cycles, by {:.3e}",
                limit / n as f64
            )
        })
        .collect();
    Some(
        Finding::new(
            DoctorCause::ExplicitWear,
            Severity::Note,
            format!(
                "interface {name}: wear is explicit, and stable as long as no increment slides by more than about {limit:.3e}{}",
                jumps.concat()
            ),
        )
        .blame(Guilty::key(format!("interface.{name}.wear-feedback"), ""))
        .advise("`wear-feedback = \"implicit\"`, the default, has no such limit"),
    )
}

/// The plane modulus of both bodies together, of isotropic ones `E / (1 - ν²) = 4 G (M - G) / M` with the constrained modulus `M` and the shear modulus `G`.
fn modulus(model: &Model, interface: &Interface) -> Option<f64> {
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
