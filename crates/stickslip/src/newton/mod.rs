//! Newton's method for a linear bulk with interfaces.
//!
//! The bulk comes in as a [`Bulk`]; interfaces come in as [`Force`](crate::system::Force)s that are assembled in every iteration.
//! [`Whole`] is the bulk as one sparse matrix, factored whenever the interfaces have changed too much, or solved by multigrid; in
//! [`condensed`] it is factored once.

mod bulk;
pub mod condensed;
mod grids;
mod linearised;
mod settings;
mod solve;
mod strategy;
mod whole;

pub use bulk::Bulk;
pub use grids::Places;
pub use linearised::{Linearised, Operator};
pub use settings::{Progress, Settings, Statistics};
pub use solve::{Converged, Newton, System};
pub use strategy::{Fallback, Strategy};
pub use whole::{Factors, Origin, Whole};
