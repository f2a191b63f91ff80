//! The motion without strain that is nearest to what points of a body did.

use crate::math::{Vec3, norm};
use crate::model::rigid::free_bodies::FreeBody;
use crate::model::rigid::nearest::nearest_motion;
use crate::system::Dofs;

/// Adds to `u` the free motion of a body that comes nearest to what some of its points have `moved`; its largest displacement there.
pub(super) fn rigid_part(
    free: &FreeBody,
    moved: &[(usize, Vec3)],
    dofs: Dofs,
    u: &mut [f64],
) -> f64 {
    let known = || moved.iter().map(|(p, at)| (*p, *at));
    let over = |a: &[f64], b: &[f64]| -> f64 {
        let own = known().flat_map(|(p, _)| dofs.of(p, 0)..dofs.of(p + 1, 0));
        own.map(|dof| a[dof] * b[dof]).sum()
    };
    let along = |a: &[f64]| -> f64 {
        let own = known().flat_map(|(p, at)| (0..dofs.dim).map(move |c| (dofs.of(p, c), at[c])));
        own.map(|(dof, at)| a[dof] * at).sum()
    };
    let motions = free.motions.iter().map(|(_, motion)| motion.clone());
    let total = nearest_motion(motions, over, along, u.len());
    u.iter_mut().zip(&total).for_each(|(u, t)| *u += t);
    let ways = known().map(|(p, _)| norm(dofs.vector(&total, p)));
    ways.fold(0.0, f64::max)
}
