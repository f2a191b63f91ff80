//! The formulations of bodies: each an implementation of [`BodyModel`](crate::system::BodyModel).

mod by_cell;
mod corotated;
mod linear;

#[cfg(test)]
mod tests;

pub use by_cell::BodiesByCell;
pub use corotated::CorotatedBodies;
pub use linear::LinearBodies;
