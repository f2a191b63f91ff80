//! The interface as a force, and what it says of itself.
//!
//! What it is ([`Interface`]) is apart from what it knows: the [`History`] that commits write, the [`Attempt`] at the next increment, the
//! [`Directives`] of the solver, and the [`Cache`] of what can be made again. An evaluation reads the history and never writes it.

mod active_set;
mod alone;
mod attempt;
mod augment;
mod beginning;
mod belt;
mod between;
mod cache;
mod candidate_range;
mod candidates;
mod change;
mod clamped;
mod commit;
mod cone;
mod curvature;
mod definition;
mod directives;
mod energies;
mod evaluate;
mod evaluation;
mod faces;
mod fields;
mod finish;
mod force;
mod ground;
mod history;
mod hollows;
mod impulse;
mod initial;
mod linearise;
mod meeting;
mod memory;
mod on_facet;
mod on_ground;
mod on_mortar;
mod on_obstacle;
mod onset;
mod opposite_sheet;
mod oscillation;
mod pass;
mod passing;
mod pressing;
mod quality;
mod resolution;
mod respond;
mod resultant;
mod scar;
mod scene;
mod search;
mod sheet;
mod sides;
mod spacing;
mod springs;
mod stiffness;
mod surrogate;
mod symptoms;
mod table;
mod turned;
mod user_laws;
mod values;
mod worn;

#[cfg(test)]
mod history_tests;
#[cfg(test)]
mod objective;
#[cfg(test)]
mod tests;

pub use attempt::Attempt;
pub use between::Between;
pub use cache::Cache;
pub use candidate_range::CandidateRange;
pub use change::Change;
pub use definition::{Interface, Primary};
pub use directives::{Directives, Steady};
pub use ground::{Above, Ground};
pub use history::History;
pub use hollows::Hollows;
pub use impulse::Pressed;
pub use initial::{CLOSE, GLUE, Initial, Start, Within};
pub use linearise::LinearPoint;
pub use meeting::Meeting;
pub use memory::Memory;
pub use onset::Tried;
pub use oscillation::neighbours;
pub use pressing::Pressing;
pub use quality::{Balance, Quality};
pub use resolution::Resolution;
pub use resultant::Resultant;
pub use scar::Scar;
pub use sheet::Sheet;
pub use sides::WearReport;
pub use springs::TieRow;
