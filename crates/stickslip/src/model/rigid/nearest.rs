//! The motion without strain that comes nearest to what a body did.

use super::free_bodies::FreeBody;
use crate::math::{Vec3, norm};
use crate::system::Dofs;
use crate::tolerance::NEGLIGIBLE;

/// The combination of `motions`, by dof, that comes nearest to displacements in the scalar product `over`, which sums over the dofs that are known; earlier motions come
/// first. `along`: the scalar product of a motion with the displacements.
pub(crate) fn nearest_motion(
    motions: impl IntoIterator<Item = Vec<f64>>,
    over: impl Fn(&[f64], &[f64]) -> f64,
    along: impl Fn(&[f64]) -> f64,
    dofs: usize,
) -> Vec<f64> {
    let mut total = vec![0.0; dofs];
    let mut basis: Vec<Vec<f64>> = Vec::new();
    for mut motion in motions {
        motion.resize(dofs, 0.0);
        let whole = over(&motion, &motion).sqrt();
        // Twice, against rounding.
        for _ in 0..2 {
            for known in &basis {
                let s = over(&motion, known);
                motion.iter_mut().zip(known).for_each(|(v, q)| *v -= s * q);
            }
        }
        let size = over(&motion, &motion).sqrt();
        // Motions say the same if less is left of one after the others.
        if size <= NEGLIGIBLE * whole {
            continue;
        }
        motion.iter_mut().for_each(|v| *v /= size);
        let s = along(&motion);
        total.iter_mut().zip(&motion).for_each(|(t, v)| *t += s * v);
        basis.push(motion);
    }
    total
}

/// Adds to `u` the free motion of a body that comes nearest to what some of its points have `moved`; its largest displacement there.
pub(crate) fn rigid_part(
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn motions_are_fitted_in_their_order() {
        // Three points of one dof on a line: a shift, the same once more, and a stretch that is known at two of them.
        let motions = [vec![1.0; 3], vec![2.0; 3], vec![0.0, 1.0, 2.0]];
        let moved = [3.0, 5.0];
        let over = |a: &[f64], b: &[f64]| a[0] * b[0] + a[1] * b[1];
        let along = |a: &[f64]| a[0] * moved[0] + a[1] * moved[1];
        let found = nearest_motion(motions, over, along, 3);
        for (u, expected) in found.iter().zip([3.0, 5.0, 7.0]) {
            assert!((u - expected).abs() < 1e-12, "{found:?}");
        }
    }
}
