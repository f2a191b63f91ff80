//! Sparse matrices and their solution.
/// placeholder
#[derive(Debug)]
pub struct BlockCsr;
