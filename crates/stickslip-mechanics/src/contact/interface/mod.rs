//! The interface as a force.
//!
//! What it is ([`InterfaceDefinition`]) is apart from what it knows: the [`History`] that commits write, the [`Attempt`] at the next increment, the
//! [`Conditions`], an argument that the solver owns, and the [`Cache`] of what can be made again. An evaluation reads the history and never writes it.

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
mod conditions;
pub(super) mod cone;
mod curvature;
pub(super) mod definition;
pub(super) mod energies;
mod evaluate;
pub(super) mod evaluation;
mod faces;
mod finish;
mod force;
pub(super) mod history;
mod impulse;
pub(super) mod initial;
pub(super) mod input;
mod law_states;
mod linearise;
pub(super) mod meeting;
mod memory;
mod on_facet;
mod on_mortar;
mod on_obstacle;
mod onset;
mod parts;
mod pass;
mod respond;
mod scene;
pub(super) mod search;
pub(super) mod sides;
mod springs;
pub(super) mod stiffness;
mod surrogate;
pub(super) mod symptoms;
mod user_laws;
pub(super) mod view;
pub(super) mod wear;

#[cfg(test)]
mod history_tests;
#[cfg(test)]
mod objective;
#[cfg(test)]
pub(super) mod tests;

pub use attempt::Attempt;
pub use beginning::{begin_acting, glue};
pub use cache::Cache;
pub use candidate_range::{CandidateRange, include_all, restrict_to_candidates, spreads};
pub use change::{Change, changed};
pub use commit::commit;
pub use conditions::{CandidatePoints, Conditions, Steady};
pub use definition::{InterfaceDefinition, InterfaceMesh, Primary};
pub use history::History;
pub use impulse::{Pressed, pressed_points};
pub use initial::{CLOSE, GLUE, Initial, Start, Within};
pub use law_states::{rate_of_attempt, rate_of_change};
pub use linearise::{LinearPoint, linearise};
pub use meeting::{TimeOfImpact, meeting};
pub use memory::{Memory, memory, remember};
pub use onset::{
    Tried, add_initial_forces, adopt_light_tractions, adopt_tractions, evaluate_laws,
    presses_light_points, tried_tractions,
};
pub use parts::{Interface, InterfaceForce};
pub use pass::gaps_at;
pub use springs::{pull_ties, use_springs};
pub use stiffness::mass_per_area;
pub use symptoms::LARGE_SLIP;
pub use user_laws::{with_friction_law, with_user_laws};
pub use view::ContactView;
