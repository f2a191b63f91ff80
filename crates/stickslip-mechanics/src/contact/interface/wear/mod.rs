//! Wear over an increment: what it opens of the gap, and what sliding takes.
//!
//! Depths are in [`WornSurfaces`](crate::contact::worn::WornSurfaces), a part of the history. `removal.rs` has what laws take over an increment and what that opens of the gap,
//! `along_track.rs` what material that moves past loses. What is reported of it is in `look/wear.rs` and `look/wear_profile.rs`.

mod along_track;
mod removal;

pub(super) use along_track::wear_track;
pub(in crate::contact) use removal::sliding_distance;
pub(super) use removal::{
    add_nodal_wear, length, path, wear_compliance, wear_gap, wear_increment, wearing,
};
