//! **stickslip**: frictional contact of elastic bodies in 2D and 3D.
//!
//! Two or more linear elastic bodies touch, stick and slide. The interface obeys unilateral contact,
//! normal compliance or a micro-contact law of rough surfaces, and a friction law; both are enforced by a
//! penalty, a perturbed Lagrangian or an augmented Lagrangian. The starting point is
//! [Pop 1995](references::pop_1995).
//!
//! A problem is plain data ([`problem::Problem`]), usually read from a TOML file. It is checked and built into
//! a [`run::Simulation`], which runs and hands every accepted increment to its observers.
//!
//! The modules are layered; `ARCHITECTURE.md` at the root of the repository draws the map and
//! `tests/it/layers` holds the code to it.

pub use stickslip_base::{
    error, family, keep, linear, machine, math, number, owner, references, registry, tolerance,
    units,
};
pub use stickslip_mechanics::{body, contact, friction, material, mesh, newton, shape, system};

pub mod io;
pub mod time;

pub mod fatigue;
pub mod roughness;

pub mod model;

mod solve;

mod integrate;

pub mod modal;

pub mod assess;

pub mod results;

pub mod run;

pub mod problem;

pub use error::{Diagnostic, Error};
