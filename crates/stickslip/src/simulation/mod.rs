//! simulation

pub mod compare;
