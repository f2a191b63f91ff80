//! Bodies whose forces are a matrix times displacements.

use std::sync::Arc;

use crate::linear::Matrix;
use crate::math::vector::{difference, dot, weighted_mean};
use crate::system::{BodyModel, Deformed};

/// `f = K u`.
#[derive(Debug)]
pub struct LinearBodies {
    /// `K` `[N/m]`.
    pub stiffness: Arc<dyn Matrix>,
}

impl BodyModel for LinearBodies {
    fn forces(&self, u: &[f64]) -> Vec<f64> {
        self.stiffness.times(u)
    }

    fn energy(&self, at: Deformed) -> f64 {
        0.5 * dot(at.u, at.forces)
    }

    fn stage_forces(&self, first: f64, [from, to]: [Deformed; 2]) -> Vec<f64> {
        weighted_mean(first, from.forces, to.forces)
    }

    /// `(½ - first) Δuᵀ K Δu`, without the difference of energies.
    fn unstored_work(&self, first: f64, [from, to]: [Deformed; 2]) -> f64 {
        let forces = difference(to.forces, from.forces);
        (0.5 - first) * dot(&difference(to.u, from.u), &forces)
    }
}
