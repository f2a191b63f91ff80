//! Multigrid for bodies too large to factor, in variables that make contact local.

mod aggregate;
mod blocks;
mod bottom;
mod gaps;
mod hierarchy;
mod jacobi;
mod level;
#[cfg(test)]
mod model;
mod preconditioner;
mod prolong;
mod settings;
mod spectrum;
#[cfg(test)]
mod tests;

pub use gaps::GapVariables;
pub use preconditioner::Multigrid;
pub use settings::{MeshHints, MultigridSettings};
