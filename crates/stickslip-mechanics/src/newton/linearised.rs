//! The linear system of one Newton iteration: the constant bulk plus contact blocks, solved by GMRES with a frozen factor or by multigrid.

use std::sync::Arc;
use std::time::Instant;

use super::failure::{describe, not_finite, not_reached};
use super::grids::{BodyPoints, Grids, GridsRecipe};
use super::operator::Operator;
use super::settings::Settings;
use super::stand_in::{StandIn, stand_ins};
use super::statistics::Statistics;
use crate::linear::{BlockCsr, Factor, GmresSettings, LinearError, Symbolic, gmres};
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
    /// What contact may couple, of which the symbolic factor was made with the pattern of the matrix.
    analysed: Arc<Vec<Vec<usize>>>,
    factor: Option<Factor>,
    /// Contact that went into the factor: its dofs and approximations.
    factored: Arc<Vec<StandIn>>,
    stale: bool,
}

/// What a [`Linearised`] was made of: enough to make it again, with the same bits.
#[derive(Debug, Clone, Default, crate::keep::Keep)]
pub(super) struct Recipe {
    pub grids: Option<GridsRecipe>,
    fixed: Vec<bool>,
    analysed: Option<Arc<Vec<Vec<usize>>>>,
    factored: Option<Arc<Vec<StandIn>>>,
    stale: bool,
}

impl Linearised {
    /// What it was made of; without its numbers where its matrix is not used any more.
    pub(super) fn recipe(&self, used: bool) -> Recipe {
        let factor = self.factor.as_ref().filter(|_| used);
        Recipe {
            grids: self.grids.as_ref().map(|grids| grids.recipe(used)),
            fixed: self.fixed.clone(),
            analysed: (self.symbolic.as_ref()).map(|_| Arc::clone(&self.analysed)),
            factored: factor.map(|_| Arc::clone(&self.factored)),
            stale: self.stale,
        }
    }

    /// Makes it again; without its numbers where its matrix is not used any more.
    pub(super) fn again(
        recipe: Recipe,
        matrix: Option<&BlockCsr>,
        like: &BlockCsr,
        points: Option<&Arc<BodyPoints>>,
    ) -> Result<Self, StepFailure> {
        let mut made = Linearised {
            fixed: recipe.fixed,
            stale: recipe.stale,
            ..Linearised::default()
        };
        if let (Some(grids), Some(points)) = (recipe.grids, points) {
            made.grids = Some(Grids::again(grids, matrix, points).map_err(describe)?);
        }
        if let Some(analysed) = recipe.analysed {
            let symbolic = Symbolic::analyze(like, &made.fixed, &analysed).map_err(describe)?;
            made.symbolic = Some(Arc::new(symbolic));
            made.analysed = analysed;
        }
        if let (Some(factored), Some(symbolic), Some(matrix)) =
            (recipe.factored, &made.symbolic, matrix)
        {
            let dense: Vec<(&[usize], &[f64])> = factored
                .iter()
                .map(|(dofs, values)| (dofs.as_slice(), values.as_slice()))
                .collect();
            made.factor = Some(Factor::new(symbolic, matrix, &dense).map_err(describe)?);
            made.factored = factored;
        }
        Ok(made)
    }

    /// The same without numbers, for another matrix with the same pattern.
    pub(super) fn without_factor(&self) -> Self {
        Linearised {
            grids: self.grids.as_ref().map(Grids::without_levels),
            fixed: self.fixed.clone(),
            symbolic: self.symbolic.clone(),
            analysed: Arc::clone(&self.analysed),
            ..Linearised::default()
        }
    }

    /// Forgets its numbers.
    pub(super) fn forget(&mut self) {
        self.factor = None;
        self.factored = Arc::default();
        self.stale = false;
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

    /// How many solutions with one matrix cost no more than another attempt, or than so many operations. An attempt takes a factor an iteration; a solution reads
    /// all its numbers four times, forwards and backwards and once more for the residual that rounding has left. With multigrid an iteration is a solution.
    pub(super) fn affordable(&self, settings: &Settings, operations: f64) -> usize {
        let iterations = settings.max_iterations as f64;
        let factored = self.symbolic.as_ref().filter(|_| !self.uses_multigrid());
        let solutions = factored.map_or(iterations, |s| {
            let one = 8.0 * s.factor_nonzeros() as f64;
            operations.max(iterations * s.flops()) / one
        });
        solutions as usize
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
            stand_in: matrix,
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
            statistics.factors.nonzeros = symbolic.factor_nonzeros();
            self.symbolic = Some(Arc::new(symbolic));
            self.analysed = Arc::new(couplings.to_vec());
            self.fixed = fixed.to_vec();
        }
        let ordering = started.elapsed().as_secs_f64();
        statistics.seconds.order += ordering;
        let started = Instant::now();
        let dense: Vec<(&[usize], &[f64])> = blocks
            .iter()
            .map(|b| (b.dofs.as_slice(), b.surrogate.as_slice()))
            .collect();
        self.factor = None;
        if let Some(symbolic) = &self.symbolic {
            self.factor = Some(Factor::new(symbolic, matrix, &dense)?);
            self.factored = Arc::new(stand_ins(blocks));
            statistics.factorisations += 1;
            statistics.factors.flops += symbolic.flops();
            statistics.factors.bytes = 8 * symbolic.factor_nonzeros() as u64;
        }
        self.stale = false;
        let factoring = started.elapsed().as_secs_f64();
        statistics.seconds.factor += factoring;
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
        statistics.seconds.solve += started.elapsed().as_secs_f64();
        if !report.relative_residual.is_finite() {
            return Err(not_finite());
        }
        Ok((x, report.iterations, report.converged))
    }
}
