//! What the mechanics of **stickslip** stands on: numbers, sparse solvers, errors.
//!
//! It knows neither meshes nor contact. Users import these rooms from the crate `stickslip`, which hands them on.

// What is derived names this crate, in here too.
extern crate self as stickslip_base;

pub mod error;
pub mod keep;
pub mod machine;
pub mod math;
pub mod number;
pub mod owner;
pub mod references;
pub mod registry;
pub mod tolerance;
pub mod units;

pub mod linear;
