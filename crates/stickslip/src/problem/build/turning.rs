//! Bodies that turn by any angle: with reference points, freely, and rigid ones.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::super::{BodyRotation, Problem};
use super::fault::problem_error;
use super::references::Said;
use super::sets::Sets;
use crate::body::mass;
use crate::contact::interface::InterfaceDefinition;
use crate::error::{Diagnostic, Error};
use crate::math::identity;
use crate::mesh::Mesh;
use crate::model::capability::{Feature, Subject, limit};
use crate::model::{Body, ContactAt, Step};
use crate::system::{BodyFrame, BodyFrames, Carrier, Corotations, Dofs, Links};

/// The bodies that turn, with the reference points that carry their frames; rigid bodies that turn freely carry their own.
pub(super) fn frames(problem: &Problem, sets: &Sets, bodies: &[Body], links: &Links) -> BodyFrames {
    let turning = bodies.iter().filter_map(|body| {
        let rotation = &problem.body[&body.name].rotation;
        let link = match (rotation.reference(), body.rigid) {
            (Some(reference), _) => links.of_hidden(sets.reference(reference)?)?,
            (None, Some(rigid)) if !rotation.is_small() => rigid.link,
            (None, _) => return None,
        };
        let link = &links.all()[link];
        Some(BodyFrame {
            points: body.points.clone(),
            carrier: Carrier::Reference {
                hidden: link.hidden,
                centre: link.centre,
                length: link.length,
                base: identity(),
            },
            rigid: body.rigid.is_some(),
        })
    });
    BodyFrames::new(links.dofs(), turning.collect())
}

/// The elastic bodies that turn freely, with frames that fit the masses of their points.
pub(super) fn corotations(
    problem: &Problem,
    mesh: &Mesh,
    bodies: &[Body],
    dofs: Dofs,
) -> Corotations {
    let free =
        |b: &&Body| b.rigid.is_none() && problem.body[&b.name].rotation == BodyRotation::Large;
    let each = bodies.iter().filter(free).map(|body| {
        let mut masses = vec![0.0; dofs.points];
        mass::add_lumped_mass(&body.elastic, &mut masses);
        let mut weights = masses[body.points.clone()].to_vec();
        // Without a density there is none, or what dividing by it makes.
        if !weights.iter().all(|w| *w > 0.0) {
            weights.fill(1.0);
        }
        (body.points.clone(), weights)
    });
    Corotations::new(dofs, &mesh.points, each.collect())
}

/// Tells the interfaces that bodies which turn take part in.
pub(super) fn attach(
    frames: &Arc<BodyFrames>,
    corotations: &Corotations,
    interfaces: &mut [InterfaceDefinition],
) -> Result<(), Error> {
    for interface in interfaces {
        let mut nodes = interface.nodes.iter();
        if nodes.all(|&n| frames.of_point(n).is_none() && corotations.of_point(n).is_none()) {
            continue;
        }
        if interface.kinematics.as_dyn().frozen() {
            let key = format!("interface.{}.kinematics", interface.name);
            return refused(
                key,
                "a body of this interface",
                Subject::Free,
                Feature::SmallSliding,
            );
        }
        // A plane in which supports hold points goes with them.
        for point in &mut interface.mesh_mut().points {
            point.across = Default::default();
        }
        interface.frames = Arc::clone(frames);
        interface.turns = true;
    }
    Ok(())
}

/// Refuses implicit motion in which ties hold rigid bodies that turn to elastic ones by the forces at the ends of increments. The arms of points of a rigid body are there,
/// those of the points of an elastic one half an increment behind, and a tie that is strained along the radius brakes both: a ring on a hub that was brought to 600 rad/s lost an eighth of its spin.
pub(super) fn refuse_ties(
    frames: &BodyFrames,
    corotations: &Corotations,
    interfaces: &[InterfaceDefinition],
    steps: &[Step],
) -> Result<(), Error> {
    let at_ends = |s: &&Step| {
        let implicit = s.dynamic.as_ref().filter(|_| !s.is_explicit());
        implicit.is_some_and(|d| d.contact_at == ContactAt::End)
    };
    let Some(step) = steps.iter().find(at_ends) else {
        return Ok(());
    };
    let rigid = |n: usize| frames.of_point(n).is_some_and(|f| frames.all()[f].rigid);
    let elastic = |n: usize| corotations.of_point(n).is_some();
    let braked = interfaces.iter().find(|i| {
        let nodes = || i.nodes.iter().copied();
        i.laws.tied && nodes().any(rigid) && nodes().any(elastic)
    });
    let Some(interface) = braked else {
        return Ok(());
    };
    let message = format!(
        "it ties a rigid body that turns to an elastic one, and by its forces at the ends of increments, as in step `{}`, such a tie brakes both",
        step.name
    );
    let finding = Diagnostic::new(format!("interface.{}.tied", interface.name), message)
        .help("let the step take them at its stage, by a scheme that damps a little: `dynamic = { scheme.generalised-alpha.rho = 0.8, contact-at = \"stage\" }`");
    Err(problem_error(vec![finding]))
}

/// Refuses what a body of that kind does not go with, as the table of capabilities has it.
pub(super) fn refused(
    key: String,
    whose: &str,
    subject: Subject,
    feature: Feature,
) -> Result<(), Error> {
    let Some(limit) = limit(subject, feature) else {
        return Ok(());
    };
    let finding = Diagnostic::new(key, format!("{whose} {}", limit.why)).help(limit.help);
    Err(problem_error(vec![finding]))
}

/// What bodies that turn cannot bear.
pub(super) fn refuse(problem: &Problem, said: &Said, free: &Corotations) -> Result<(), Error> {
    let frames = said.frames;
    if frames.is_empty() && free.is_empty() {
        return Ok(());
    }
    let dofs = frames.dofs();
    let of = |dof: usize| frames.of_point(dofs.locate(dof).0);
    let freely = |dof: usize| free.of_point(dofs.locate(dof).0).is_some();
    let rigid = |dof: usize| {
        let body = of(dof).map(|i| &frames.all()[i]);
        body.is_some_and(|frame| frame.rigid)
    };
    let spun = frames.spun();
    let turned = |dof: usize| {
        let point = dofs.locate(dof).0;
        spun.iter().any(|(hidden, _)| hidden + 1 == point)
    };
    let carried = |dof: usize| {
        let point = dofs.locate(dof).0;
        let mut bodies = said.bodies.iter().filter(|b| b.points.contains(&point));
        bodies.any(|b| problem.body[&b.name].rotation.reference().is_some())
    };
    for coupling in said.couplings {
        let mut rows = coupling.rows.iter().flat_map(|r| &r.dofs);
        if let Some(&dof) = rows.find(|&&dof| freely(dof) || rigid(dof) || turned(dof)) {
            let key = format!("coupling.{}", coupling.name);
            let subject = match carried(dof) {
                true => Subject::RigidAxle,
                false => Subject::Free,
            };
            return refused(key, "a body of this coupling", subject, Feature::Coupling);
        }
    }
    let springs = said.springs.iter().flat_map(|s| s.entries());
    if let Some(name) =
        (springs.map(|(dof, _)| *dof).find(|&dof| turned(dof))).and_then(|dof| said.named(dof))
    {
        let message = "a spring against rotation in space is on a point that carries a rigid body";
        let finding = Diagnostic::new(format!("reference.{name}"), message);
        return Err(problem_error(vec![
            finding.help("load it by a moment instead"),
        ]));
    }
    for support in said.supports {
        let held: BTreeSet<usize> = support.entries.iter().map(|e| e.dof).collect();
        let mut loose = held.iter().filter(|&&dof| freely(dof)).flat_map(|&dof| {
            let point = dofs.locate(dof).0;
            dofs.of(point, 0)..dofs.of(point + 1, 0)
        });
        if loose.any(|dof| !held.contains(&dof)) {
            let key = format!("support.{}", support.name);
            return refused(
                key,
                "a body of this support",
                Subject::Free,
                Feature::PartialSupport,
            );
        }
    }
    for coupling in said.couplings {
        for row in &coupling.rows {
            let mut bodies = row.dofs.iter().map(|&dof| of(dof));
            let first = bodies.next().flatten();
            if bodies.any(|body| body != first) {
                let key = format!("coupling.{}", coupling.name);
                return refused(
                    key,
                    "a body of this coupling",
                    Subject::Axle,
                    Feature::Coupling,
                );
            }
        }
    }
    for (name, load) in &problem.load {
        let springs = load.kind.as_dyn().region() == crate::body::loads::Region::Points
            && matches!(load.kind, crate::body::loads::LoadKind::Spring(_));
        let own = springs
            && said.bodies.iter().any(|b| {
                let rotation = &problem.body[&b.name].rotation;
                let whole = !rotation.is_small() && *rotation != BodyRotation::Corotational;
                whole && (load.set == b.name || load.set.split('.').next() == Some(&b.name))
            });
        if own {
            let key = format!("load.{name}.set");
            return refused(
                key,
                "a body of this load",
                Subject::Axle,
                Feature::GroundSpring,
            );
        }
    }
    Ok(())
}
