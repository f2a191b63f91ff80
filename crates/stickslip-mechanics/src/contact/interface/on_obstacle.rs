//! A contact point over an obstacle.

use super::definition::Interface;
use super::evaluate::Met;
use super::evaluation::{Batch, Evaluation};
use super::scene::Scene;
use crate::contact::kinematics::{add_average_hessian, add_rigid_hessian, average, rigid_stencil};
use crate::contact::obstacle::Shape;
use crate::math::norm;

impl Interface {
    pub(super) fn evaluate_rigid(
        &self,
        i: usize,
        shape: &dyn Shape,
        scene: &Scene,
        batch: &mut Batch,
    ) -> Evaluation {
        let Some((pose, pose_before)) = scene.poses else {
            return Evaluation::open(f64::INFINITY);
        };
        let (point, dim, nodes) = (&self.points[i], self.dofs.dim, &scene.cache.x);
        let (x, before) = (point.position(nodes), point.position(&scene.cache.before));
        let Some(feet) = rigid_stencil(
            shape,
            (pose, pose_before),
            point,
            (x, before),
            scene.belt_seen(),
            dim,
            &mut batch.stencil,
        ) else {
            return Evaluation::open(f64::INFINITY);
        };
        // One with several nodes has the mean of their gaps.
        let mean = point.nodes.len() > 1;
        if mean && average(shape, pose, point, nodes, dim, &mut batch.stencil).is_none() {
            return Evaluation::open(f64::INFINITY);
        }
        // A curved obstacle measures the gap from its centre.
        batch.stencil.coordinate_scale = norm(x) + 2.0 * shape.radius().abs();
        let met = Met {
            i,
            area: point.area,
            sides: batch.sides.len(),
        };
        batch.sides.extend(self.own_weights(i));
        let mut e = self.respond(met, scene, batch);
        if let Some(weights) = self.finish(scene, &mut e, batch) {
            let start = batch.hessian.len();
            batch.hessian.resize(start + e.slots.n * e.slots.n, 0.0);
            let out = &mut batch.hessian[start..];
            let [normal, t1, t2] = weights;
            let along = if mean { [0.0, t1, t2] } else { weights };
            let mut curved = add_rigid_hessian(pose, point, &feet, dim, along, out);
            curved |= mean && add_average_hessian(shape, pose, point, nodes, dim, normal, out);
            match curved {
                true => e.slots.hessian = Some(start),
                false => batch.hessian.truncate(start),
            }
        }
        e
    }
}
