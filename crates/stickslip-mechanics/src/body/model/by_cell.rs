//! Bodies of which some turn cell by cell.

use crate::body::{Elastic, recover};
use crate::linear::BlockCsr;
use crate::math::vector::{dot, weighted_mean};
use crate::system::{BodyModel, Deformed, NonlinearBody};

/// Bodies with a frame for each of their cells ([`Elastic::corotational`]) beside linear ones.
#[derive(Debug)]
pub struct BodiesByCell {
    /// The stiffness of all that is linear, with the pattern of the whole `[N/m]`.
    pub linear: BlockCsr,
    /// The bodies that turn cell by cell.
    pub turning: Vec<Elastic>,
}

impl BodyModel for BodiesByCell {
    fn forces(&self, u: &[f64]) -> Vec<f64> {
        let mut forces = vec![0.0; u.len()];
        self.write_forces(u, &mut forces);
        forces
    }

    fn energy(&self, at: Deformed) -> f64 {
        let mut linear = vec![0.0; at.u.len()];
        self.linear.mul(at.u, &mut linear);
        let turning = self
            .turning
            .iter()
            .map(|body| recover::strain_energy(body, at.u));
        0.5 * dot(at.u, &linear) + turning.sum::<f64>()
    }

    fn stage_forces(&self, first: f64, [from, to]: [Deformed; 2]) -> Vec<f64> {
        self.forces(&weighted_mean(first, from.u, to.u))
    }

    fn nonlinear(&self) -> Option<&dyn NonlinearBody> {
        Some(self)
    }
}

impl NonlinearBody for BodiesByCell {
    fn write_forces(&self, u: &[f64], out: &mut [f64]) {
        self.linear.mul(u, out);
        let turning = self.turning.iter();
        turning.for_each(|body| recover::internal_force(body, u, out));
    }

    fn tangents(&self, u: &[f64]) -> [BlockCsr; 2] {
        let (mut exact, mut stiff) = (self.linear.clone(), self.linear.clone());
        let turning = self.turning.iter();
        turning.for_each(|body| body.tangents(u, &mut exact, &mut stiff));
        [exact, stiff]
    }
}
