//! A contact point of a mortar.

use super::clamped::clamped_pair;
use super::definition::Primary;
use super::evaluation::{Batch, Evaluation};
use super::faces::holds_integrals;
use super::finish::finish;
use super::respond::respond;
use super::scene::{Met, Scene};
use super::sides::faces_around;
use crate::contact::kinematics::{Carried, MeanPoint, gather, rotation_of};
use crate::math::{Mat3, identity, norm};
use crate::tolerance::NEGLIGIBLE;

pub(super) fn evaluate_mortar(i: usize, scene: &Scene, batch: &mut Batch) -> Evaluation {
    let interface = scene.interface;
    let geometry = scene.geometry;
    let (Some(mortar), false) = (&interface.mortar, geometry.integrals.is_empty()) else {
        return Evaluation::open(f64::INFINITY);
    };
    let point = &interface.points[i];
    let sides = batch.sides.len();
    let sums = gather(
        mortar,
        &geometry.integrals,
        i,
        &point.nodes,
        point.across,
        &mut batch.sides,
        &mut batch.sums,
    );
    // A point takes part if more than this part of its area has something opposite.
    let covered = sums.area > NEGLIGIBLE * point.area;
    let Some(length) = covered.then(|| sums.length()).flatten() else {
        batch.sides.truncate(sides);
        return Evaluation::open(f64::INFINITY);
    };
    if clamped_pair(&interface, &batch.sides[sides..], sums.normal) {
        batch.sides.truncate(sides);
        return Evaluation::open(f64::INFINITY);
    }
    let carried = || Carried {
        turns: turned(i, scene),
        normal: interface.state.points[i].normal,
    };
    let mean = MeanPoint {
        dim: interface.dofs.dim,
        x: &geometry.x,
        before: &geometry.before,
        reference: &interface.reference,
        origin: norm(interface.origin),
        carried: (!interface.kinematics.as_dyn().frozen()).then(carried),
        held: holds_integrals(&interface),
        across: point.across,
        before_first_contact: interface.attempt.before_first_contact,
    };
    mean.stencil(
        &sums,
        length,
        &mut batch.sides,
        sides,
        &mut batch.sums,
        &mut batch.stencil,
    );
    let area = interface.share * sums.area;
    let mut e = respond(Met { i, area, sides }, scene, batch);
    finish(scene, &mut e, batch);
    e
}

/// How the surfaces have turned since the last accepted state: the faces around a point of a mortar, and what lies opposite.
fn turned(i: usize, scene: &Scene) -> [Mat3; 2] {
    let interface = scene.interface;
    let (Some(mortar), Primary::Facets(facets)) = (&interface.mortar, &interface.primary) else {
        return [identity(), identity()];
    };
    let geometry = scene.geometry;
    let (x, before) = (geometry.x.as_slice(), geometry.before.as_slice());
    let around = mortar.around[i].iter().map(|&(f, _)| f);
    let other = around
        .flat_map(|f| &geometry.integrals[f].pieces)
        .map(|piece| {
            let facet = &facets[piece.facet];
            (&facet.nodes[..facet.kind.corner_count()], piece.area)
        });
    let dim = interface.dofs.dim;
    [
        rotation_of(faces_around(interface.definition, i), x, before, dim),
        rotation_of(other, x, before, dim),
    ]
}
