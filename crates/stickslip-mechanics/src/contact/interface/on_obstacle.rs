//! A contact point over an obstacle.

use super::clamped::clamped_pair;
use super::definition::InterfaceDefinition;
use super::evaluation::{Batch, Evaluation};
use super::finish::finish;
use super::initial::TOUCHING;
use super::respond::respond;
use super::scene::{Met, Scene};
use crate::contact::kinematics::{
    ObstaclePair, Part, RigidFoot, add_average_hessian, add_rigid_hessian, arriving_slip, average,
    rigid_stencil, rotation_of,
};
use crate::contact::obstacle::Shape;
use crate::contact::response::Status;
use crate::math::norm;

pub(super) fn evaluate_rigid(
    i: usize,
    shape: &dyn Shape,
    scene: &Scene,
    batch: &mut Batch,
) -> Evaluation {
    let interface = scene.interface;
    let Some((pose, pose_before)) = scene.poses else {
        return Evaluation::open(f64::INFINITY);
    };
    let (point, dim, nodes) = (&interface.points[i], interface.dofs.dim, &scene.geometry.x);
    let (x, before) = (
        point.position(nodes),
        point.position(&scene.geometry.before),
    );
    let over = ObstaclePair {
        pose,
        pose_before,
        x,
        x_before: before,
    };
    let belt = scene.belt_seen();
    let Some(feet) = rigid_stencil(shape, over, point, belt, dim, &mut batch.stencil) else {
        return Evaluation::open(f64::INFINITY);
    };
    if arrives(i, &feet, scene) {
        let own = rotation_of(
            skin_around(interface.definition, i),
            nodes,
            &scene.geometry.before,
            dim,
        );
        arriving_slip(over, point, &own, &feet, belt, dim, &mut batch.stencil);
    }
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
    batch.sides.extend(interface.own_weights(i));
    if clamped_pair(&interface, &batch.sides[met.sides..], batch.stencil.normal) {
        batch.sides.truncate(met.sides);
        return Evaluation::open(f64::INFINITY);
    }
    let mut e = respond(met, scene, batch);
    if let Some(weights) = finish(scene, &mut e, batch) {
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

/// Whether a point of a body that turns was away when a quasi-static increment began and is near the obstacle now. In motion friction sees velocities, and where faces hardly turn its foot
/// goes the way of the surface.
fn arrives(i: usize, feet: &RigidFoot, scene: &Scene) -> bool {
    let interface = scene.interface;
    let size = interface.points[i].size;
    let near = feet.foot.gap <= size && feet.gap_before > TOUCHING * size;
    let away = interface.state.points[i].status == Status::Open && !interface.laws.tied;
    let told = interface.turns && skin_around(interface.definition, i).next().is_some();
    told && near && away && scene.rate.is_none() && interface.laws.friction_law().frictional()
}

/// The corners of the faces around a point that are no mortar's.
fn skin_around(
    definition: &InterfaceDefinition,
    i: usize,
) -> impl Iterator<Item = Part<'_>> + Clone {
    let around = definition
        .skin
        .iter()
        .filter(move |s| s.points.contains(&i));
    around.map(|s| (&s.facet.nodes[..s.facet.kind.corner_count()], 1.0))
}
