//! How much of a motion of the whole a mode takes part in.

use super::linear::Linear;
use crate::body::Space;
use crate::math::vector::dot;
use crate::math::{Vec3, cross};
use crate::model::definition::Model;
use crate::system::Motion;

/// A rigid motion of everything, and what it is called.
pub(crate) struct Direction {
    pub name: &'static str,
    /// `M r`, over the unknowns.
    pub mass: Vec<f64>,
    /// `rᵀ M r`.
    pub total: f64,
}

const NAMES: [&str; 6] = ["x", "y", "z", "rotation-x", "rotation-y", "rotation-z"];

/// The rigid motions that the space has: translations, and rotations about the origin.
pub(crate) fn directions(model: &Model, linear: &Linear) -> Vec<Direction> {
    let dofs = model.dofs;
    let kinds: &[usize] = match (dofs.dim, matches!(model.space, Space::Axisymmetric)) {
        (2, true) => &[1],
        (2, false) => &[0, 1, 5],
        _ => &[0, 1, 2, 3, 4, 5],
    };
    let direction = |&kind: &usize| {
        let axis: Vec3 = std::array::from_fn(|i| if i == kind % 3 { 1.0 } else { 0.0 });
        let moved = |x: Vec3| if kind < 3 { axis } else { cross(axis, x) };
        let mut r = vec![0.0; dofs.count()];
        for (p, &x) in model.mesh.points.iter().enumerate() {
            for (i, v) in moved(x).iter().enumerate().take(dofs.dim) {
                r[dofs.of(p, i)] = *v;
            }
        }
        for link in model.links.all() {
            let at = moved(link.centre);
            for (dof, motion) in link.motions(dofs) {
                r[dof] = match motion {
                    Motion::Translation(i) => at[i],
                    Motion::Rotation(i) if kind >= 3 => axis[i] * link.length,
                    Motion::Rotation(_) => 0.0,
                };
            }
        }
        let mut mass = vec![0.0; r.len()];
        linear.masses().mul(&r, &mut mass);
        let total = dot(&r, &mass);
        linear.bound.gather(&mut mass);
        Direction {
            name: NAMES[kind],
            mass,
            total,
        }
    };
    kinds.iter().map(direction).collect()
}
