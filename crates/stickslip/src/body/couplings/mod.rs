//! Equations between displacements, and springs between points: what the problem file names under `coupling`, one file a kind.
//!
//! A kind turns sets of points into [`Row`]s, each a weighted sum of displacements. [`Couplings`] is the force made of all of them. It stands
//! on the side of contact, so that it may connect bodies that are factored one by one, come and go with the steps, and be the same for every
//! way to solve.

mod all;
mod axial_spring;
mod equation;
mod explicit;
mod force;
mod model;
mod motion;
mod row;
mod spring;

pub use all::{Coupling, Couplings, CouplingsMemory, Tie};
pub use axial_spring::AxialSpring;
pub use equation::{Equation, Term};
pub use model::CouplingModel;
pub use row::Row;
pub use spring::Spring;

crate::family! {
    /// The kinds of couplings.
    CouplingKind: "coupling", dyn CouplingModel {
        /// A weighted sum of displacements has a given value.
        Equation(Equation) = "equation",
        /// A spring against a weighted sum of displacements.
        Spring(Spring) = "spring",
        /// A spring along the line between two points.
        AxialSpring(AxialSpring) = "axial-spring",
    }
}
