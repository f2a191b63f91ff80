//! Eigenvalues: of dense matrices by faer, the lowest of sparse ones by Krylov methods with a factor.
//!
//! [`lanczos`] is the block Lanczos method for `K x = λ M x` in the inner product of `M`, [`arnoldi`] that of Arnoldi for what has no symmetry.
//! Both orthogonalise fully. faer has Krylov solvers too, but only for the Euclidean product, in which `K⁻¹ M` is not symmetric: a mass without
//! inverse (points without inertia) would have to be split first.

mod arnoldi;
mod dense;
mod lanczos;
mod vectors;

pub use arnoldi::{Found, Krylov, Nearest, arnoldi};
pub use dense::{Complex, DenseLu, eigenvalues, general, pencil, products, sums, symmetric};
pub use lanczos::{Pencil, RealModes, Wanted, lanczos};
pub use vectors::noise;
