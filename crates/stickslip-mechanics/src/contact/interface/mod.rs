//! The interface as a force.
//!
//! What it is ([`InterfaceDefinition`]) is apart from what it knows: the [`History`] that commits write, the [`Attempt`] at the next increment, the
//! [`Directives`] of the solver, and the [`Cache`] of what can be made again. An evaluation reads the history and never writes it.

mod active_set;
mod alone;
mod attempt;
mod augment;
mod axles;
mod beginning;
mod belt;
mod cache;
pub(super) mod candidate_range;
pub(super) mod candidates;
mod change;
mod clamped;
mod commit;
pub(super) mod cone;
mod curvature;
pub(super) mod definition;
mod directives;
pub(super) mod energies;
mod evaluate;
pub(super) mod evaluation;
mod faces;
mod finish;
mod force;
pub(super) mod ground;
pub(super) mod history;
mod hollows;
mod impulse;
pub(super) mod initial;
mod linearise;
pub(super) mod meeting;
mod memory;
mod on_facet;
mod on_ground;
mod on_mortar;
mod on_obstacle;
mod onset;
mod parts;
mod pass;
mod respond;
mod scene;
pub(super) mod search;
mod sides;
mod springs;
mod stiffness;
mod surrogate;
pub(super) mod symptoms;
mod user_laws;
pub(super) mod view;
pub(super) mod worn;

#[cfg(test)]
mod history_tests;
#[cfg(test)]
mod objective;
#[cfg(test)]
pub(super) mod tests;

pub use attempt::Attempt;
pub use cache::Cache;
pub use candidate_range::CandidateRange;
pub use change::Change;
pub use definition::{InterfaceDefinition, Primary};
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
pub use parts::Interface;
pub use view::ContactView;
