//! Laws of the interface: scalar physics, numbers in, numbers and derivatives out. No mesh, no matrix.
//!
//! *Normal* laws relate pressure and gap; *damping* adds pressure while surfaces approach; *friction* laws state the
//! largest shear traction; *slip* rules turn limit and motion into traction; *wear* says what sliding takes away. Programs may bring their *own*.

pub mod damping;
pub mod friction;
mod grid;
pub mod normal;
pub mod slip;
pub mod user;
pub mod wear;
