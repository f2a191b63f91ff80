//! How increments are solved: one [`Solver`](solver::Solver) that owns matrix, factors, Newton's method and the way to solve.

pub(crate) mod accepted;
pub(crate) mod checks;
pub(crate) mod choice;
mod closure;
mod condensed;
pub(crate) mod condenser;
pub(crate) mod floating_bodies;
mod follow;
pub(crate) mod inertia;
pub(crate) mod iteration;
mod rigid_part;
pub(crate) mod solver;
pub(crate) mod spin;
