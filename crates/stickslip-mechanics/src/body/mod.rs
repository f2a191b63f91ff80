//! Elastic bodies: element loops, stresses, loads, springs, rigid-body modes.

// Tensor components and nodes read best by their indices.
#![allow(clippy::needless_range_loop)]

mod anchors;
pub mod around;
mod cell_frame;
pub mod cells;
pub mod couplings;
mod elastic;
mod extrapolate;
mod facets;
pub mod fields;
mod geometry;
pub mod heat;
mod hourglass;
mod incompatible;
pub mod internal;
mod kernel;
pub mod loads;
pub mod mass;
mod medium;
pub mod model;
pub mod moments;
mod operator;
pub mod portion;
pub mod prestress;
pub mod recover;
mod redistribution;
mod rigid;
mod scheme;
mod space;
mod temperatures;
pub mod turning;
mod warmth;
mod waves;

pub use anchors::{Anchors, Hold, spread};
pub use around::Around;
pub use cells::CellState;
pub use elastic::{CellVisitor, Elastic, Part};
pub use facets::{area_vectors, positive_areas, tributary_areas};
pub use mass::MassKind;
pub use moments::MassMoments;
pub use portion::Portion;
pub use recover::{At, StressPoint, Warm};
pub use rigid::{RigidMode, rigid_modes};
pub use space::{Formulation, Space};
pub use temperatures::{TemperatureField, Temperatures};
pub use turning::Turning;

#[cfg(test)]
mod heated_tests;
#[cfg(test)]
mod testing;
#[cfg(test)]
mod tests;
