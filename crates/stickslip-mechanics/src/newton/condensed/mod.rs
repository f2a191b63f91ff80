//! Newton's method on the contact candidates alone.
//!
//! This is static condensation ([Guyan 1965](stickslip_base::references::guyan_1965), [Irons 1965](stickslip_base::references::irons_1965)) of substructures
//! ([Przemieniecki 1963](stickslip_base::references::przemieniecki_1963)), and exact here, as masses take part through the matrix of the increment; the
//! component modes of [Craig and Bampton](stickslip_base::references::craig_bampton_1968), which approximate inertia inside, are not needed.
//!
//! Every body is a [`Substructure`]: its interior is eliminated once, and what remains is the compliance of the dofs where it may touch others. A
//! Newton iteration then costs a few compliance products, with dense matrices of the size of the contact surfaces, whatever the bodies are like
//! inside. The interior is recovered on demand, for many increments in one sweep.
//!
//! With `W = (S + σ R Rᵀ)⁻¹` and the forces `s` for which `u = W s`, balance at the candidates reads
//!
//! ```text
//! s - σ R Rᵀ u + contact(u) = load
//! ```
//!
//! Newton steps are sought as steps of `s`: `(I + K W) ds = -residual` with the tangent `K` of the interfaces. However stiff they are, nothing
//! in it is divided by their compliance.

mod active;
mod bulk;
mod condensation;
pub mod engine;
mod file;
mod gap_matrix;
mod gap_space;
mod identity;
mod library;
mod load_patterns;
mod lu;
mod preconditioner;
mod reduced_system;
mod rows;
mod small_matrix;
mod substructure;
mod tangent;

pub use bulk::CondensedBulk;
pub use condensation::{Condensation, Cost, Effort, Plan, Swept};
pub use identity::{Identity, Part};
pub use library::{CACHE_NOTE, Library, Source};
pub use load_patterns::{Amplitudes, LoadPatterns, PatternsRecipe};
pub use reduced_system::{ReducedRecipe, ReducedSolution, ReducedSystem};
pub use substructure::{ArtificialSprings, Floating, Seconds, Substructure};
