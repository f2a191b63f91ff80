//! Loads and springs: what the problem file names under `load`, one file a kind.
//!
//! A load kind turns a set of the mesh into an [`Action`], plain numbers by dof. [`Load`] and [`Spring`] are the
//! forces made of them. Forces are those on the whole body: integrals include the thickness of a plane body and the
//! full circumference of an axisymmetric one.

mod body_force;
mod centrifugal;
mod domain;
mod force;
mod gravity;
mod moment;
mod nodal_force;
mod pressing;
mod pressure;
mod spring;
mod traction;

#[cfg(test)]
mod tests;

pub use body_force::BodyForce;
pub use centrifugal::Centrifugal;
pub use domain::{Action, Domain, LoadModel, Region, Target};
pub use force::{Load, Spring};
pub use gravity::Gravity;
pub use moment::Moment;
pub use nodal_force::NodalForce;
pub use pressing::Pressing;
pub use pressure::Pressure;
pub use spring::GroundSpring;
pub use traction::Traction;

crate::family! {
    /// The load kinds.
    LoadKind: "load", dyn LoadModel {
        /// Force per area, fixed in direction.
        Traction(Traction) = "traction",
        /// Force per area against the outward normal.
        Pressure(Pressure) = "pressure",
        /// Force per volume.
        BodyForce(BodyForce) = "body-force",
        /// Weight.
        Gravity(Gravity) = "gravity",
        /// Centrifugal force.
        Centrifugal(Centrifugal) = "centrifugal",
        /// Force at each point.
        NodalForce(NodalForce) = "nodal-force",
        /// Moment on a reference point or a rigid body.
        Moment(Moment) = "moment",
        /// Springs to ground at each point.
        Spring(GroundSpring) = "spring",
    }
}
