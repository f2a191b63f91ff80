//! Mixes: random problems that combine what is sound each by itself, the same for a seed for ever. A feature is a row of a table, what cannot go together a row of
//! another, and each mix draws relations: pairs of runs that must agree, whatever the right answer is.

mod apart;
mod bodies;
mod drive;
mod extras;
mod feature;
mod laws;
mod mixture;
pub mod pair;
mod relation;
mod sheet;
mod structure;
mod view;

pub use apart::{APART, apart};
pub use feature::Feature;
pub use mixture::{Mix, features, problem};
pub use relation::{Again, Agreement, RELATIONS, Relation, WITHOUT_PENALTY};
pub use view::View;
