//! Static condensation: increments on the contact candidates.

pub(crate) mod at_rest;
pub(crate) mod candidates;
pub(crate) mod condensing;
pub(crate) mod in_motion;
