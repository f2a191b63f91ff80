//! How the analysis advances: increments and their control, schemes that integrate the equations of motion.

mod contact;
pub mod newmark;
pub mod scheme;
mod stepper;

pub use contact::{ContactAt, ContactMass};
pub use stepper::{Increments, Pace, Stepper, Trial};
