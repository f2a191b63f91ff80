//! The linear system of one Newton iteration: the constant bulk plus contact blocks, solved by GMRES with a frozen factor or by multigrid.

use std::sync::Arc;
use std::time::Instant;

use super::failure::{describe, not_finite, not_reached};
use super::grids::{BodyPoints, Grids};
use super::operator::Operator;
use super::settings::Settings;
use super::statistics::Statistics;
use crate::linear::{Factor, GmresSettings, LinearError, Symbolic, gmres};
use crate::system::StepFailure;

/// A symmetric positive definite factor that outlives the state it was made at.
///
/// It is made of the bulk and the symmetric part of the interface at some iteration; GMRES makes up for what has changed since
/// and for the unsymmetry of slip. When that takes too many iterations, a fresh factor is made.
///
/// Or it is multigrid; where that does not work, a factor takes its place.
#[derive(Debug, Default)]
pub struct Linearised {
    grids: Option<Grids>,
    fixed: Vec<bool>,
    symbolic: Option<Arc<Symbolic>>,
    factor: Option<Factor>,
    stale: bool,
}

impl Linearised {
    /// The same without numbers, for another matrix with the same pattern.
    pub(super) fn without_factor(&self) -> Self {
        Linearised {
            grids: self.grids.as_ref().map(Grids::without_levels),
            fixed: self.fixed.clone(),
            symbolic: self.symbolic.clone(),
            ..Linearised::default()
        }
    }

    /// Solves by multigrid on this mesh.
    pub(super) fn multigrid(points: Arc<BodyPoints>) -> Self {
        Linearised {
            grids: Some(Grids::new(points)),
            ..Linearised::default()
        }
    }

    /// Whether multigrid is used.
    pub(super) fn uses_multigrid(&self) -> bool {
        self.grids.as_ref().is_some_and(Grids::works)
    }

    /// Why multigrid has been given up, once.
    pub(super) fn note(&mut self) -> Option<String> {
        self.grids.as_mut()?.note()
    }

    fn matches(&self, fixed: &[bool]) -> bool {
        self.symbolic.is_some() && self.fixed == fixed
    }

    fn refactor(
        &mut self,
        operator: Operator,
        statistics: &mut Statistics,
    ) -> Result<(), LinearError> {
        let Operator {
            matrix,
            fixed,
            blocks,
            couplings,
            ..
        } = operator;
        let started = Instant::now();
        let covered = self.matches(fixed)
            && self
                .symbolic
                .as_ref()
                .is_some_and(|s| blocks.iter().all(|b| s.covers(&b.dofs)));
        if !covered {
            let symbolic = Symbolic::analyze(matrix, fixed, couplings)?;
            statistics.analyses += 1;
            statistics.factor_nonzeros = symbolic.factor_nonzeros();
            self.symbolic = Some(Arc::new(symbolic));
            self.fixed = fixed.to_vec();
        }
        let ordering = started.elapsed().as_secs_f64();
        statistics.seconds_order += ordering;
        let started = Instant::now();
        let dense: Vec<(&[usize], &[f64])> = blocks
            .iter()
            .map(|b| (b.dofs.as_slice(), b.surrogate.as_slice()))
            .collect();
        self.factor = None;
        if let Some(symbolic) = &self.symbolic {
            self.factor = Some(Factor::new(symbolic, matrix, &dense)?);
            statistics.factorisations += 1;
            statistics.flops += symbolic.flops();
            statistics.factor_bytes = 8 * symbolic.factor_nonzeros() as u64;
        }
        self.stale = false;
        let factoring = started.elapsed().as_secs_f64();
        statistics.seconds_factor += factoring;
        if statistics.linear_solve == 0.0 {
            statistics.linear_solve = ordering + factoring;
        }
        Ok(())
    }

    /// Solves `(bulk + blocks) x = b` on the free dofs; `x` is zero where fixed. Returns `x` and the Krylov iterations.
    pub fn solve(
        &mut self,
        operator: Operator,
        b: &[f64],
        tolerance: f64,
        settings: &Settings,
        statistics: &mut Statistics,
    ) -> Result<(Vec<f64>, usize), StepFailure> {
        if let Some(grids) = self.grids.as_mut().filter(|g| g.works())
            && let Some(solved) = grids.solve(operator, b, tolerance, statistics)?
        {
            return Ok(solved);
        }
        if !self.matches(operator.fixed) {
            self.factor = None;
        }
        let mut spent = 0;
        if self.factor.is_some() && !self.stale {
            let patience = 2 * settings.krylov_patience;
            let (x, its, done) = self.krylov(operator, b, tolerance, patience, statistics)?;
            spent += its;
            if done {
                self.stale = its > settings.krylov_patience;
                return Ok((x, spent));
            }
        }
        self.refactor(operator, statistics).map_err(describe)?;
        let (x, its, done) = self.krylov(operator, b, tolerance, 200, statistics)?;
        spent += its;
        if !done {
            return Err(not_reached(its));
        }
        self.stale = its > settings.krylov_patience;
        Ok((x, spent))
    }

    fn krylov(
        &self,
        operator: Operator,
        b: &[f64],
        tolerance: f64,
        most: usize,
        statistics: &mut Statistics,
    ) -> Result<(Vec<f64>, usize, bool), StepFailure> {
        let started = Instant::now();
        let Some(factor) = &self.factor else {
            return Ok((vec![0.0; b.len()], 0, false));
        };
        let mut x = vec![0.0; b.len()];
        let report = gmres(
            &mut |v, out| operator.apply(v, out),
            &mut |v| factor.solve(v),
            b,
            &mut x,
            GmresSettings {
                tolerance,
                max_iterations: most,
                restart: most.min(60),
            },
        );
        statistics.krylov += report.iterations;
        statistics.seconds_solve += started.elapsed().as_secs_f64();
        if !report.relative_residual.is_finite() {
            return Err(not_finite());
        }
        Ok((x, report.iterations, report.converged))
    }
}
