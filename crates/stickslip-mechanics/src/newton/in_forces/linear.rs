//! The linear problem of one pass: everything but the unknowns.

use super::place::Place;
use crate::newton::attempt::Attempt;
use crate::newton::settings::Settings;
use crate::system::{Assembler, Cause, StepFailure};

/// Residual to which its solutions are found, relative to the right-hand side. It is a tenth of the error to which friction problems are
/// solved.
pub(super) const COLUMN_RESIDUAL: f64 = 1e-9;

/// The linear problem of one pass.
pub(super) struct Linear<'a, 'b, 's> {
    pub attempt: &'a mut Attempt<'b, 's>,
    /// Forces and tangents of all that is no unknown, and of what holds points where they are.
    pub held: Assembler,
    /// Forces of the bulk at the iterate.
    pub rest: Vec<f64>,
    /// Residual to which solutions are found.
    pub tolerance: f64,
}

impl Linear<'_, '_, '_> {
    /// The displacements under forces by dof.
    pub fn displacements(&mut self, b: &[f64]) -> Result<Vec<f64>, StepFailure> {
        if (self.attempt.interrupted)() {
            return Err(StepFailure::new(Cause::Interrupted, "interrupted"));
        }
        let system = &mut *self.attempt.system;
        let fixed = system.bulk.fixed();
        let free: Vec<f64> = b
            .iter()
            .zip(fixed)
            .map(|(b, fixed)| if *fixed { 0.0 } else { *b })
            .collect();
        let mut du = vec![0.0; b.len()];
        // As accurate as rounding lets it be: what holds points is soft, and would make much of what is left.
        let coarsest = self.attempt.settings.linear_tolerance;
        loop {
            let settings = Settings {
                linear_tolerance: self.tolerance,
                ..self.attempt.settings
            };
            let counts = &mut *self.attempt.statistics;
            let held = &self.held;
            let solved =
                (system.bulk).solve(held, &free, self.tolerance, &mut du, &settings, counts);
            match solved {
                Err(failure)
                    if failure.cause == Cause::LinearSolver && self.tolerance < coarsest =>
                {
                    // Ten times as much is left where rounding keeps a solution from its residual.
                    self.tolerance = (10.0 * self.tolerance).min(coarsest);
                }
                solved => {
                    solved?;
                    break;
                }
            }
        }
        system.links.impose(&mut du);
        Ok(du)
    }

    /// Components of a force.
    pub fn dimension(&self) -> usize {
        self.attempt.system.dofs.dim.min(3)
    }

    /// What is out of balance without the unknowns, and what brings multipliers of the rest, as those of equations, to where their rows hold.
    pub fn unbalanced(&self) -> Vec<f64> {
        let held = self.held.residual.iter().zip(&self.held.condensed);
        let all = self.rest.iter().zip(held);
        all.map(|(rest, (residual, condensed))| -(rest + residual + condensed))
            .collect()
    }

    /// The displacements with forces at points, next to those by dof.
    pub fn under(
        &mut self,
        free: &[f64],
        points: &[&Place],
        forces: &[f64],
    ) -> Result<Vec<f64>, StepFailure> {
        let d = forces.len() / points.len().max(1);
        let mut b = free.to_vec();
        for (place, forces) in points.iter().zip(forces.chunks(d.max(1))) {
            for (q, &force) in forces.iter().enumerate() {
                place.push(q, force, &mut b);
            }
        }
        self.displacements(&b)
    }
}
