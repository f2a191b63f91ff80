//! Bodies of which some are linear in a frame that follows each of them.

use std::sync::Arc;

use crate::linear::Matrix;
use crate::math::vector::{dot, weighted_mean};
use crate::system::{BodyModel, Corotations, Deformed, Product};

/// `f = R Pᵀ K w` with the displacements `w` that frames leave, see [`Corotations`]; `f = K u` of what has no frame.
#[derive(Debug)]
pub struct CorotatedBodies {
    /// `K` along the axes of the frames `[N/m]`.
    pub stiffness: Arc<dyn Matrix>,
    /// The frames.
    pub frames: Arc<Corotations>,
}

impl BodyModel for CorotatedBodies {
    fn forces(&self, u: &[f64]) -> Vec<f64> {
        let mut forces = vec![0.0; u.len()];
        let stiffness = |w: &[f64], out: &mut [f64]| out.copy_from_slice(&self.stiffness.times(w));
        self.frames.forces(u, stiffness, &mut forces);
        forces
    }

    fn energy(&self, at: Deformed) -> f64 {
        let local = self.frames.local(&self.frames.turns(at.u), at.u);
        0.5 * dot(&local, &self.stiffness.times(&local))
    }

    /// What turns is in its frame *at the stage*, so that nothing acts on the spin, and strained by the mean of what it is strained by at both ends, so that a turn between
    /// strains nothing. The mean is one along the axes of the frames. Along those of space it would change with displacements just as a matrix that is seen from the frame
    /// of the stage; but then vibrations of a body that turns feed on the turn.
    fn stage_forces(&self, first: f64, [from, to]: [Deformed; 2]) -> Vec<f64> {
        let frames = &self.frames;
        let strained = |u: &[f64]| frames.local(&frames.turns(u), u);
        let mean = weighted_mean(first, &strained(from.u), &strained(to.u));
        let stage = weighted_mean(first, from.u, to.u);
        let mut forces = self.stiffness.times(&mean);
        frames.forces(&stage, |_, _| (), &mut forces);
        forces
    }

    /// A turn as a whole is not damped.
    fn damping(&self, matrix: &Product, u: &[f64], v: &[f64]) -> Vec<f64> {
        let mut forces = vec![0.0; u.len()];
        let matrix = |v: &[f64], out: &mut [f64]| out.copy_from_slice(&matrix(v));
        self.frames.damping(u, v, matrix, &mut forces);
        forces
    }
}
