use std::sync::Arc;

use super::contract::{Cut, Engine, EngineReport, FactorEffort, Interior, Ordered};
use crate::linear::{BlockCsr, Fronts, LinearError, Numbers, PartialFactor, Workspace};

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
        matrix: &BlockCsr,
        (points, fixed, kept): Cut,
    ) -> Result<Arc<dyn Ordered>, LinearError> {
        Ok(Arc::new(Fronts::analyze(matrix, points, fixed, kept)?))
    }
}

impl Ordered for Fronts {
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
        matrix: &BlockCsr,
        workspace: &Workspace,
    ) -> Result<(Box<dyn Interior>, Numbers), LinearError> {
        let (factor, schur) = PartialFactor::new(&self, matrix, workspace)?;
        Ok((Box::new(factor), schur))
    }
}

impl Interior for PartialFactor {
    fn ordered(&self) -> &dyn Ordered {
        &**self.fronts()
    }

    fn reduce(
        &self,
        interior: &mut [f64],
        root: &mut [f64],
        columns: usize,
    ) -> Result<(), LinearError> {
        self.forward(interior, root, columns);
        Ok(())
    }

    fn recover(
        &self,
        interior: &mut [f64],
        root: &[f64],
        columns: usize,
    ) -> Result<(), LinearError> {
        self.backward(interior, root, columns);
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
