//! The bulk as one sparse matrix, solved anew in every iteration.

use super::bulk::Bulk;
use super::linearised::Linearised;
use super::operator::Operator;
use super::settings::Settings;
use super::statistics::Statistics;
use crate::linear::BlockCsr;
use crate::system::{Assembler, StepFailure};

/// The forces of the bulk at some displacements, from which they follow as `forces + A (u - at)`.
///
/// With a time step much smaller than the periods of the bodies `A u` is the difference of large numbers; inertia from the
/// velocities themselves is not.
pub struct Origin {
    /// Displacements.
    pub at: Vec<f64>,
    /// Internal and inertial forces of the bulk there, without external ones.
    pub forces: Vec<f64>,
    /// Size of the forces that balance each other there.
    pub scale: f64,
}

/// `A u - external` with prescribed displacements.
///
/// In statics `A` is the stiffness. In dynamics it is the stiffness and what inertia and damping add, and its forces are given by
/// their [`Origin`].
pub struct SparseBulk<'a> {
    /// The matrix, over all dofs.
    pub matrix: &'a BlockCsr,
    /// Its diagonal, by which the rounding of bulk forces is judged.
    pub diagonal: &'a [f64],
    /// External forces at the time of evaluation; nothing at the points of rigid bodies.
    pub external: Vec<f64>,
    /// Prescribed dofs and the points of rigid bodies.
    pub fixed: Vec<bool>,
    /// Where the forces are known; `None`: they are `A u`.
    pub origin: Option<Origin>,
    /// The factor of this matrix.
    pub linearised: &'a mut Linearised,
    dofs: Vec<usize>,
}

impl<'a> SparseBulk<'a> {
    /// A bulk with this matrix and its factor.
    pub fn new(
        matrix: &'a BlockCsr,
        diagonal: &'a [f64],
        external: Vec<f64>,
        fixed: Vec<bool>,
        origin: Option<Origin>,
        linearised: &'a mut Linearised,
    ) -> Self {
        SparseBulk {
            matrix,
            diagonal,
            dofs: (0..external.len()).collect(),
            external,
            fixed,
            origin,
            linearised,
        }
    }
}

impl Bulk for SparseBulk<'_> {
    fn dofs(&self) -> &[usize] {
        &self.dofs
    }

    fn fixed(&self) -> &[bool] {
        &self.fixed
    }

    fn begin(&mut self) {}

    fn forces(&mut self, u: &[f64], out: &mut [f64]) -> f64 {
        match &self.origin {
            None => self.matrix.mul(u, out),
            Some(origin) => {
                let moved: Vec<f64> = u.iter().zip(&origin.at).map(|(u, o)| u - o).collect();
                self.matrix.mul(&moved, out);
                for (f, known) in out.iter_mut().zip(&origin.forces) {
                    *f += known;
                }
            }
        }
        let (mut internal, mut external) = (0.0, 0.0);
        for ((f, e), &fixed) in out.iter_mut().zip(&self.external).zip(&self.fixed) {
            if fixed {
                internal += *f * *f;
            }
            external += e * e;
            *f -= e;
        }
        let known = self.origin.as_ref().map_or(0.0, |o| o.scale);
        f64::max(internal, external).sqrt().max(known)
    }

    fn diagonal(&self, dof: usize) -> f64 {
        self.diagonal[dof]
    }

    fn affordable(&self, settings: &Settings, operations: f64) -> usize {
        self.linearised.affordable(settings, operations)
    }

    fn wants_pairs(&self) -> bool {
        self.linearised.uses_multigrid()
    }

    fn solve(
        &mut self,
        contact: &Assembler,
        b: &[f64],
        tolerance: f64,
        du: &mut [f64],
        settings: &Settings,
        statistics: &mut Statistics,
    ) -> Result<usize, StepFailure> {
        let operator = Operator {
            matrix: self.matrix,
            stand_in: self.matrix,
            fixed: &self.fixed,
            blocks: &contact.blocks,
            couplings: &contact.couplings,
            pairs: &contact.pairs,
        };
        let solved = self
            .linearised
            .solve(operator, b, tolerance, settings, statistics)?;
        du.copy_from_slice(&solved.0);
        Ok(solved.1)
    }

    fn advance(&mut self, _step: f64) {}
}
