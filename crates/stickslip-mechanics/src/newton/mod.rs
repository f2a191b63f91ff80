//! Newton's method for a linear bulk with interfaces.
//!
//! Points change status from one iteration to the next, so the residual has kinks: the method is semi-smooth
//! ([Alart and Curnier](stickslip_base::references::alart_curnier_1991), [Qi and Sun](stickslip_base::references::qi_sun_1993)).
//!
//! The bulk comes in as a [`Bulk`]; interfaces come in as [`Force`](crate::system::Force)s that are assembled in every iteration.
//! [`SparseBulk`] is the bulk as one sparse matrix, factored whenever the interfaces have changed too much, or solved by multigrid; in
//! [`condensed`] it is factored once.
//!
//! # Two bulks
//!
//! - `newton/sparse_bulk.rs`, the sparse matrix. GMRES on bulk plus contact blocks, preconditioned by a Cholesky factor of the bulk and the surrogates at
//!   *some* earlier iteration; it is kept, over increments too, until GMRES needs too many iterations with it. The surrogate is what a Cholesky
//!   factor may contain: slip makes the true tangent unsymmetric, and GMRES makes up for the difference. With multigrid a hierarchy takes the place
//!   of the factor (`newton/grids.rs`). It is made of the bulk in gap variables, the displacement of a secondary point relative to the facet it
//!   meets: contact stiffness is then one block a point, put on all levels in every iteration, and the number of iterations does not depend on
//!   it. When points have moved along their facets the finest level is made anew, and everything when supports or the matrix change. Where
//!   multigrid fails, a factor takes over, with a note.
//! - `newton/condensed/`, the contact candidates, by static condensation. Each body is a `Substructure`: `linear/multifrontal` eliminates its interior once and leaves a dense
//!   Schur complement `S` at the candidates, of which `linear/compliance.rs` holds the inverse `W`. The unknowns of an increment are the forces `s`
//!   with `u = W s`, so that the bulk is always in balance to the last digit and a Newton iteration costs a few products with `W`.
//!   `reduced_system.rs` solves `(I + K W) ds = b` on the dofs that contact touches, preconditioned by an LU factor with one row a gap or slip; stiff
//!   interfaces are no harder than soft ones. Bodies that float get artificial springs along their rigid motions, taken away exactly by a border.
//!   Loads and prescribed displacements are split into load patterns, each swept through the factor once (`load_patterns.rs`).
//!
//! `solve/choice.rs` chooses by the counts of the symbolic factorisation, before any arithmetic; what it found is a note in the log and in the
//! summary, and `solver.method` overrules it. `solve/condensed/candidates.rs` chooses the candidates: points that prescribed motion can bring into contact, with a
//! margin. Contact that comes near the rim of the candidates makes the increment be tried again with more of them; points that do not take part are checked
//! for penetration whenever interiors are known.

mod attempt;
mod balance;
mod bulk;
pub mod condensed;
mod curved_bulk;
mod equilibrium;
mod factors;
mod failure;
mod grids;
mod in_forces;
mod linearised;
mod operator;
mod progress;
mod rounds;
mod settings;
mod solve;
mod sparse_bulk;
mod stand_in;
mod statistics;
mod step_length;
mod strategy;
mod system;

pub use bulk::Bulk;
pub use curved_bulk::NonlinearBulk;
pub use factors::{Factors, FactorsRecipe, MOST_FACTORS};
pub use failure::describe;
pub use grids::BodyPoints;
pub use linearised::Linearised;
pub use operator::Operator;
pub use progress::{Converged, Progress};
pub use settings::Settings;
pub use solve::Newton;
pub use sparse_bulk::{Origin, SparseBulk};
pub use statistics::{FactorSizes, Hierarchies, Seconds, Statistics, Substructures};
pub use strategy::{Fallback, Strategy};
pub use system::System;

#[cfg(test)]
mod tests;
