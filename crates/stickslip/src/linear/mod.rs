//! Sparse matrices and the solution of linear systems.

mod block_csr;
mod pattern;
#[cfg(test)]
mod testing;

pub use block_csr::BlockCsr;
pub use pattern::Couplings;
