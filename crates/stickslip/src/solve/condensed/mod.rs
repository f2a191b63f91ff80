//! Static condensation: increments on the contact candidates.

mod at_rest;
mod candidates;
mod condensing;
mod in_motion;
