//! Newton's method for a linear bulk with interfaces.
//!
//! The bulk comes in as one constant matrix; interfaces come in as [`Force`](crate::system::Force)s that are assembled in every iteration. What a
//! later solver condenses away is everything but the contact blocks, so nothing here may touch the bulk matrix.

mod linearised;
mod settings;
mod solve;

pub use linearised::{Linearised, Operator};
pub use settings::{Progress, Settings, Statistics};
pub use solve::{Converged, Newton, Origin, System};
