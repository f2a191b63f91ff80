//! How the analysis advances: increments and their control.

mod stepper;

pub use stepper::{Increments, Stepper, Trial};
