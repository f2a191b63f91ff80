//! The mechanics of **stickslip**: meshes, elements and materials, bodies, contact with friction, and Newton's method for them.
//!
//! No time and no files. Users import these rooms from the crate `stickslip`, which hands them on.

pub mod friction;
pub mod material;
pub mod shape;

pub mod mesh;

pub mod system;

pub mod body;
pub mod contact;
pub mod newton;

// Lower rooms have one name in all crates of the library.
use stickslip_base::{
    error, family, keep, linear, machine, math, number, owner, registry, tolerance,
};
