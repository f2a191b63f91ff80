//! Wear of both surfaces: depths, what they open of the gap, and what sliding takes.
//!
//! [`WornSurfaces`] is the state, [`OppositeWear`] the part of the definition that it refers to. `removal.rs` has what laws take over an increment and what that opens of the
//! gap, `along_track.rs` what matter that goes by loses. What is reported of it is in `look/wear.rs` and `look/wear_profile.rs`.

mod along_track;
mod opposite;
mod removal;
mod surfaces;
pub(in crate::contact) mod track;

pub(super) use along_track::wear_track;
pub use opposite::OppositeWear;
pub(in crate::contact) use removal::sliding_distance;
pub(super) use removal::{
    add_nodal_wear, length, path, wear_compliance, wear_gap, wear_increment, wearing,
};
pub(super) use surfaces::WornSurfaces;
pub use track::{TrackSampling, WearTrack};
