//! Sparse matrices and the solution of linear systems; [`gmres`] solves unsymmetric ones, preconditioned by a factor of
//! something close. [`relative_residual`] tells whether any of them did.
//!
//! [`BlockCsr`] holds a matrix over the points of a mesh. [`Symbolic`] and [`Factor`] solve symmetric positive definite
//! systems; [`Multigrid`] approximates their solution where a factor would be too large.

mod block_csr;
mod compliance;
mod digest;
mod eigen;
mod elsewhere;
mod engine;
mod error;
mod gmres;
mod isotropic;
mod matrix;
mod multifrontal;
mod multigrid;
mod ordering;
mod partition;
mod pattern;
mod residual;
mod schur;
mod spread;
#[cfg(test)]
mod testing;
mod union;

pub use block_csr::BlockCsr;
pub use compliance::Compliance;
pub use digest::Digest;
pub use eigen::{
    Complex, DenseLu, Found, Krylov, Nearest, Pencil, RealModes, Wanted, arnoldi, eigenvalues,
    general, lanczos, noise, pencil, products, sums, symmetric,
};
pub use engine::{
    Analysed, Cut, Engine, EngineReport, FactorEffort, Interior, Multifrontal, Mumps, MumpsOptions,
    Split,
};
pub use error::LinearError;
pub use gmres::{GmresReport, GmresSettings, Product, gmres, gmres_inexact};
pub use isotropic::Isotropic;
pub use matrix::{Cells, Matrix, Summands};
pub use multifrontal::{
    Factor, Fronts, Numbers, PartialFactor, SINGULAR_ROUNDINGS, Symbolic, Workspace, read_factor,
    write_factor,
};
pub use multigrid::{GapVariables, MeshHints, Multigrid, MultigridSettings};
pub use pattern::Couplings;
pub use residual::{backward_error, relative_residual};
pub use schur::Schur;
pub use spread::DistributedOperator;
