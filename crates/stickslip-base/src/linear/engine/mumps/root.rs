//! The Schur complement where it is too large for one process: over the ranks, and so is its inverse.

use std::sync::Arc;

use super::number::Number;
use crate::linear::{DistributedOperator, LinearError};

/// The Schur complement of a body, or its inverse.
#[derive(Debug)]
pub(super) struct Root {
    pub number: Arc<Number>,
    pub pieces: Vec<u32>,
    pub trace: f64,
}

impl DistributedOperator for Root {
    fn trace(&self) -> f64 {
        self.trace
    }

    fn pieces(&self) -> &[u32] {
        &self.pieces
    }

    fn products(&self, vectors: &[f64]) -> Result<Vec<f64>, LinearError> {
        let columns = vectors.len() / self.pieces.len();
        let command = format!("multiply {} {columns}", self.number.number);
        let mut out = vec![0.0; vectors.len()];
        self.number.job.vectors(&command, &[vectors], &mut out)?;
        Ok(out)
    }

    fn invert(&self, modes: &[Vec<f64>], sigma: f64) -> Result<(), LinearError> {
        let Number { job, number, .. } = &*self.number;
        let vectors: Vec<&[f64]> = modes.iter().map(Vec::as_slice).collect();
        let command = format!("invert {number} {} {sigma:e}", modes.len());
        job.send(&command, &vectors).map(drop)
    }
}
