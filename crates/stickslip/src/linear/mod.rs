//! Sparse matrices and the solution of linear systems.
//!
//! [`BlockCsr`] holds a matrix over the points of a mesh. [`Symbolic`] and [`Factor`] solve symmetric positive definite
//! systems.

mod block_csr;
mod dense;
mod error;
mod factor;
mod ordering;
mod pattern;
mod symbolic;
#[cfg(test)]
mod testing;

pub use block_csr::BlockCsr;
pub use dense::DenseLu;
pub use error::LinearError;
pub use factor::{Factor, SINGULAR_PIVOT};
pub use pattern::Couplings;
pub use symbolic::Symbolic;
