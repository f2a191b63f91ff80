//! Files: meshes in ([`gmsh`]), fields and histories out ([`vtu`], [`pvd`], [`csv`]).
//!
//! This module knows meshes and named fields, never what they mean.

pub mod gmsh;
