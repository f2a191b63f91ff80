//! Slip as friction sees it in motion: velocity at the end of an increment times its length.

use super::stencil::Stencil;
use crate::math::Vec3;
use crate::system::Rate;

/// Where nodes are and were, and how their velocities follow from that.
#[derive(Debug, Clone, Copy)]
pub struct Moving<'a> {
    /// Coordinates at the evaluation, by node.
    pub x: &'a [Vec3],
    /// At the last accepted state.
    pub before: &'a [Vec3],
    /// How the velocities at the end follow from the displacements.
    pub rate: Rate<'a>,
    /// 2 or 3.
    pub dim: usize,
}

/// The slip as friction sees it, `dt v` along the frame, and its gradients: `s + Σ row ((gain - 1) Δu + shift)`. `nodes` are those of the stencil, with their
/// `dofs`.
pub fn rate_slip<'a>(
    stencil: &Stencil,
    nodes: impl Iterator<Item = &'a usize>,
    dofs: &[usize],
    moving: &Moving,
    rows: &mut [Vec<f64>; 2],
) -> [f64; 2] {
    let rate = moving.rate;
    let mut slip = stencil.slip;
    let mut k = 0;
    for &node in nodes {
        let (x, before) = (moving.x[node], moving.before[node]);
        for (x, before) in x.iter().zip(before).take(moving.dim) {
            let dof = dofs[k];
            for i in 0..2 {
                let r = stencil.rows[i + 1][k];
                slip[i] += r * ((rate.gain[dof] - 1.0) * (x - before) + rate.shift[dof]);
                let own = stencil.slip_rows[i].get(k).copied().unwrap_or(r);
                rows[i].push(own + r * (rate.gain[dof] - 1.0));
            }
            k += 1;
        }
    }
    slip
}
