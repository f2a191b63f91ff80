use super::condensation::Condensation;
use super::preconditioner::SMALL;
use super::reduced_system::{ReducedSystem, SMALL_SYSTEM};
use crate::newton::bulk::Bulk;
use crate::newton::describe;
use crate::newton::settings::Settings;
use crate::newton::statistics::Statistics;
use crate::system::{Assembler, Cause, StepFailure};

/// The bulk as it is felt at the contact candidates.
///
/// The displacements of the candidates are `base + W s`; nothing is known of the interior, and nothing has to be.
#[derive(Debug)]
pub struct CondensedBulk<'a> {
    condensation: &'a Condensation,
    system: &'a mut ReducedSystem,
    diagonal: &'a [f64],
    /// At the candidates: external forces, with what comes through the interior.
    load: Vec<f64>,
    /// Displacements from which the forces count.
    base: Vec<f64>,
    /// `s` at the guess, now, before the last solution, and the solution.
    guess: Vec<f64>,
    now: Vec<f64>,
    before: Vec<f64>,
    step: Vec<f64>,
    /// Size of forces that balance each other elsewhere.
    scale: f64,
}

impl<'a> CondensedBulk<'a> {
    /// A bulk under a load at the candidates, at `base + W guess` to start with. `diagonal` is that of the matrix, by dof; `scale` the size of
    /// forces that balance each other elsewhere.
    pub fn new(
        condensation: &'a Condensation,
        system: &'a mut ReducedSystem,
        diagonal: &'a [f64],
        load: Vec<f64>,
        base: Vec<f64>,
        guess: Vec<f64>,
        scale: f64,
    ) -> Self {
        system.begin();
        CondensedBulk {
            condensation,
            system,
            diagonal,
            load,
            base,
            now: guess.clone(),
            before: guess.clone(),
            step: vec![0.0; guess.len()],
            guess,
            scale,
        }
    }

    /// `s` after the last step.
    pub fn carried(self) -> Vec<f64> {
        self.now
    }
}

impl Bulk for CondensedBulk<'_> {
    fn dofs(&self) -> &[usize] {
        &self.condensation.dofs
    }

    fn fixed(&self) -> &[bool] {
        &self.condensation.fixed
    }

    fn begin(&mut self) {
        self.now.clone_from(&self.guess);
    }

    fn forces(&mut self, u: &[f64], out: &mut [f64]) -> f64 {
        let moved: Vec<f64> = self
            .condensation
            .dofs
            .iter()
            .zip(&self.base)
            .map(|(&dof, base)| u[dof] - base)
            .collect();
        let mut forces = self.now.clone();
        self.condensation.release(&moved, &mut forces);
        for (f, l) in forces.iter_mut().zip(&self.load) {
            *f -= l;
        }
        self.condensation.scatter(&forces, out);
        self.scale
    }

    fn diagonal(&self, dof: usize) -> f64 {
        self.diagonal[dof]
    }

    fn wants_surrogates(&self) -> bool {
        false
    }

    /// Two products with the compliance a Krylov step in place of one; where the factor is made every time there are next to none.
    fn prefers_straight(&self, contact: &Assembler) -> bool {
        3 * contact.blocks.len() > SMALL_SYSTEM
    }

    /// A solution is a product with a dense matrix.
    fn affordable(&self, _settings: &Settings, _operations: f64) -> usize {
        usize::MAX
    }

    fn covers(&self, contact: &Assembler) -> Result<(), StepFailure> {
        for block in &contact.blocks {
            for &dof in &block.dofs {
                if self.condensation.fixed[dof] && !self.condensation.held[dof] {
                    return Err(StepFailure {
                        dof: Some(dof),
                        ..StepFailure::new(
                            Cause::Reach,
                            "contact reaches points that were not expected to be touched",
                        )
                    });
                }
            }
        }
        Ok(())
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
        let started = std::time::Instant::now();
        let b = self.condensation.gather(b);
        // More digits than these cost more than another iteration, unless next to nothing is solved.
        let asked = settings.linear_tolerance;
        let finest = match 3 * contact.blocks.len() {
            0..=SMALL_SYSTEM => 1e-13,
            SMALL.. => asked,
            // Where more rows are than need a factor in single precision it is what was asked for: with two digits while points change
            // status a slab that is pressed on a plane came to no rest, each point slipping another way from iteration to iteration.
            _ => 1e-5_f64.min(asked),
        };
        let tolerance = tolerance.max(finest);
        let solved = self.system.solve(
            self.condensation,
            &contact.blocks,
            &b,
            tolerance,
            settings,
            &mut *statistics,
        );
        // Products with a compliance that an engine had are no numbers then.
        if let Some(fault) = self.condensation.fault() {
            return Err(describe(fault));
        }
        let solved = solved?;
        self.before.clone_from(&self.now);
        self.step = solved.forces;
        self.condensation.scatter(&solved.displacements, du);
        statistics.seconds.solve += started.elapsed().as_secs_f64();
        Ok(solved.iterations)
    }

    fn advance(&mut self, step: f64) {
        for ((now, before), d) in self.now.iter_mut().zip(&self.before).zip(&self.step) {
            *now = before + step * d;
        }
    }
}
