//! Files: meshes in and out ([`gmsh`], [`vtu`], [`abaqus`]), fields, histories and arrays out ([`vtu`], [`pvd`], [`frd`], [`csv`], [`npy`]) and, for
//! comparisons, in again ([`vtu`], [`csv`]).
//!
//! This module knows meshes and named fields, never what they mean.

pub mod abaqus;
mod atomic;
pub mod csv;
pub mod frd;
pub mod gmsh;
mod growing;
pub mod input;
pub mod npy;
mod numbers;
pub mod own;
pub mod pvd;
mod sets;
pub mod vtu;

pub(crate) use atomic::meant_by;
pub use atomic::{drop_leftovers, write_atomically};
pub use growing::Growing;
