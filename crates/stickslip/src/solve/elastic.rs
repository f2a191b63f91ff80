//! What bodies resist displacements and velocities with. Those with frames of their own ([`Corotations`](crate::system::Corotations)) do in these, any others
//! along the axes that displacements have.

use super::cell_by_cell::Cells;
use super::inertia::in_motion;
use super::solver::Solver;
use crate::math::vector::dot;
use crate::model::definition::Model;

/// A weight of the start of an increment, and displacements there with their elastic forces.
pub(crate) type Start<'a> = (f64, (&'a [f64], &'a [f64]));

impl Solver {
    /// Elastic forces of bodies and springs at displacements `[N]`.
    pub fn elastic(&self, model: &Model, u: &[f64]) -> Vec<f64> {
        if let Some(linear) = &self.linear {
            let mut forces = vec![0.0; u.len()];
            Cells { model, linear }.forces(u, &mut forces);
            return forces;
        }
        let bodies = &model.corotations;
        if bodies.is_empty() {
            return self.stiffness.times(u);
        }
        let turns = bodies.turns(u);
        let local = bodies.local(&turns, u);
        let mut forces = self.stiffness.times(&local);
        bodies.outward(&turns, &local, &mut forces);
        forces
    }

    /// Strain energy of bodies and springs `[J]`.
    pub fn strain_energy(&self, model: &Model, u: &[f64]) -> f64 {
        if let Some(linear) = &self.linear {
            return Cells { model, linear }.energy(u);
        }
        let bodies = &model.corotations;
        if bodies.is_empty() {
            return 0.5 * dot(u, &self.stiffness.times(u));
        }
        let local = bodies.local(&bodies.turns(u), u);
        0.5 * dot(&local, &self.stiffness.times(&local))
    }

    /// Elastic forces at the stage of a scheme, which lies between the start and the end of an increment with forces `internal`. What turns is in its frame
    /// *at the stage*, so that nothing acts on the spin, and strained by the mean of what it is strained by at both ends, so that a turn between strains
    /// nothing. The mean is one along the axes of the frames. Along those of space it would change with displacements just as a matrix that is seen from
    /// the frame of the stage; but then vibrations of a body that turns feed on the turn.
    pub fn elastic_between(
        &self,
        model: &Model,
        (old, (before, known)): Start,
        u: &[f64],
        internal: &[f64],
    ) -> Vec<f64> {
        let bodies = &model.corotations;
        if bodies.is_empty() {
            return mix(old, known, internal);
        }
        let strained = |u: &[f64]| bodies.local(&bodies.turns(u), u);
        let mean = mix(old, &strained(before), &strained(u));
        let mut forces = self.stiffness.times(&mean);
        let stage = mix(old, before, u);
        let turns = bodies.turns(&stage);
        bodies.outward(&turns, &bodies.local(&turns, &stage), &mut forces);
        forces
    }

    /// Forces of Rayleigh damping at displacements and velocities `[N]`: a turn as a whole is not damped.
    pub fn damping_force(&self, model: &Model, u: &[f64], v: &[f64]) -> Vec<f64> {
        let inertia = in_motion(&self.inertia);
        let bodies = &model.corotations;
        if bodies.is_empty() || inertia.damping.is_none() {
            return inertia.damping_force(v);
        }
        let turns = bodies.turns(u);
        let local = bodies.local(&turns, u);
        let mut forces = inertia.damping_force(&bodies.deforming(&turns, &local, v));
        bodies.outward(&turns, &local, &mut forces);
        forces
    }
}

/// `(1 - old) b + old a`.
pub(crate) fn mix(old: f64, a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter()
        .zip(b)
        .map(|(a, b)| old * a + (1.0 - old) * b)
        .collect()
}
