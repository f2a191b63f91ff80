//! Laws of the interface: scalar physics, numbers in, numbers and derivatives out. No mesh, no matrix.
//!
//! *Normal* laws relate pressure and gap; *friction* laws state the largest shear traction; *slip* rules turn limit
//! and motion into traction.

pub mod friction;
pub mod normal;
pub mod slip;
