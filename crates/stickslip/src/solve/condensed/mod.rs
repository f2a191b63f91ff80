//! Static condensation: increments on the contact candidates.

mod at_rest;
mod candidates;
mod condenser;
mod condensing;
mod in_motion;

pub(crate) use condenser::{Candidates, Condenser};
