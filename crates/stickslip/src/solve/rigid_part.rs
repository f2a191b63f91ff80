//! The motion without strain that is nearest to what points of a body did.

use crate::math::{Vec3, norm};
use crate::model::free_bodies::FreeBody;

/// Adds to `u` the free motion of a body that comes nearest to what some of its points have `moved`; its largest displacement there.
pub(super) fn rigid_part(
    free: &FreeBody,
    moved: &[(usize, Vec3)],
    dofs: crate::system::Dofs,
    u: &mut [f64],
) -> f64 {
    let mut basis: Vec<Vec<f64>> = Vec::new();
    let over = |a: &[f64], b: &dyn Fn(usize, usize) -> f64| -> f64 {
        let mut sum = 0.0;
        for (n, (p, _)) in moved.iter().enumerate() {
            for c in 0..dofs.dim {
                sum += a[dofs.of(*p, c)] * b(n, c);
            }
        }
        sum
    };
    // Orthonormal with regard to the anchored points.
    for (_, motion) in &free.motions {
        let mut v = motion.clone();
        for _ in 0..2 {
            for q in &basis {
                let s = over(&v, &|n, c| q[dofs.of(moved[n].0, c)]);
                v.iter_mut().zip(q).for_each(|(v, q)| *v -= s * q);
            }
        }
        let size = over(&v, &|n, c| v[dofs.of(moved[n].0, c)]).sqrt();
        if size > 1e-8 {
            v.iter_mut().for_each(|v| *v /= size);
            basis.push(v);
        }
    }
    let mut way: f64 = 0.0;
    let mut total = vec![0.0; u.len()];
    for q in &basis {
        let s = over(q, &|n, c| moved[n].1[c]);
        total.iter_mut().zip(q).for_each(|(t, q)| *t += s * q);
    }
    for (n, _) in moved.iter().enumerate() {
        way = way.max(norm(dofs.vector(&total, moved[n].0)));
    }
    u.iter_mut().zip(&total).for_each(|(u, t)| *u += t);
    way
}
