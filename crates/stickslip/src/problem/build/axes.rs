//! Friction that depends on the direction: whether its axes have a direction on the surfaces.

use super::super::{BodyRotation, Problem, key};
use super::fault::problem_error;
use super::turning::refused;
use crate::contact::interface::{InterfaceDefinition, Primary, changed};
use crate::error::{Diagnostic, Error};
use crate::model::Body;
use crate::model::capability::{Feature, Subject};
use crate::number::digits;

/// Refuses axes of friction that are normal to the surface, and those of surfaces that turn, of laws that come with a step too.
pub(super) fn check(
    problem: &Problem,
    bodies: &[Body],
    interfaces: &[InterfaceDefinition],
) -> Result<(), Error> {
    for interface in interfaces {
        let key = format!("interface.{}", interface.name);
        check_law(problem, bodies, interface, key)?;
        for (i, step) in problem.step.iter().enumerate() {
            let change = step.change.get(&interface.name);
            if let Some(change) = change.filter(|c| c.friction.is_some()) {
                let key = format!("step.{}.change.{}", key::entry(i), interface.name);
                check_law(problem, bodies, &changed(interface, change), key)?;
            }
        }
    }
    Ok(())
}

/// The same of one law of an interface, which the table `table` has.
fn check_law(
    problem: &Problem,
    bodies: &[Body],
    interface: &InterfaceDefinition,
    table: String,
) -> Result<(), Error> {
    let Some(orthotropy) = interface.laws.friction_law().orthotropy() else {
        return Ok(());
    };
    let key = table + ".friction.orthotropic";
    let without = interface.points.iter().filter(|p| {
        let place = interface.place(p);
        orthotropy.axis(place, p.normal).is_none()
    });
    let places: Vec<_> = without.map(|p| interface.place(p)).collect();
    if let Some(&[x, y, z]) = places.first() {
        let (count, all) = (places.len(), interface.points.len());
        let message = format!(
            "the axis of friction is normal to the surface at ({}, {}, {}), and at {count} of its {all} points in all: it has no direction there",
            digits(x, 5),
            digits(y, 5),
            digits(z, 5)
        );
        let help =
            "choose an `axis` along the surface, a centre between its points, or a smaller surface";
        return Err(problem_error(vec![
            Diagnostic::new(key, message).help(help),
        ]));
    }
    if let Primary::Rigid(_, motion) = &interface.primary
        && motion.rotation.is_some()
    {
        let message =
            "the obstacle turns, and the axes of friction on it keep their directions in space";
        let help =
            "move the obstacle without `rotation`, turn the body instead, or take friction.coulomb";
        return Err(problem_error(vec![
            Diagnostic::new(key, message).help(help),
        ]));
    }
    let named = match interface.exchanged {
        true => &interface.nodes[interface.primary_nodes..],
        false => &interface.nodes[..interface.primary_nodes],
    };
    let turns = bodies.iter().find(|b| {
        let turns = problem.body[&b.name].rotation != BodyRotation::Small;
        // Of two-sided contact the other half is the same surfaces in the other order.
        let said = problem.interface.contains_key(&interface.name);
        turns && said && named.iter().any(|n| b.points.contains(n))
    });
    if let Some(body) = turns {
        let whose = format!("body `{}`", body.name);
        return refused(key, &whose, Subject::Free, Feature::FrictionAxes);
    }
    Ok(())
}
