use std::fmt::Debug;

use super::LinearError;

/// A dense symmetric matrix that processes of an engine share: a Schur complement, and then its inverse.
pub trait DistributedOperator: Debug + Send + Sync {
    /// The sum of the diagonal.
    fn trace(&self) -> f64;

    /// A number a row, which rows that hang together have in common.
    fn pieces(&self) -> &[u32];

    /// Products with vectors, one behind the other.
    ///
    /// # Errors
    /// [`LinearError::Engine`].
    fn products(&self, vectors: &[f64]) -> Result<Vec<f64>, LinearError>;

    /// Adds `σ Σ m mᵀ` and becomes the inverse.
    ///
    /// # Errors
    /// [`LinearError::NotPositive`] with the row, [`LinearError::Engine`].
    fn invert(&self, modes: &[Vec<f64>], sigma: f64) -> Result<(), LinearError>;
}
