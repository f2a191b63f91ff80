//! Pairing: which place of which facet belongs to a point. The only place, beside obstacles, where a contact normal is made.

mod anchor;
mod closest;
mod project;

pub use anchor::Anchor;
pub use closest::{Choice, Previous};
pub use project::{
    Beyond, FACET_NODES, FacetPoint, beyond, evaluate, facet_distance, project, project_near,
};
pub(crate) use project::{invert2, pair_index, projection_matrix};
