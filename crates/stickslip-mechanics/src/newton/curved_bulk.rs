//! A bulk whose forces are not linear in the displacements: bodies that turn cell by cell.

use super::bulk::Bulk;
use super::linearised::Linearised;
use super::operator::Operator;
use super::settings::Settings;
use super::statistics::Statistics;
use crate::linear::BlockCsr;
use crate::system::{Assembler, NonlinearBody, StepFailure};

/// `f(u) - external` with prescribed displacements. Newton's method has the exact derivative; GMRES solves with it, preconditioned by a factor of its positive part, which
/// is made anew when it has become too different.
pub struct NonlinearBulk<'a> {
    curved: &'a dyn NonlinearBody,
    /// Of the stiffness at first, by which the rounding of forces is judged.
    diagonal: &'a [f64],
    external: Vec<f64>,
    fixed: Vec<bool>,
    linearised: &'a mut Linearised,
    dofs: Vec<usize>,
    /// Displacements at which forces were wanted last, and those at the last solution.
    at: Vec<f64>,
    start: Vec<f64>,
    /// The last solution.
    du: Vec<f64>,
    /// The tangents of a state.
    made: Option<(Vec<f64>, [BlockCsr; 2])>,
}

impl<'a> NonlinearBulk<'a> {
    /// A bulk with these forces, of which nothing is known yet.
    pub fn new(
        curved: &'a dyn NonlinearBody,
        diagonal: &'a [f64],
        external: Vec<f64>,
        fixed: Vec<bool>,
        linearised: &'a mut Linearised,
    ) -> Self {
        linearised.forget();
        let count = external.len();
        NonlinearBulk {
            curved,
            diagonal,
            external,
            fixed,
            linearised,
            dofs: (0..count).collect(),
            at: vec![0.0; count],
            start: vec![0.0; count],
            du: vec![0.0; count],
            made: None,
        }
    }
}

impl Bulk for NonlinearBulk<'_> {
    fn dofs(&self) -> &[usize] {
        &self.dofs
    }

    fn fixed(&self) -> &[bool] {
        &self.fixed
    }

    fn begin(&mut self) {}

    fn forces(&mut self, u: &[f64], out: &mut [f64]) -> f64 {
        self.at.copy_from_slice(u);
        self.curved.write_forces(u, out);
        let (mut internal, mut external) = (0.0, 0.0);
        for ((f, e), &fixed) in out.iter_mut().zip(&self.external).zip(&self.fixed) {
            if fixed {
                internal += *f * *f;
            }
            external += e * e;
            *f -= e;
        }
        f64::max(internal, external).sqrt()
    }

    fn diagonal(&self, dof: usize) -> f64 {
        self.diagonal[dof]
    }

    fn affordable(&self, settings: &Settings, operations: f64) -> usize {
        self.linearised.affordable(settings, operations)
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
        let made = match self.made.take() {
            Some((at, made)) if at == self.at => made,
            _ => self.curved.tangents(&self.at),
        };
        let [matrix, stand_in] = &made;
        let operator = Operator {
            matrix,
            stand_in,
            fixed: &self.fixed,
            blocks: &contact.blocks,
            couplings: &contact.couplings,
            pairs: &contact.pairs,
        };
        let solved = (self.linearised).solve(operator, b, tolerance, settings, statistics);
        self.made = Some((self.at.clone(), made));
        let (x, iterations) = solved?;
        du.copy_from_slice(&x);
        self.start.clone_from(&self.at);
        self.du = x;
        Ok(iterations)
    }

    fn advance(&mut self, step: f64) {
        let ways = self.start.iter().zip(&self.du);
        for (at, (start, du)) in self.at.iter_mut().zip(ways) {
            *at = start + step * du;
        }
    }
}
