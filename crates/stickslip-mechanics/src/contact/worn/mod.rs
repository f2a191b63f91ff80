//! Surfaces that wear: what of them the definition of an interface holds, and the depths that its history holds.

mod opposite;
mod surfaces;
pub(super) mod track;

pub use opposite::OppositeWear;
pub(super) use surfaces::WornSurfaces;
pub use track::{TrackSampling, WearTrack};
