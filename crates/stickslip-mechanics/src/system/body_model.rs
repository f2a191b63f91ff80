//! How the bodies of a model answer displacements: one implementation a formulation.
//!
//! Schemes, Newton's method and the ledger know bodies by this trait alone. What is linear, what turns as a whole in a frame of its own and what turns cell by cell differ
//! in nothing else.

use std::fmt;

use crate::linear::BlockCsr;
use crate::math::vector::{difference, dot};

/// Displacements `[m]` and the elastic forces at them `[N]`, both by dof.
#[derive(Debug, Clone, Copy)]
pub struct Deformed<'a> {
    /// Displacements.
    pub u: &'a [f64],
    /// [`BodyModel::forces`] at them.
    pub forces: &'a [f64],
}

/// A matrix that multiplies velocities or displacements, both by dof.
pub type Product<'a> = dyn Fn(&[f64]) -> Vec<f64> + 'a;

/// Elastic bodies and springs, with the dofs of the whole model.
pub trait BodyModel: fmt::Debug + Send + Sync {
    /// Elastic forces at displacements `u` `[N]`.
    fn forces(&self, u: &[f64]) -> Vec<f64>;

    /// The strain energy at displacements `[J]`.
    fn energy(&self, at: Deformed) -> f64;

    /// Elastic forces at a stage of a time scheme `[N]`, at which the first of two ends of an increment has the weight `first` and the second the rest.
    fn stage_forces(&self, first: f64, ends: [Deformed; 2]) -> Vec<f64>;

    /// The work of the stage forces over the increment, less the strain energy that it stores `[J]`.
    fn unstored_work(&self, first: f64, ends: [Deformed; 2]) -> f64 {
        let [from, to] = ends;
        let work = dot(&difference(to.u, from.u), &self.stage_forces(first, ends));
        work - (self.energy(to) - self.energy(from))
    }

    /// Forces of a damping matrix at displacements `u` `[m]` and velocities `v` `[m/s]`, both by dof `[N]`. A formulation in which bodies turn takes the turn out of `v`.
    fn damping(&self, matrix: &Product, _u: &[f64], v: &[f64]) -> Vec<f64> {
        matrix(v)
    }

    /// The bodies with their tangents; `None` where increments are solved with the stiffness at rest.
    fn nonlinear(&self) -> Option<&dyn NonlinearBody> {
        None
    }
}

/// Forces that are not linear in displacements, with their derivative.
pub trait NonlinearBody {
    /// Writes the internal forces at displacements `u` `[N]`, both by dof.
    fn write_forces(&self, u: &[f64], out: &mut [f64]);

    /// Their derivative by displacements, and a matrix of the same pattern that is like it and positive definite where supports hold the bodies, of which factors are made `[N/m]`.
    fn tangents(&self, u: &[f64]) -> [BlockCsr; 2];
}
