//! What is assembled in space, handed on to bodies in frames.

use std::collections::HashMap;
use std::sync::Arc;

use super::body_frames::{BodyFrames, Turned};
use super::frame_pose::FramePose;
use super::links::columns;
use super::{Assembler, ContactBlock};
use crate::math::{Vec3, larger};
use crate::system::links;

/// Frames at one state, and where the points of the bodies are in it: what is assembled in space is transformed by that.
#[derive(Debug, Clone, Default)]
pub struct InSpace {
    frames: Arc<BodyFrames>,
    poses: Vec<FramePose>,
    /// By point, of those that belong to a frame.
    places: HashMap<usize, (usize, Vec3)>,
}

impl InSpace {
    /// With poses and places of points counted from the same origin.
    pub fn new(
        frames: &Arc<BodyFrames>,
        poses: Vec<FramePose>,
        places: impl Iterator<Item = (usize, Vec3)>,
    ) -> Self {
        let places = places.filter_map(|(p, x)| Some((p, (frames.of_point(p)?, x))));
        InSpace {
            frames: Arc::clone(frames),
            places: places.collect(),
            poses,
        }
    }

    /// The frames.
    pub fn frames(&self) -> &BodyFrames {
        &self.frames
    }

    /// Whether nothing is seen from a frame.
    pub fn is_empty(&self) -> bool {
        self.places.is_empty()
    }

    fn row(&self, dof: usize) -> Option<Turned> {
        if self.places.is_empty() {
            return None;
        }
        let (point, _) = self.frames.dofs().locate(dof);
        let &(body, place) = self.places.get(&point)?;
        Some(self.frames.row(body, &self.poses[body], dof, place))
    }

    /// The dofs that move these, each once, and the row of each of these with positions among them; `None` if no frame has any of them.
    fn replace(&self, dofs: &[usize]) -> Option<(Vec<usize>, Vec<Turned>)> {
        let rows: Vec<Option<Turned>> = dofs.iter().map(|&dof| self.row(dof)).collect();
        if rows.iter().all(Option::is_none) {
            return None;
        }
        let mut new: Vec<usize> = Vec::with_capacity(2 * dofs.len());
        let both = dofs.iter().zip(rows);
        let rows = both.map(|(&dof, row)| {
            let mut own = [(dof, 0.0); 7];
            own[0].1 = 1.0;
            row.unwrap_or(own).map(|(dof, factor)| {
                let at = new.iter().position(|&d| d == dof).unwrap_or_else(|| {
                    new.push(dof);
                    new.len() - 1
                });
                (at, factor)
            })
        });
        let rows = rows.collect();
        Some((new, rows))
    }

    /// How far what is named by a dof moves in space when all dofs move by `du`.
    pub fn moved(&self, dof: usize, du: &[f64]) -> f64 {
        match self.row(dof) {
            Some(row) => row.iter().map(|&(d, factor)| factor * du[d]).sum(),
            None => du[dof],
        }
    }

    /// Adds to `out` what was assembled in space, and empties that.
    pub fn assemble(&self, spatial: &mut Assembler, out: &mut Assembler) {
        self.forces(&mut spatial.residual, &mut out.residual);
        self.forces(&mut spatial.condensed, &mut out.condensed);
        out.multiplier_residual = larger(out.multiplier_residual, spatial.multiplier_residual);
        out.rounding += spatial.rounding;
        out.pairs.append(&mut spatial.pairs);
        for dofs in spatial.couplings.drain(..) {
            let replaced = self.replace(&dofs);
            out.couplings.push(replaced.map_or(dofs, |(new, _)| new));
        }
        self.blocks(&mut spatial.blocks);
        out.blocks.append(&mut spatial.blocks);
    }

    /// Transforms blocks in space.
    pub fn blocks(&self, blocks: &mut [ContactBlock]) {
        for block in blocks {
            if let Some((dofs, rows)) = self.replace(&block.dofs) {
                *block = links::congruent_block(block, dofs, &rows);
            }
        }
    }

    /// Transforms gradients in space, rows over dofs.
    pub fn gradients(&self, dofs: &mut Vec<usize>, gradients: &mut Vec<f64>) {
        if let Some((new, rows)) = self.replace(dofs) {
            *gradients = columns(&rows, new.len(), gradients);
            *dofs = new;
        }
    }

    /// Adds forces in space by dof to those on bodies and frames, and empties them.
    fn forces(&self, spatial: &mut [f64], out: &mut [f64]) {
        for (dof, &force) in spatial.iter().enumerate() {
            if force == 0.0 {
                continue;
            }
            match self.row(dof) {
                None => out[dof] += force,
                Some(row) => row.iter().for_each(|&(d, factor)| out[d] += factor * force),
            }
        }
        spatial.fill(0.0);
    }
}
