use std::sync::Arc;

use super::contract::{Analysed, Cut, Engine, EngineReport, FactorEffort, Interior};
use crate::linear::multifrontal::sweep;
use crate::linear::{BlockCsr, Fronts, LinearError, Matrix, PartialFactor, Schur, Workspace};

/// The multifrontal factorisation of this library, on the threads of this process: the same bits on any number of them.
#[derive(Debug, Clone, Copy, Default)]
pub struct Multifrontal;

impl Engine for Multifrontal {
    fn report(&self) -> EngineReport {
        EngineReport {
            name: "multifrontal",
            version: env!("CARGO_PKG_VERSION").into(),
            ranks: 1,
            reproducible: true,
            ..EngineReport::default()
        }
    }

    fn identity(&self) -> u64 {
        0
    }

    fn keeps_files(&self) -> bool {
        true
    }

    fn order(
        self: Arc<Self>,
        matrix: &dyn Matrix,
        (points, fixed, kept): Cut,
    ) -> Result<Arc<dyn Analysed>, LinearError> {
        let fronts = with_entries(matrix, |m| Fronts::analyze(m, points, fixed, kept))?;
        Ok(Arc::new(fronts))
    }
}

/// Needs the entries.
fn with_entries<T>(matrix: &dyn Matrix, of: impl FnOnce(&BlockCsr) -> T) -> T {
    match matrix.kept() {
        Ok(kept) => of(kept),
        Err(_) => of(&matrix.make()),
    }
}

impl Analysed for Fronts {
    fn interior(&self) -> &[u32] {
        self.interior()
    }

    fn root(&self) -> &[u32] {
        self.root()
    }

    fn effort(&self) -> FactorEffort {
        FactorEffort {
            flops: self.flops(),
            nonzeros: self.nonzeros() as f64,
            bytes: self.peak_bytes(),
        }
    }

    fn longest(&self) -> usize {
        self.longest()
    }

    fn bytes(&self) -> u64 {
        self.bytes()
    }

    fn factor(
        self: Arc<Self>,
        matrix: &dyn Matrix,
        workspace: &Workspace,
    ) -> Result<(Box<dyn Interior>, Schur), LinearError> {
        let made = with_entries(matrix, |m| PartialFactor::new(&self, m, workspace));
        let (factor, schur) = made?;
        Ok((Box::new(factor), Schur::Here(schur)))
    }
}

impl Interior for PartialFactor {
    fn ordered(&self) -> &dyn Analysed {
        &**self.fronts()
    }

    fn reduce(
        &self,
        interior: &mut [f64],
        root: &mut [f64],
        columns: usize,
    ) -> Result<(), LinearError> {
        sweep::forward(self, interior, root, columns);
        Ok(())
    }

    fn recover(
        &self,
        interior: &mut [f64],
        root: &[f64],
        columns: usize,
    ) -> Result<(), LinearError> {
        sweep::backward(self, interior, root, columns);
        Ok(())
    }

    fn bytes(&self) -> u64 {
        self.bytes()
    }

    fn effort(&self) -> FactorEffort {
        self.fronts().effort()
    }

    fn to_file(&self) -> Option<&PartialFactor> {
        Some(self)
    }
}
