//! Newton's method for a linear bulk with interfaces.
//!
//! Points change status from one iteration to the next, so the residual has kinks: the method is semi-smooth
//! ([Alart and Curnier](crate::references::alart_curnier_1991), [Qi and Sun](crate::references::qi_sun_1993)).
//!
//! The bulk comes in as a [`Bulk`]; interfaces come in as [`Force`](crate::system::Force)s that are assembled in every iteration.
//! [`SparseBulk`] is the bulk as one sparse matrix, factored whenever the interfaces have changed too much, or solved by multigrid; in
//! [`condensed`] it is factored once.

mod attempt;
mod balance;
mod bulk;
pub mod condensed;
mod equilibrium;
mod factors;
mod failure;
mod grids;
mod linearised;
mod operator;
mod progress;
mod rounds;
mod settings;
mod solve;
mod sparse_bulk;
mod statistics;
mod step_length;
mod strategy;
mod system;
mod ways;

pub use bulk::Bulk;
pub use factors::Factors;
pub use grids::BodyPoints;
pub use linearised::Linearised;
pub use operator::Operator;
pub use progress::{Converged, Progress};
pub use settings::Settings;
pub use solve::Newton;
pub use sparse_bulk::{Origin, SparseBulk};
pub use statistics::Statistics;
pub use strategy::{Fallback, Strategy};
pub use system::System;
