use std::sync::Arc;

use super::contract::{Analysed, FactorEffort, Interior};
use super::split::Split;
use crate::linear::{LinearError, Matrix, Schur, Workspace};

/// A part of which nothing is eliminated, as of a rigid body: its own rows are what is left.
#[derive(Debug)]
pub(super) struct Undivided(pub Split);

impl Analysed for Undivided {
    fn interior(&self) -> &[u32] {
        &self.0.interior
    }

    fn root(&self) -> &[u32] {
        &self.0.root
    }

    fn effort(&self) -> FactorEffort {
        FactorEffort {
            bytes: 8 * self.longest() as u64,
            ..FactorEffort::default()
        }
    }

    fn longest(&self) -> usize {
        self.0.root.len().pow(2)
    }

    fn bytes(&self) -> u64 {
        self.0.bytes()
    }

    fn factor(
        self: Arc<Self>,
        matrix: &dyn Matrix,
        workspace: &Workspace,
    ) -> Result<(Box<dyn Interior>, Schur), LinearError> {
        let c = self.0.root.len();
        let mut values = workspace.take(c * c)?;
        values.fill(0.0);
        let lower = &mut values[..];
        matrix.summands(
            self.0.points(matrix.block_size()),
            &mut |row, column, value| {
                let places = (self.0.position(row), self.0.position(column));
                if let (Some(i), Some(j)) = places
                    && i >= j
                {
                    lower[j * c + i] += value;
                }
            },
        );
        if let Some(at) = values.iter().position(|v| !v.is_finite()) {
            return Err(LinearError::NotFinite {
                dof: self.0.dof(at % c),
            });
        }
        Ok((Box::new(Nothing(self)), Schur::Here(values)))
    }
}

/// The interior that there is not.
#[derive(Debug)]
struct Nothing(Arc<Undivided>);

impl Interior for Nothing {
    fn ordered(&self) -> &dyn Analysed {
        &*self.0
    }

    fn reduce(&self, _: &mut [f64], _: &mut [f64], _: usize) -> Result<(), LinearError> {
        Ok(())
    }

    fn recover(&self, _: &mut [f64], _: &[f64], _: usize) -> Result<(), LinearError> {
        Ok(())
    }

    fn bytes(&self) -> u64 {
        0
    }

    fn effort(&self) -> FactorEffort {
        self.0.effort()
    }
}
