//! A contact point of a mortar.

use super::clamped::clamped_pair;
use super::definition::Primary;
use super::evaluate::Met;
use super::evaluation::{Batch, Evaluation};
use super::parts::Interface;
use super::scene::Scene;
use crate::contact::kinematics::{Carried, MeanPoint, gather, rotation_of};
use crate::math::{Mat3, identity, norm};

/// Part of the area of a point that has to have something opposite for it to take part.
const LEAST_AREA: f64 = 1e-6;

impl Interface {
    pub(super) fn evaluate_mortar(&self, i: usize, scene: &Scene, batch: &mut Batch) -> Evaluation {
        let cache = scene.cache;
        let (Some(mortar), false) = (&self.mortar, cache.integrals.is_empty()) else {
            return Evaluation::open(f64::INFINITY);
        };
        let point = &self.points[i];
        let sides = batch.sides.len();
        let sums = gather(
            (mortar, &cache.integrals),
            (i, &point.nodes, point.across),
            &mut batch.sides,
            &mut batch.sums,
        );
        let covered = sums.area > LEAST_AREA * point.area;
        let Some(length) = covered.then(|| sums.length()).flatten() else {
            batch.sides.truncate(sides);
            return Evaluation::open(f64::INFINITY);
        };
        if clamped_pair(self, &batch.sides[sides..], sums.normal) {
            batch.sides.truncate(sides);
            return Evaluation::open(f64::INFINITY);
        }
        let carried = || Carried {
            turns: self.turned(i, scene),
            normal: self.history.points[i].normal,
        };
        let mean = MeanPoint {
            dim: self.dofs.dim,
            x: &cache.x,
            before: &cache.before,
            reference: &self.reference,
            origin: norm(self.origin),
            carried: (!self.kinematics.as_dyn().frozen()).then(carried),
            across: point.across,
            never_in_contact: self.attempt.never_in_contact,
        };
        mean.stencil(
            (&sums, length),
            (&mut batch.sides, sides),
            &mut batch.sums,
            &mut batch.stencil,
        );
        let area = self.share * sums.area;
        let mut e = self.respond(Met { i, area, sides }, scene, batch);
        self.finish(scene, &mut e, batch);
        e
    }

    /// How the surfaces have turned since the last accepted state: the faces around a point of a mortar, and what lies opposite.
    fn turned(&self, i: usize, scene: &Scene) -> [Mat3; 2] {
        let (Some(mortar), Primary::Facets(facets)) = (&self.mortar, &self.primary) else {
            return [identity(), identity()];
        };
        let cache = scene.cache;
        let at = (cache.x.as_slice(), cache.before.as_slice());
        let around = mortar.around[i].iter().map(|&(f, _)| f);
        let other = around
            .flat_map(|f| &cache.integrals[f].pieces)
            .map(|piece| {
                let facet = &facets[piece.facet];
                (&facet.nodes[..facet.kind.corner_count()], piece.area)
            });
        let dim = self.dofs.dim;
        [
            rotation_of(self.faces_around(i), at, dim),
            rotation_of(other, at, dim),
        ]
    }
}
