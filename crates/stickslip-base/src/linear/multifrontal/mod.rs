//! Partial factorisation `K = L Lᵀ` of a sparse symmetric positive definite matrix: the interior dofs are eliminated,
//! the kept ones stay as one dense matrix, their Schur complement.
//!
//! The multifrontal method ([Duff and Reid 1983](crate::references::duff_reid_1983),
//! [Liu 1992](crate::references::liu_1992)): columns of the factor with nearly the same rows form a *front*; what its
//! elimination leaves to its rows, its contribution, is added to the front above it, and at last to the kept dofs.
//! With nothing kept it is the [`Factor`] of a whole matrix.
//!
//! Every sum is made in an order given by [`Fronts`]: the bits of all results are the same on any number of threads.

mod complete;
mod dense;
mod encode;
mod graph;
mod kernels;
mod numeric;
mod schedule;
mod supernodes;
pub(crate) mod sweep;
mod symbolic;
#[cfg(test)]
mod tests;
mod tree;

pub use complete::{Factor, Symbolic};
pub use encode::{read_factor, write_factor};
pub use numeric::{Numbers, PartialFactor, SINGULAR_ROUNDINGS, Workspace};
pub use symbolic::Fronts;
