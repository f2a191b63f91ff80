//! Where supports carry a body that contact has to hold in its other motions.

use super::solver::Solver;
use crate::math::Vec3;
use crate::model::definition::Model;
use crate::model::frame::Frame;
use crate::model::rigid::modes::together;
use crate::model::rigid::nearest::nearest_motion;
use crate::system::Constraints;
use crate::time::Trial;

/// Lets anchors begin where supports carry bodies in the increment. Anchors that stayed behind would hold a body back that slides under a drive: it would
/// tip about the support, and leave the surface that it slides on.
pub fn carry_anchors(
    solver: &mut Solver,
    model: &Model,
    frame: &Frame,
    to: &Constraints,
    trial: Trial,
) {
    let floating = &mut solver.floating;
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
    for (k, free) in floating.bodies.free.iter().enumerate() {
        let carried = carried(model, &free.bodies, &prescribed, change);
        let ahead = |p: usize| match &carried {
            Some(u) => model.dofs.vector(u, p),
            None => Vec3::default(),
        };
        anchors.begin_ahead(k, ahead);
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
    let motions = modes.into_iter().map(|mode| mode.vector);
    let total = nearest_motion(motions, over, |v| over(&left, v), left.len());
    total.iter().any(|u| *u != 0.0).then_some(total)
}
