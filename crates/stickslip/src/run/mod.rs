//! The driver: steps, attempts, cut-backs and pending increments.

mod book;
mod checkpoint;
mod cycles;
mod failures;
mod fallback;
mod jump_error;
mod jumps;
mod modes;
mod pending;
mod position;
mod queue;
mod restart;
mod simulation;
mod sizes;
mod steps;
mod trying;
mod weigh;

pub use crate::solve::work::{Watch, Work};
pub use checkpoint::Checkpoint;
pub use simulation::Simulation;
pub use sizes::Sizes;
pub use steps::Interrupt;
