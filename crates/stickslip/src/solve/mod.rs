//! How increments are solved: one [`Solver`](solver::Solver) that owns matrix, factors, Newton's method and the way to solve.

pub(crate) mod accepted;
pub(crate) mod checks;
pub(crate) mod choice;
pub(crate) mod condensed;
pub(crate) mod floating;
pub(crate) mod inertia;
pub(crate) mod iteration;
pub(crate) mod solver;
pub(crate) mod spin;
