//! What developer tasks share: where things are, and what the examples are run with.

pub mod examples;
pub mod workspace;
