//! What an interface says of itself: functions of a [`ContactView`](super::interface::ContactView), one thing a file, which cannot write. What judges the
//! last evaluation gets the interface as a shared reference.

mod between;
mod excluded;
mod fields;
mod frequency;
mod joined;
mod last;
mod normals;
mod opposite;
mod opposite_sheet;
mod oscillation;
mod passing;
mod pressing;
mod quality;
mod resolution;
mod resultant;
mod sheet;
mod sliding;
mod snaps;
mod spacing;
mod table;
mod tie_rows;
mod touching;
mod turned;
mod values;
mod wear;
mod wear_profile;

pub use super::interface::energies::{energy, law_energy, stored_by_point};
pub use super::interface::symptoms::evidence;
pub use between::{Between, between, opening, overlap_between};
pub use excluded::{excluded_gaps, overlooked};
pub use fields::{fields, rubbing};
pub use frequency::{highest_frequency, highest_rate, pressed_frequency};
pub use joined::{Joined, joined};
pub use last::{slid, statuses, switched, tally, touches};
pub use normals::{normals, outward};
pub use opposite::{FACING_COSINE, Nearest, Opposite, coordinates};
pub use opposite_sheet::opposite_sheet;
pub use oscillation::{neighbours, oscillation};
pub use passing::tunnels;
pub use pressing::{Pressing, pressing};
pub use quality::{
    Balance, Quality, balance, numerical_factor, on_springs, quality, tie_spring_energy,
};
pub use resolution::{Resolution, resolution};
pub use resultant::{
    Resultant, centre_and_normal, closed, committed_tally, resultant, sliding_area,
};
pub use sheet::{Sheet, sheet};
pub use sliding::{SlidingReport, sliding};
pub use snaps::snaps;
pub use spacing::coarser;
pub use table::{initial_gaps, table};
pub use tie_rows::tie_rows;
pub use touching::{is_hard, rubs, touched};
pub use turned::{normals_turned, outdated_normals};
pub use wear::{taken, wear, wear_places, worn_volume};
pub use wear_profile::{WearProfile, explicit_limit, wear_profile};
