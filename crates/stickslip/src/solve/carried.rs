//! Where supports carry a body that contact has to hold in its other motions.

use super::solver::Solver;
use crate::math::Vec3;
use crate::model::definition::Model;
use crate::model::frame::Frame;
use crate::model::free_bodies::together;
use crate::system::Constraints;
use crate::time::Trial;

/// What is left of a motion at prescribed displacements, relative to the motion, below which others before it say the same.
const SAME: f64 = 1e-6;

impl Solver {
    /// Lets anchors begin where supports carry bodies in the increment. Anchors that stayed behind would hold a body back that slides under a drive: it would
    /// tip about the support, and leave the surface that it slides on.
    pub fn carry_anchors(&mut self, model: &Model, frame: &Frame, to: &Constraints, trial: Trial) {
        let floating = &mut self.floating;
        let Some((_, bodies)) = &floating.known else {
            return;
        };
        let Some(anchors) = &mut floating.anchors else {
            return;
        };
        let from = frame.constraints(model, trial.from);
        let both = from.fixed.iter().zip(&to.fixed);
        let prescribed: Vec<usize> = both
            .enumerate()
            .filter(|(_, (before, now))| **before && **now)
            .map(|(dof, _)| dof)
            .collect();
        let change = |dof: usize| to.values[dof] - from.values[dof];
        for (k, free) in bodies.iter().enumerate() {
            let carried = carried(model, &free.bodies, &prescribed, change);
            let ahead = |p: usize| match &carried {
                Some(u) => model.dofs.vector(u, p),
                None => Vec3::default(),
            };
            anchors.begin_ahead(k, ahead);
        }
    }
}

/// The motion without strain of a body that comes nearest to what its prescribed displacements change by, by dof: translations before rotations, so that
/// nothing turns that need not. `None` where nothing is prescribed of the body or nothing changes.
fn carried(
    model: &Model,
    bodies: &[usize],
    prescribed: &[usize],
    change: impl Fn(usize) -> f64,
) -> Option<Vec<f64>> {
    let modes = together(model, bodies);
    let over = |a: &[f64], b: &[f64]| -> f64 { prescribed.iter().map(|&d| a[d] * b[d]).sum() };
    let mut left = vec![0.0; model.dofs.count()];
    prescribed.iter().for_each(|&dof| left[dof] = change(dof));
    let mut total = vec![0.0; left.len()];
    let mut basis: Vec<Vec<f64>> = Vec::new();
    for mode in modes {
        let mut v = mode.vector;
        v.resize(left.len(), 0.0);
        let whole = over(&v, &v).sqrt();
        for _ in 0..2 {
            for q in &basis {
                let s = over(&v, q);
                v.iter_mut().zip(q).for_each(|(v, q)| *v -= s * q);
            }
        }
        let size = over(&v, &v).sqrt();
        if size <= SAME * whole {
            continue;
        }
        v.iter_mut().for_each(|v| *v /= size);
        let s = over(&left, &v);
        total.iter_mut().zip(&v).for_each(|(t, v)| *t += s * v);
        basis.push(v);
    }
    total.iter().any(|u| *u != 0.0).then_some(total)
}
