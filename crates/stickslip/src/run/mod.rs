//! The driver: steps, attempts, cut-backs and pending increments.

mod attempt;
mod begin;
mod checkpoint;
mod cycle_block;
mod cycles;
mod ending;
mod energy_balance;
mod failures;
mod fallback;
mod floating;
mod jump_error;
mod jumps;
mod modes;
mod outcome;
mod parts;
mod pending;
mod position;
mod queue;
mod record;
mod restart;
mod simulation;
mod sizes;
mod state_change;

pub use crate::solve::work::{Watch, Work};
pub use checkpoint::Checkpoint;
pub use parts::Run;
pub use simulation::{Interrupt, Simulation};
pub use sizes::Sizes;

#[cfg(test)]
mod seam_tests;
