//! How increments are made: integrators, each with one attempt at one increment.

pub(crate) mod central_difference;
pub(crate) mod explicit;
pub(crate) mod implicit;
pub(crate) mod integration;
pub(crate) mod integrator;
pub(crate) mod onset;
pub(crate) mod quasi_static;
